// Plays matches without pictures and tells the goals: play_matches FIELD FIRST_SEED LAST_SEED SECONDS CYAN MAGENTA
// [SVG] CYAN and MAGENTA: seeing, black, blind, absent. With SVG the last match is drawn, one picture each PANEL (10)
// seconds.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/field_file.h"
#include "tassilo/sim/test_match.h"

namespace {

using namespace tassilo;
using namespace tassilo::test;

Players players_of(const std::string& name) {
  if (name == "seeing") return Players::seeing;
  if (name == "black") return Players::black;
  if (name == "blind") return Players::blind;
  if (name == "absent") return Players::absent;
  throw Error("players", "is " + name + ", must be seeing, black, blind or absent");
}

int play(const std::vector<std::string>& words) {
  if (words.size() < 6) throw Error("play_matches", "needs FIELD FIRST_SEED LAST_SEED SECONDS CYAN MAGENTA [SVG]");
  const FieldModel field = read_field(words[0]);
  const int first = std::stoi(words[1]), last = std::stoi(words[2]);
  const double seconds = std::stod(words[3]);
  int cyan = 0, magenta = 0, stuck = 0, out = 0;
  for (int seed = first; seed <= last; ++seed) {
    MatchOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    options.cyan = players_of(words[4]);
    options.magenta = players_of(words[5]);
    Match match(field, options);
    std::vector<Trace> traces;
    std::map<std::string, int> actions, begun;
    std::map<int, std::string> before;
    while (match.world().state().t < seconds - 1e-9) {
      match.step();
      for (const auto& [id, output] : match.outputs()) {
        ++actions[output.action];
        begun[output.action] += before[id] != output.action;
        before[id] = output.action;
      }
      if (const char* who = std::getenv("WHO")) {
        for (const SimRobot& r : match.world().state().robots)
          if (r.id == std::atoi(who)) {
            const auto& b = match.world().state().ball;
            const auto& o = match.outputs().at(r.id);
            const double dx = b.at.x - r.at.x, dy = b.at.y - r.at.y;
            std::printf(
                "%.2f at %.2f %.2f %.0f v %.2f w %.2f | ball %.2f %.2f rel d %.2f a %.0f | %.2f %.2f k%d %s / %s\n",
                match.world().state().t, r.at.x, r.at.y, r.theta * 57.3, r.speed, r.turn, b.at.x, b.at.y,
                std::hypot(dx, dy), std::remainder(std::atan2(dy, dx) - r.theta, 6.2831853) * 57.3, o.wheels.left,
                o.wheels.right, o.wheels.is_kick, o.action.c_str(), o.planning_state.c_str());
          }
      }
      for (static std::size_t told = 0; std::getenv("CALLS") && told < match.calls().size(); ++told)
        std::printf("%.2f %s\n", match.calls()[told].t, std::string(to_string(match.calls()[told].call)).c_str());
      if (words.size() > 6) traces.push_back({match.world().state().t, match.world().state(), match.outputs()});
    }
    int stuck_here = 0, out_here = 0;
    for (const RefereeEvent& call : match.calls()) {
      stuck_here += call.call == RefereeCall::stuck_ball;
      out_here += call.call == RefereeCall::ball_out;
    }
    const Score score = match.world().score();
    std::printf("seed %d: %d : %d, stuck %d, out %d;", seed, score.cyan, score.magenta, stuck_here, out_here);
    double all = 0;
    for (const auto& [action, count] : actions) all += count;
    for (const auto& [action, count] : actions)
      std::printf(" %s %.0f%% (%d)", action.c_str(), 100 * count / all, begun[action]);
    std::printf("\n");
    std::fflush(stdout);
    cyan += score.cyan;
    magenta += score.magenta;
    stuck += stuck_here;
    out += out_here;
    if (words.size() > 6 && seed == last)
      std::ofstream(words[6]) << svg_of(traces, match.world(), words.size() > 7 ? std::stod(words[7]) : 10);
  }
  const double matches = last - first + 1;
  std::printf("in the mean of %.0f matches of %g s: cyan %.2f, magenta %.2f, stuck %.1f, out %.1f\n", matches, seconds,
              cyan / matches, magenta / matches, stuck / matches, out / matches);
  return 0;
}

}  // namespace

int main(int count, char** words) {
  try {
    return play({words + 1, words + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
