#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/app/robot_setup.h"

namespace tassilo {

/// A robot as its files say, and the vision made of it.
struct Configuration {
  std::int64_t read_at_ns = 0;  ///< When reading the files began, since the UNIX epoch.
  std::int64_t load = 0;        ///< Counts the configurations that this program has loaded.
  RobotSetup setup;
  Vision vision;
};
/// Reads all files and sets up the vision. `change` may set what the command line says. Throws Error naming the file
/// that is wrong.
std::shared_ptr<const Configuration> load_configuration(const std::string& robot_file, const std::string& colors,
                                                        const std::vector<std::string>& plugins,
                                                        const std::function<void(RobotSetup&)>& change);

/// Watches the files of a configuration while it is at work, and loads it anew in a thread of its own when one of them
/// was written: the caller takes the new one over when it likes, between two frames.
///
/// A file counts as written when its time, size or identity changed and then stayed for a moment, so that half written
/// files are not read. What cannot be loaded is told once; the loading is tried again until it works, since a missing
/// file may still come.
class ConfigurationWatch {
 public:
  /// Reads all files anew. Throws Error when one is wrong, or does not fit what is being seen.
  using Load = std::function<std::shared_ptr<const Configuration>()>;

  ConfigurationWatch(const Configuration& now, Load load);
  ~ConfigurationWatch();
  ConfigurationWatch(const ConfigurationWatch&) = delete;
  ConfigurationWatch& operator=(const ConfigurationWatch&) = delete;

  struct News {
    std::shared_ptr<const Configuration> configuration;  ///< The latest that could be loaded; null: none.
    std::string refusal;                                 ///< Why one after it could not; empty: there was none.
  };
  /// What happened since the last call. Does not wait.
  std::optional<News> news();

 private:
  /// What a file looked like; a missing one has no identity.
  struct FileState {
    std::string path;
    std::int64_t changed_ns = 0, size = -1;
    std::uint64_t identity = 0;
    friend bool operator==(const FileState&, const FileState&) = default;
  };
  /// As they were when they were read; what was written since then, or at that moment, has no time.
  static std::vector<FileState> read_states_of(const Configuration& configuration);
  static FileState state_of(const std::string& path);

  void watch();

  Load load_;
  std::vector<FileState> loaded_;  ///< When they were last read. Of the thread alone.
  std::mutex mutex_;
  std::condition_variable ending_;
  bool ended_ = false;
  std::optional<News> news_;
  std::thread thread_;  ///< Last: it uses all of the above.
};

}  // namespace tassilo
