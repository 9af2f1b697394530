// A shared library for tests: what it does wrong, the environment variable TASSILO_TEST_PLUGIN says.
#include <dlfcn.h>

#include <cstdlib>
#include <string>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/base/recycled.h"
#include "tassilo/vision/plugin.h"

namespace {

using namespace tassilo;

/// In which file a function that this library calls lies.
void* file_of(const void* function) {
  Dl_info info{};
  dladdr(function, &info);
  return info.dli_fbase;
}

Alternative<std::function<BallSearch(const View&)>> blind() {
  const bool shared =
      file_of(reinterpret_cast<const void*>(&take_block)) != file_of(reinterpret_cast<const void*>(&tassilo_register));
  return {"blind",
          shared ? "sees nothing, in memory of the program" : "sees nothing, in memory of its own",
          {},
          [](const VisionOptions&) { return [](const View&) {
                                       return BallSearch{{}, "blind"};
                                     }; }};
}

}  // namespace

void tassilo_register(StageRegistry& registry) {
  const char* const set = std::getenv("TASSILO_TEST_PLUGIN");
  const std::string wrong = set != nullptr ? set : "";
  auto& balls = registry.balls.alternatives;
  if (wrong == "throws an error") throw Error("camera", "is not there");
  if (wrong == "throws a number") throw 7;
  if (wrong == "nothing") return;
  balls.push_back(blind());
  if (wrong == "twice") balls.push_back(blind());
  if (wrong == "first") std::swap(balls.front(), balls.back());
  if (wrong == "alone") balls.erase(balls.begin());
}
