#include "tassilo/app/plugin.h"

#include <dlfcn.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
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

/// A file that was loaded.
struct LoadedFile {
  dev_t device;
  ino_t number;
  timespec written;

  bool is(const struct stat& file) const { return device == file.st_dev && number == file.st_ino; }
  bool is_written_over(const struct stat& file) const {
    return written.tv_sec != file.st_mtim.tv_sec || written.tv_nsec != file.st_mtim.tv_nsec;
  }
};

/// dlopen knows a library by the name it was asked for, and does not look whether the name leads to another file by
/// now; so every file that one path has led to gets a spelling of its own, "folder/././name".
std::string spelling_of(const fs::path& path, std::ptrdiff_t count) {
  fs::path spelling = path.parent_path();
  for (std::ptrdiff_t i = 0; i < count; ++i) spelling /= ".";
  return (spelling / path.filename()).string();
}

void* library_of(const std::string& file) {
  static std::mutex mutex;
  static std::map<fs::path, std::vector<LoadedFile>> loaded;
  // Absolute: of a bare name dlopen would search the system's libraries.
  const fs::path path = fs::absolute(file);
  struct stat found {};
  if (stat(path.c_str(), &found) != 0) throw Error(file, "does not exist");
  const std::lock_guard lock(mutex);
  std::vector<LoadedFile>& files = loaded[path];
  const auto known = std::ranges::find_if(files, [&](const LoadedFile& one) { return one.is(found); });
  if (known != files.end() && known->is_written_over(found))
    throw Error(file, "was written over while in use, must be replaced by another file, as linkers and mv do");
  const std::string spelling = spelling_of(path, known - files.begin());
  // Local, so that libraries do not see each other. The program exports its functions, and what both have, as the pools
  // of recycled memory, is the program's.
  void* const library = dlopen(spelling.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const said = dlerror();
    std::string text = said != nullptr ? said : "for an unknown reason";
    if (text.starts_with(spelling + ": ")) text.erase(0, spelling.size() + 2);
    throw Error(file, "cannot be loaded as a shared library: " + text);
  }
  if (known == files.end()) files.push_back({found.st_dev, found.st_ino, found.st_mtim});
  return library;
}

template <class Function>
Function* function_of(void* library, const char* name) {
  return reinterpret_cast<Function*>(dlsym(library, name));
}

/// Loads the library and checks that it fits the program before it is let at any type of it.
Plugin open_plugin(const std::string& file) {
  void* const library = library_of(file);
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
