#include "tassilo/app/match_air.h"

#include <algorithm>
#include <array>

#include "tassilo/base/option_check.h"
#include "tassilo/message/from_scene.h"
#include "tassilo/message/plausible.h"
#include "tassilo/message/to_scene.h"

namespace tassilo {
namespace {

std::optional<Role> role_from(const std::string& name) {
  for (const Role role : {Role::goalkeeper, Role::defender, Role::striker})
    if (to_string(role) == name) return role;
  return std::nullopt;
}

template <class M>
std::optional<M> believed(const std::vector<std::byte>& bytes, int robot) {
  std::optional<M> message = decoded<M>(bytes);
  if (message && !implausible(*message, robot).empty()) message.reset();
  return message;
}

}  // namespace

TeamPacket packet_of(int robot, Team team, const Scene& scene, Role role) {
  const MessageContext context{.robot = robot, .team = team};
  const ros::Time stamp = ros_time(scene.t);
  msgs::TeamState state = team_state_message(scene, stamp, context);
  state.role = std::string(to_string(role));
  TeamPacket packet{encoded(state),
                    encoded(balls_message(scene, stamp, context)),
                    encoded(robots_message(scene, stamp, context)),
                    {}};
  if (scene.pose) packet.pose = encoded(pose_message(*scene.pose, stamp));
  return packet;
}

std::optional<TeamWord> word_of(const TeamPacket& packet, int robot) {
  const auto state = believed<msgs::TeamState>(packet.state, robot);
  const auto balls = believed<msgs::BallArray>(packet.balls, robot);
  const auto robots = believed<msgs::RobotArray>(packet.robots, robot);
  if (!state || !balls || !robots) return std::nullopt;
  // Of one image, or nothing can be said of any.
  const std::int64_t stamp = nanoseconds_of(state->header.stamp);
  const auto is_of_it = [&](const ros::Header& header) { return nanoseconds_of(header.stamp) == stamp; };
  if (!is_of_it(balls->header) || !is_of_it(robots->header)) return std::nullopt;
  TeamWord word;
  word.role = role_from(state->role);
  word.observation.robot = robot;
  word.observation.t = seconds_of(state->header.stamp);
  word.observation.stamp = stamp;
  word.observation.balls = balls_from(*balls);
  word.observation.robots = robots_from(*robots);
  if (packet.pose.empty()) return word;
  const auto pose = believed<ros::PoseWithCovarianceStamped>(packet.pose, robot);
  if (!pose || !is_of_it(pose->header)) return std::nullopt;
  word.observation.pose = pose_from(*pose);
  add_state(*word.observation.pose, *state);
  return word;
}

TeamPacket spoiled(TeamPacket packet, std::mt19937_64& random) {
  const std::array<std::vector<std::byte>*, 4> messages{&packet.state, &packet.balls, &packet.robots, &packet.pose};
  std::vector<std::byte>& bytes = *messages[random() % messages.size()];
  if (bytes.empty()) {
    const std::size_t size = 1 + random() % 64;
    bytes.assign(size, static_cast<std::byte>(random()));
    return packet;
  }
  switch (random() % 4) {
    case 0:
      bytes.resize(random() % bytes.size());
      break;
    case 1: {
      const std::size_t at = random() % bytes.size();
      bytes[at] ^= static_cast<std::byte>(1 + random() % 255);
    } break;
    case 2:
      for (std::byte& byte : bytes)
        if (random() % 4 == 0) byte = static_cast<std::byte>(random());
      break;
    default:  // as long as it was, but no numbers
      std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), bytes.end(), std::byte{0xff});
  }
  return packet;
}

void AirOptions::check() const {
  check_between("air.loss", loss, 0, 1);
  check_between("air.delay", delay_s, 0, 60);
}

MatchAir::MatchAir(const AirOptions& options) : options_((options.check(), options)), random_(options.seed) {}

void MatchAir::tell(double t, int from, int to, const std::shared_ptr<const TeamPacket>& packet) {
  std::uniform_real_distribution<double> chance(0, 1);
  ++counts_.told;
  const bool is_lost = chance(random_) < options_.loss;
  const double takes = 2 * options_.delay_s * chance(random_);
  if (is_lost)
    ++counts_.lost;
  else
    packets_.push_back({t + takes, from, to, packet});
}

std::vector<MatchAir::Heard> MatchAir::hear(double now) {
  std::vector<Heard> heard;
  for (const Flying& flying : packets_) {
    if (flying.due > now) continue;
    if (auto word = word_of(*flying.packet, flying.from)) {
      heard.push_back({flying.to, std::move(*word)});
      ++counts_.heard;
    } else {
      ++counts_.refused;
    }
  }
  std::erase_if(packets_, [&](const Flying& flying) { return flying.due <= now; });
  return heard;
}

void MatchAir::leave(int listener) {
  counts_.lost +=
      static_cast<std::int64_t>(std::erase_if(packets_, [&](const Flying& flying) { return flying.to == listener; }));
}

}  // namespace tassilo
