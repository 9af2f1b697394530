#pragma once

#include <cstddef>

#include "tassilo/scene/scene.h"
#include "tassilo/vision/stages.h"

// For shared libraries that bring alternatives of their own; docs/stages.md, examples/plugin. Include this in one
// source and define
//
//   void tassilo_register(tassilo::StageRegistry& registry) {
//     registry.balls.alternatives.push_back({.name = "mine", .meaning = "...", .options = {}, .make = ...});
//   }
//
// Alternatives are added behind those that are there. Throw tassilo::Error where something is wrong.
//
// Values with containers and functions in them go to and fro, so program and library must agree on every type: the same
// release, the same compiler, and, while a release is in the making, the same state of these headers. The functions
// below say what the library was built with, and the program refuses what differs. All they need is constant: functions
// and variables of one name are one in program and library, the program's.

#define TASSILO_TEXT_OF(macro) #macro
#define TASSILO_TEXT(macro) TASSILO_TEXT_OF(macro)
#ifdef __clang__
#define TASSILO_BUILT_FOR "tassilo " TASSILO_VERSION " by clang " TASSILO_TEXT(__clang_major__)
#else
#define TASSILO_BUILT_FOR "tassilo " TASSILO_VERSION " by gcc " TASSILO_TEXT(__GNUC__)
#endif

namespace tassilo {

/// A number that another size of what goes to and fro would change.
consteval std::size_t plugin_layout() {
  std::size_t layout = 0;
  for (const std::size_t size :
       {sizeof(OptionInfo), sizeof(VisionOptions), sizeof(StageRegistry), sizeof(LocalizationInput), sizeof(View),
        sizeof(FrameView), sizeof(Segmentation), sizeof(Surface), sizeof(FieldModel), sizeof(Optics), sizeof(SectorMap),
        sizeof(BallSearch), sizeof(GoalSearch), sizeof(Lines), sizeof(Boundary), sizeof(Localized), sizeof(Scene)})
    layout = 31 * layout + size;
  return layout;
}

}  // namespace tassilo

extern "C" {

/// Adds the library's alternatives; for its author to define.
[[gnu::visibility("default")]] void tassilo_register(tassilo::StageRegistry& registry);

[[gnu::used, gnu::visibility("default")]] inline const char* tassilo_built_for() { return TASSILO_BUILT_FOR; }
[[gnu::used, gnu::visibility("default")]] inline std::size_t tassilo_layout() { return tassilo::plugin_layout(); }

}  // extern "C"
