#include "tassilo/app/plugin.h"

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <vector>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;
using Files = std::vector<std::string>;

const std::string kPlugin = TEST_PLUGIN;

/// Lets the library for tests do something wrong as long as this lives.
class Wrong {
 public:
  explicit Wrong(const char* what) { setenv("TASSILO_TEST_PLUGIN", what, 1); }
  Wrong(const Wrong&) = delete;
  Wrong& operator=(const Wrong&) = delete;
  ~Wrong() { unsetenv("TASSILO_TEST_PLUGIN"); }
};

std::string message_of(const std::string& file) {
  try {
    with_plugins(built_in_stages(), Files{file});
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A shared library that knows nothing of Tassilo: the one that printf is in.
std::string some_library() {
  Dl_info info{};
  dladdr(dlsym(RTLD_DEFAULT, "printf"), &info);
  return info.dli_fname;
}

std::vector<std::string> ball_finders(const StageRegistry& registry) {
  std::vector<std::string> names;
  for (const auto& alternative : registry.balls.alternatives) names.push_back(alternative.name);
  return names;
}

TEST(Plugins, AddTheirAlternativesBehindTheBuiltInOnes) {
  EXPECT_EQ(ball_finders(with_plugins(built_in_stages(), {})), ball_finders(built_in_stages()));
  EXPECT_EQ(ball_finders(with_plugins(built_in_stages(), Files{kPlugin})), (Files{"sphere", "blind"}));
}

// As when a configuration is read again, or a robot file and a command line name the same.
TEST(Plugins, NamedTwiceAddThemOnceToEachRegistry) {
  const fs::path path = kPlugin;
  const std::string detour = path.parent_path() / ".." / path.parent_path().filename() / path.filename();
  for (int again = 0; again < 3; ++again)
    EXPECT_EQ(ball_finders(with_plugins(built_in_stages(), Files{kPlugin, detour, kPlugin})),
              (Files{"sphere", "blind"}));
}

// Blocks that the library takes and the program gives back would otherwise pile up in one and be missing in the other.
TEST(Plugins, ShareRecycledMemoryWithTheProgram) {
  const StageRegistry registry = with_plugins(built_in_stages(), Files{kPlugin});
  EXPECT_EQ(registry.balls.alternatives.back().meaning, "sees nothing, in memory of the program");
}

TEST(Plugins, ThatAreNoneAreRefused) {
  const std::string junk = testing::TempDir() + "tassilo_junk_" + std::to_string(getpid()) + ".so";
  std::ofstream(junk) << "no library";
  EXPECT_EQ(message_of("none.so"), "none.so: does not exist");
  EXPECT_EQ(message_of(junk), junk + ": cannot be loaded as a shared library: file too short");
  EXPECT_THAT(message_of(testing::TempDir()), testing::HasSubstr("cannot be loaded as a shared library: "));
  EXPECT_THAT(message_of(some_library()),
              testing::EndsWith(": has no function tassilo_built_for, must be a library for "
                                "Tassilo as in docs/stages.md"));
  fs::remove(junk);
}

TEST(Plugins, OfAnotherVersionAreRefused) {
  EXPECT_THAT(
      message_of(TEST_PLUGIN_OF_ANOTHER_VERSION),
      testing::StartsWith(TEST_PLUGIN_OF_ANOTHER_VERSION
                          ": was built for 'tassilo 0.0.1 by gcc 4', this is 'tassilo " TASSILO_VERSION " by "));
}

// A library that was built anew while the program runs: dlopen alone would give the one that it has by this name.
TEST(Plugins, WrittenAnewAreLoadedAnew) {
  const fs::path folder = testing::TempDir() + "tassilo_plugin_" + std::to_string(getpid());
  fs::create_directory(folder);
  const std::string file = folder / "plugin.so";
  const auto replace_by = [&](const std::string& other) {
    fs::copy_file(other, folder / "new");
    fs::rename(folder / "new", file);
  };
  for (int again = 0; again < 2; ++again) {
    replace_by(kPlugin);
    EXPECT_EQ(message_of(file), "no error");
    replace_by(TEST_PLUGIN_OF_ANOTHER_VERSION);
    EXPECT_THAT(message_of(file), testing::HasSubstr("was built for 'tassilo 0.0.1 by gcc 4'"));
  }
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(1));
  EXPECT_EQ(message_of(file),
            file + ": was written over while in use, must be replaced by another file, as linkers and mv do");
  fs::remove_all(folder);
}

TEST(Plugins, ThatRegisterWhatTheyMustNotAreRefused) {
  const std::vector<std::pair<const char*, std::string>> cases{
      {"throws an error", "cannot register its alternatives: camera: is not there"},
      {"throws a number", "cannot register its alternatives: throws what is no std::exception"},
      {"nothing", "registers no alternative"},
      {"twice", "alternative 'balls: blind' exists already"},
      {"first", "moves or removes alternatives of others, must add its own behind them"},
      {"alone", "moves or removes alternatives of others, must add its own behind them"}};
  for (const auto& [what, message] : cases) {
    const Wrong wrong(what);
    EXPECT_EQ(message_of(kPlugin), kPlugin + ": " + message) << what;
  }
  EXPECT_EQ(message_of(kPlugin), "no error") << "what went wrong before is forgotten";
}

}  // namespace
}  // namespace tassilo
