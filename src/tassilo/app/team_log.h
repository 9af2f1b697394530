#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/app/team_bench.h"
#include "tassilo/app/team_trails.h"
#include "tassilo/record/mcap_reader.h"
#include "tassilo/team/team_view.h"

namespace tassilo {

/// A log looked at as if it were the bus: what was known of the team at any time of it.
///
/// Going forward by little, it goes on from where it is; else it begins ten seconds before.
///
/// threads  one at a time
class TeamLog {
 public:
  /// Throws Error when the file is no log, or has no topic of a robot.
  TeamLog(const std::filesystem::path& file, const TeamViewOptions& options, const TeamFusionOptions& fusion);

  double begin() const { return begin_; }  ///< Of its first and last message. [s since the UNIX epoch]
  double end() const { return end_; }
  /// Where and why it ends early; empty when it is whole.
  const std::string& damage() const { return reader_.damage(); }
  /// Robots of which it has pictures, rising.
  const std::vector<int>& with_pictures() const { return with_pictures_; }

  /// At most as many messages are read as lie in ten seconds of the log. Throws Error when it cannot be read any more.
  TeamPicture at(double t);
  /// What the team knew together where it is, of which `at` told last.
  TeamWorld world() { return bench_.at(now_.value_or(begin_)); }
  /// Where robots were in the seconds before `t`, as far as ten seconds back.
  std::vector<TeamTrail> trails(double t, double seconds);
  /// The newest annotated picture, a JPEG, of the two seconds before t; nothing when there is none.
  std::optional<std::string> picture(int robot, double t);
  /// What happened between where it last began and where it is. Numbered by when it was, so that a piece of news has
  /// the same number whenever it is come upon.
  std::vector<TeamNews> news() const;

 private:
  void begin_before(double t);

  McapReader reader_, picture_reader_;  ///< Each goes through the log at its own place.
  TeamViewOptions options_;
  TeamFusionOptions fusion_options_;
  double begin_ = 0, end_ = 0;
  std::vector<int> with_pictures_;
  TeamView view_;
  TeamBench bench_;
  TeamTrails trails_;
  std::optional<double> now_;         ///< All messages up to here have been heard.
  std::optional<McapMessage> ahead_;  ///< The first one after that.
  std::vector<std::byte> ahead_data_;
};

}  // namespace tassilo
