// The table "Team ball in simulation" of docs/accuracy.md: made-up matches over a made-up radio.
//
// usage: fusion_score [FIRST_SEED [LAST_SEED]]      default 1 20

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "tassilo/fusion/test_match.h"

namespace {

using namespace tassilo::test;

void append(std::vector<Answer>& all, const std::vector<Answer>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void print(const std::string& who, const std::vector<Answer>& answers) {
  const Figures f = figures_of(answers);
  std::printf("| %s | %.1f %% | %.1f cm (%.0f) | %.1f, %.1f | %.1f %% |", who.c_str(), 100 * f.available,
              100 * f.median, 100 * f.ninety, f.squared, f.squared_median, 100 * f.outside);
  if (f.opponent_median > 0)
    std::printf(" %.1f %% | %.2f | %.1f cm | %.1f |\n", 100 * f.opponents_missed, f.ghosts, 100 * f.opponent_median,
                f.opponent_squared);
  else
    std::printf(" - | - | - | - |\n");
}

std::vector<Answer> only(const std::vector<Answer>& answers, bool own_sight) {
  std::vector<Answer> some;
  for (const Answer& one : answers)
    if (one.own_sight == own_sight) some.push_back(one);
  return some;
}

}  // namespace

int main(int count, char** arguments) {
  const unsigned first = count > 1 ? static_cast<unsigned>(std::atoi(arguments[1])) : 1;
  const unsigned last = count > 2 ? static_cast<unsigned>(std::atoi(arguments[2])) : 20;
  std::vector<Match> matches;
  for (unsigned seed = first; seed <= last; ++seed) matches.push_back(play({.seed = seed}));

  std::printf(
      "| seeds %u to %u | ball there | error, median (90 %%) | squared error, mean, median (2, 1.39) | above 9.21 (1 "
      "%%) | "
      "opponents missed | told, but none | error, median | squared error (2) |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      first, last);
  std::vector<Answer> sightings, surest, each;
  for (const Match& match : matches) {
    append(sightings, answers_of_best_sighting(match));
    std::vector<std::vector<Answer>> alone;
    for (int robot = 0; robot < 4; ++robot) {
      alone.push_back(answers_alone(match, robot));
      append(each, alone.back());
    }
    append(surest, answers_of_surest(alone));
  }
  print("each robot alone", each);
  print("each robot alone, seeing it", only(each, true));
  print("surest robot's sighting", sightings);
  print("surest robot alone", surest);
  for (const double loss : {0.0, 0.1, 0.3, 0.6})
    for (const double delay : {0.0, 0.1, 0.2, 0.5}) {
      std::vector<Answer> bench, robots;
      for (std::size_t i = 0; i < matches.size(); ++i) {
        const Radio radio{loss, delay, first + static_cast<unsigned>(i)};
        append(bench, answers_of_team(matches[i], radio, kBench));
        append(robots, answers_of_team(matches[i], radio, static_cast<int>(i % 4)));
      }
      const std::string radio = std::to_string(static_cast<int>(100 * loss + 0.5)) + " % lost, " +
                                std::to_string(static_cast<int>(1000 * delay + 0.5)) + " ms: ";
      print(radio + "bench", bench);
      print(radio + "robot seeing it", only(robots, true));
      print(radio + "robot not", only(robots, false));
    }
  return 0;
}
