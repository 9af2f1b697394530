#include "tassilo/app/plugin.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/vision/plugin.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

struct Plugin {
  void* library = nullptr;  ///< The same for the same file.
  decltype(&tassilo_register) add = nullptr;
};

/// What dlopen has against a file, without its name.
std::string load_fault(const std::string& path) {
  const char* const said = dlerror();
  const std::string text = said != nullptr ? said : "for an unknown reason";
  return text.starts_with(path + ": ") ? text.substr(path.size() + 2) : text;
}

template <class Function>
Function* function_of(void* library, const char* name) {
  return reinterpret_cast<Function*>(dlsym(library, name));
}

/// Loads the library and checks that it fits the program before it is let at any type of it.
Plugin open_plugin(const std::string& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) throw Error(file, "does not exist");
  // An absolute path: of a bare name dlopen would search the system's libraries.
  const std::string path = fs::absolute(file).string();
  // Local, so that libraries do not see each other. The program exports its functions, and what both have, as the pools
  // of recycled memory, is the program's.
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw Error(file, "cannot be loaded as a shared library: " + load_fault(path));

  const auto built_for = function_of<decltype(tassilo_built_for)>(library, "tassilo_built_for");
  const auto add = function_of<decltype(tassilo_register)>(library, "tassilo_register");
  if (built_for == nullptr || add == nullptr)
    throw Error(file, std::string("has no function ") +
                          (built_for == nullptr ? "tassilo_built_for" : "tassilo_register") +
                          ", must be a library for Tassilo as in docs/stages.md");
  if (const std::string text = built_for(); text != TASSILO_BUILT_FOR)
    throw Error(file, "was built for " + shown(text) + ", this is '" + TASSILO_BUILT_FOR + "'; build it anew");
  const auto layout = function_of<decltype(tassilo_layout)>(library, "tassilo_layout");
  if (layout == nullptr || layout() != plugin_layout())
    throw Error(file, "was built with other headers than this " TASSILO_BUILT_FOR "; build it anew");
  return {library, add};
}

std::vector<std::vector<std::string>> names_in(const StageRegistry& registry) {
  std::vector<std::vector<std::string>> names;
  registry.for_each([&](const auto& stage) {
    names.emplace_back();
    for (const auto& alternative : stage.alternatives) names.back().push_back(alternative.name);
  });
  return names;
}

/// What was registered before must stay as it is: its default comes first.
void check_added(const StageRegistry& before, const StageRegistry& after, const std::string& file) {
  const auto old_names = names_in(before), names = names_in(after);
  if (old_names == names) throw Error(file, "registers no alternative");
  for (std::size_t stage = 0; stage < names.size(); ++stage)
    if (names[stage].size() < old_names[stage].size() ||
        !std::ranges::equal(old_names[stage], std::span(names[stage]).first(old_names[stage].size())))
      throw Error(file, "moves or removes alternatives of others, must add its own behind them");
  check_stages(after, file);
}

StageRegistry registered(const StageRegistry& registry, const Plugin& plugin, const std::string& file) {
  StageRegistry more = registry;
  try {
    plugin.add(more);
  } catch (const std::exception& error) {
    throw Error(file, std::string("cannot register its alternatives: ") + error.what());
  } catch (...) {
    throw Error(file, "cannot register its alternatives: throws what is no std::exception");
  }
  check_added(registry, more, file);
  return more;
}

}  // namespace

StageRegistry with_plugins(StageRegistry registry, std::span<const std::string> files) {
  std::vector<void*> loaded;
  for (const std::string& file : files) {
    const Plugin plugin = open_plugin(file);
    if (std::ranges::find(loaded, plugin.library) != loaded.end()) continue;
    loaded.push_back(plugin.library);
    registry = registered(registry, plugin, file);
  }
  return registry;
}

}  // namespace tassilo
