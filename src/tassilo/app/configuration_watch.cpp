#include "tassilo/app/configuration_watch.h"

#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <utility>

namespace tassilo {
namespace {

constexpr auto kPause = std::chrono::milliseconds(50);  // between two looks; people do not notice that
constexpr int kPausesUntilRetry = 10;

}  // namespace

std::shared_ptr<const Configuration> load_configuration(const std::string& robot_file, const std::string& colors,
                                                        const std::vector<std::string>& plugins,
                                                        const std::function<void(RobotSetup&)>& change) {
  using std::chrono::system_clock, std::chrono::nanoseconds;
  const auto now = std::chrono::duration_cast<nanoseconds>(system_clock::now().time_since_epoch());
  static std::atomic<std::int64_t> loads = 0;
  RobotSetup setup = read_robot_setup(robot_file, colors, plugins);
  change(setup);
  Vision vision(setup.vision, setup.registry);
  return std::make_shared<const Configuration>(
      Configuration{now.count(), ++loads, std::move(setup), std::move(vision)});
}

ConfigurationWatch::FileState ConfigurationWatch::state_of(const std::string& path) {
  FileState state{.path = path};
  struct stat found {};
  if (stat(path.c_str(), &found) != 0) return state;
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  state.changed_ns = found.st_mtim.tv_sec * ns_per_s + found.st_mtim.tv_nsec;
  state.size = found.st_size;
  state.identity = found.st_ino;
  return state;
}

std::vector<ConfigurationWatch::FileState> ConfigurationWatch::read_states_of(const Configuration& configuration) {
  constexpr std::int64_t coarse_ns = 10'000'000;  // file systems' clocks tick some ms
  std::vector<FileState> states;
  for (const NamedFile& file : configuration.setup.read) {
    if (file.path.empty()) continue;
    FileState& state = states.emplace_back(state_of(file.path));
    if (state.changed_ns > configuration.read_at_ns - coarse_ns) state.changed_ns = 0;
  }
  return states;
}

ConfigurationWatch::ConfigurationWatch(const Configuration& now, Load load)
    : load_(std::move(load)), loaded_(read_states_of(now)), thread_([this] { watch(); }) {}

ConfigurationWatch::~ConfigurationWatch() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  ending_.notify_all();
  thread_.join();
}

void ConfigurationWatch::watch() {
  std::vector<FileState> before = loaded_;
  std::string refusal;
  int pauses = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (ending_.wait_for(lock, kPause, [&] { return ended_; })) return;
    }
    std::vector<FileState> now;
    for (const FileState& file : before) now.push_back(state_of(file.path));
    const bool settled = now == before;
    before = std::move(now);
    const bool again = !refusal.empty() && ++pauses >= kPausesUntilRetry;
    if (!settled || (before == loaded_ && !again)) continue;
    loaded_ = before;
    pauses = 0;
    try {
      std::shared_ptr<const Configuration> configuration = load_();
      loaded_ = before = read_states_of(*configuration);
      refusal.clear();
      const std::lock_guard lock(mutex_);
      news_ = {std::move(configuration), ""};
    } catch (const std::exception& error) {  // whatever it is, the one at work goes on
      const bool is_new = refusal != error.what();
      refusal = error.what();
      const std::lock_guard lock(mutex_);
      if (is_new) (news_ ? *news_ : news_.emplace()).refusal = refusal;
    }
  }
}

std::optional<ConfigurationWatch::News> ConfigurationWatch::news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, std::nullopt);
}

}  // namespace tassilo
