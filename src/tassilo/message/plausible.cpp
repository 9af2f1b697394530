#include "tassilo/message/plausible.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

constexpr double kFarthest = 100;         // no hall is larger [m]
constexpr double kFastest = 100;          // no ball is faster [m/s], no robot turns faster [rad/s]
constexpr double kLargestVariance = 1e6;  // (1 km)^2: nothing is known at all
constexpr double kLongest = 1e6;          // no age is longer: eleven days [s]
constexpr std::size_t kMostThings = 100;  // of a kind on one field
constexpr std::size_t kMostLines = 1000;
constexpr std::size_t kMostSectors = 3600;  // a tenth of a degree each
constexpr std::size_t kLongestText = 100;   // [B]

/// The character at this place of UTF-8, which is put behind it; 0 where there is none: bytes that are missing, more
/// than needed, or half of a pair.
char32_t next_character(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const unsigned char first = byte(at);
  const std::size_t size = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  char32_t character = size == 1 ? first : first & (0x7f >> size);
  bool ok = size == 1 || (first >= 0xc2 && first < 0xf5);
  for (std::size_t i = 1; i < size; ++i) {
    ok = ok && (byte(at + i) & 0xc0) == 0x80;
    character = character << 6 | (byte(at + i) & 0x3f);
  }
  at += size;
  ok = ok && character >= least[size] && character <= 0x10ffff && !(character >= 0xd800 && character < 0xe000);
  return ok ? character : 0;
}

/// The first thing that is wrong is kept.
class Check {
 public:
  Check(const ros::Header& header, const std::string& frame) {
    require(header.stamp.nanosec < 1'000'000'000 && header.stamp.sec >= 0, "its stamp is no time");
    require(header.frame_id == frame, std::string("is not in frame ").append(frame));
  }

  void require(bool holds, std::string_view why) {
    if (!holds && why_.empty()) why_ = why;
  }
  void within(double value, double low, double high, std::string_view what) {
    if (!(value >= low && value <= high)) require(false, std::string(what).append(" is out of range"));  // so is NaN
  }
  void place(const ros::Point& point, std::string_view what) {
    within(point.x, -kFarthest, kFarthest, what);
    within(point.y, -kFarthest, kFarthest, what);
    within(point.z, -kFarthest, kFarthest, what);
  }
  void count(std::size_t count, std::size_t most, std::string_view what) {
    require(count <= most, std::string("too many ").append(what));
  }
  /// Row-major, n x n: symmetric, and each pair of values no more dependent than can be.
  void covariance(std::span<const double> c, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      within(c[i * n + i], 0, kLargestVariance, "a variance");
      for (std::size_t j = 0; j < i; ++j) {
        const double a = c[i * n + j], b = c[j * n + i];
        const double most = std::sqrt(c[i * n + i] * c[j * n + j]);
        constexpr double rounding = 1e-6;
        require(std::abs(a - b) <= rounding * most + 1e-12, "a covariance is not symmetric");
        require(std::abs(a) <= (1 + rounding) * most + 1e-12, "a covariance is none");
      }
    }
  }
  void rotation(const ros::Quaternion& q) {
    constexpr double rounding = 1e-2;
    within(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w, 1 - rounding, 1 + rounding, "the length of a rotation");
  }
  /// UTF-8 that can be shown: without control characters, and without those that turn the direction of writing.
  void text(std::string_view text, std::string_view what) {
    bool ok = text.size() <= kLongestText;
    for (std::size_t at = 0; ok && at < text.size();) {
      const char32_t character = next_character(text, at);
      ok = character >= 0x20 && !(character >= 0x7f && character < 0xa0) && character != 0x200e &&
           character != 0x200f && !(character >= 0x2028 && character <= 0x202e) &&
           !(character >= 0x2066 && character <= 0x2069);
    }
    require(ok, std::string(what).append(" is no short text"));
  }
  std::string why() { return std::move(why_); }

 private:
  std::string why_;
};

Check check_of_robot(const ros::Header& header, int robot) { return {header, robot_frame_id(robot, "base_link")}; }

void check_pose(Check& check, const ros::PoseWithCovariance& pose) {
  check.place(pose.pose.position, "the position");
  check.rotation(pose.pose.orientation);
  check.covariance(pose.covariance, 6);
}

}  // namespace

std::string implausible(const ros::PoseWithCovarianceStamped& message, int /*robot*/) {
  Check check(message.header, "map");
  check_pose(check, message.pose);
  return check.why();
}

std::string implausible(const ros::Odometry& message, int robot) {
  Check check(message.header, robot_frame_id(robot, "odom"));
  // Odometry drifts, but for how long may a robot drive?
  check.within(message.pose.pose.position.x, -kLongest, kLongest, "the position");
  check.within(message.pose.pose.position.y, -kLongest, kLongest, "the position");
  check.rotation(message.pose.pose.orientation);
  check.covariance(message.pose.covariance, 6);
  for (const ros::Vector3& v : {message.twist.twist.linear, message.twist.twist.angular})
    for (const double value : {v.x, v.y, v.z}) check.within(value, -kFastest, kFastest, "the velocity");
  check.covariance(message.twist.covariance, 6);
  return check.why();
}

std::string implausible(const msgs::FreeSpace& message, int robot) {
  Check check = check_of_robot(message.header, robot);
  check.place(message.origin, "the origin");
  check.within(message.angle_min, -10, 10, "an angle");
  check.within(message.angle_increment, 0, 10, "an angle");
  check.within(message.range_max, 0, 10 * kFarthest, "the maximal range");
  check.count(message.ranges.size(), kMostSectors, "sectors");
  check.require(message.ranges.size() == message.states.size(), "as many ranges as states");
  for (std::size_t i = 0; i < std::min(message.ranges.size(), message.states.size()); ++i) {
    check.require(message.states[i] <= 2, "a state is none");
    if (message.states[i] != 0) check.within(message.ranges[i], 0, 1.001 * message.range_max, "a range");
  }
  return check.why();
}

std::string implausible(const msgs::BallArray& message, int robot) {
  Check check = check_of_robot(message.header, robot);
  check.count(message.balls.size(), kMostThings, "balls");
  for (const msgs::Ball& ball : message.balls) {
    check.place(ball.center, "a ball");
    check.covariance(ball.covariance, 2);
    check.within(ball.near, 0, kFarthest, "a distance");
    check.within(ball.far, 0, HUGE_VAL, "a distance");  // infinite: no upper bound
    check.within(ball.confidence, 0, 1, "a confidence");
  }
  return check.why();
}

std::string implausible(const msgs::RobotArray& message, int robot) {
  Check check = check_of_robot(message.header, robot);
  check.count(message.robots.size(), kMostThings, "robots");
  for (const msgs::Robot& other : message.robots) {
    check.require(other.team <= 2, "a team is none");
    check.place(other.nearest, "a robot");
    check.place(other.center, "a robot");
    check.covariance(other.covariance, 2);
    check.within(other.near, 0, kFarthest, "a distance");
    check.within(other.far, 0, HUGE_VAL, "a distance");
    check.within(other.width, 0, kFarthest, "a width");
  }
  return check.why();
}

std::string implausible(const msgs::GoalArray& message, int robot) {
  Check check = check_of_robot(message.header, robot);
  check.count(message.goals.size(), kMostThings, "goals");
  for (const msgs::Goal& goal : message.goals) {
    check.require(goal.color <= 1, "a color is none");
    check.within(goal.bearing, -10, 10, "a bearing");
    // NaN: not known.
    if (!std::isnan(goal.center.x) || !std::isnan(goal.center.y)) check.place(goal.center, "a goal");
    check.count(goal.posts.size(), 2, "posts");
    for (const msgs::GoalPost& post : goal.posts) {
      check.require(post.side <= 1, "a side is none");
      check.place(post.base, "a post");
    }
  }
  return check.why();
}

std::string implausible(const msgs::LineArray& message, int robot) {
  Check check = check_of_robot(message.header, robot);
  check.count(message.lines.size(), kMostLines, "lines");
  check.count(message.circles.size(), kMostLines, "circles");
  for (const msgs::Line& line : message.lines) {
    check.require(line.kind <= 1, "a kind is none");
    check.place(line.p, "a line");
    check.place(line.q, "a line");
    check.text(line.model, "a model");
  }
  for (const msgs::Circle& circle : message.circles) {
    check.place(circle.center, "a circle");
    check.within(circle.radius, 0, kFarthest, "a radius");
  }
  return check.why();
}

std::string implausible(const msgs::TrackArray& message, int robot) {
  Check check = check_of_robot(message.header, robot);
  check.count(message.tracks.size(), kMostThings, "tracks");
  for (const msgs::Track& track : message.tracks) {
    check.require(track.kind <= 1 && track.team <= 2, "a kind is none");
    check.place(track.position, "a track");
    for (const double speed : {track.velocity.x, track.velocity.y, track.velocity.z})
      check.within(speed, -kFastest, kFastest, "a speed");
    check.covariance(track.covariance, 4);
    check.within(track.age, 0, kLongest, "an age");
  }
  return check.why();
}

std::string implausible(const msgs::TeamState& message, int robot) {
  Check check = check_of_robot(message.header, robot);
  check.require(message.robot == robot, "is of robot " + std::to_string(message.robot));
  check.require(message.team <= 2, "a team is none");
  check.require(message.pose_kind <= 6, "a kind is none");
  check.text(message.role, "the role");
  check.text(message.action, "the action");
  check.text(message.planning_state, "the planning state");
  check.within(message.pose_age, 0, kLongest, "an age");
  check.within(message.frame_rate, 0, 1e4, "the rate");
  check.within(message.latency, 0, kLongest, "the latency");
  check.within(message.bytes_per_second, 0, 1e10, "the bytes");
  return check.why();
}

std::string implausible(const ros::CompressedImage& message, int /*robot*/) {
  Check check(message.header, message.header.frame_id);
  check.text(message.header.frame_id, "the frame");
  check.text(message.format, "the format");
  check.require(message.format.starts_with("jpeg") || message.format.ends_with("jpeg"), "is no JPEG");
  // A file that a browser is shown begins as one.
  check.require(message.data.size() > 3 && message.data[0] == 0xff && message.data[1] == 0xd8, "is no JPEG");
  return check.why();
}

}  // namespace tassilo
