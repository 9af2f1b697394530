#include "tassilo/app/match_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

double percent(std::int64_t part, std::int64_t all) {
  return all > 0 ? 100. * static_cast<double>(part) / static_cast<double>(all) : 0;
}

std::string centimeters(const Histogram& errors, double q, int width) {
  const double cm = 100 * errors.quantile(q);
  return errors.is_beyond(q) ? fmt::format("{:>{}}", fmt::format(">{:.0f}", cm), width)
                             : fmt::format("{:>{}.1f}", cm, width);
}

std::string error_line(const char* what, const Histogram& errors) {
  if (errors.size() == 0) return fmt::format("{:<30}  never\n", what);
  return fmt::format("{:<30} {:>7} {} {}\n", what, errors.size(), centimeters(errors, 0.5, 9),
                     centimeters(errors, 0.9, 8));
}

std::string ball_line(const std::string& who, const BallKnowledge& ball) {
  if (ball.known == 0) return fmt::format("{:<30}  never\n", who);
  return fmt::format("{:<30} {:>7} {} {} {:>8.1f} {:>8.2f} {:>8.1f}\n", who, ball.moments,
                     centimeters(ball.errors, 0.5, 9), centimeters(ball.errors, 0.9, 8),
                     percent(ball.known, ball.moments), ball.squared.quantile(0.5),
                     100 * ball.squared.share_above(9.21));
}

}  // namespace

std::size_t Histogram::bin_of(double value) const {
  if (!(value > 0)) return 0;
  return static_cast<std::size_t>(std::min(value / width_, static_cast<double>(kBins - 1)));
}

void Histogram::add(double value) {
  expects(std::isfinite(value), "Histogram: a number");
  ++counts_[bin_of(value)];
  ++size_;
}

double Histogram::quantile(double q) const {
  const auto rank = static_cast<std::int64_t>(q * static_cast<double>(size_ - 1) + 0.5);
  std::int64_t passed = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    passed += counts_[bin];
    if (passed > rank) return (static_cast<double>(bin) + 0.5) * width_;
  }
  return 0;
}

double Histogram::share_above(double value) const {
  if (size_ == 0) return 0;
  std::int64_t above = 0;
  for (std::size_t bin = bin_of(value) + 1; bin < kBins; ++bin) above += counts_[bin];
  return static_cast<double>(above) / static_cast<double>(size_);
}

std::string text_of(const MatchReport& report) {
  if (report.images == 0) return "nothing was seen, so there is nothing to compare\n";
  std::string text = "\nagainst the truth                values median cm    90 % cm\n";
  text += error_line("ball, as each robot sees it", report.ball_errors);
  text += error_line("pose", report.pose_errors);
  text += fmt::format("images with balls of which none is within {:.1f} m of the ball: {} of {}\n",
                      MatchReport::kAnother, report.false_balls, report.images);
  text += fmt::format("longest time without a pose within half a metre: {:.1f} s\n", report.longest_lost);

  text += "\nball while any robot sees it    moments median cm    90 % cm  known %  squared  above 9.21 %\n";
  text += ball_line("surest robot by itself", report.surest);
  text += ball_line("robots that see it, and hear", report.seeing);
  text += ball_line("robots that only hear", report.blind);
  text += ball_line("bench", report.bench);
  for (const RadioFigures& radio : report.radios)
    text += ball_line(fmt::format("bench, {:.0f} % lost, {:.0f} ms late", 100 * radio.loss, 1000 * radio.delay_s),
                      radio.ball);
  text += "squared: median of errors by their covariance, squared; 1.39 is right, and 1 % above 9.21\n";

  std::vector<std::pair<std::int64_t, std::string>> deeds;
  std::int64_t all = 0;
  for (const auto& [deed, count] : report.deeds) {
    deeds.emplace_back(-count, deed);
    all += count;
  }
  std::ranges::sort(deeds);
  text += "\ncyan:";
  for (const auto& [count, deed] : deeds) text += fmt::format(" {} {:.0f} %", deed, percent(-count, all));
  const AirCounts& air = report.air;
  text += fmt::format(
      "\nwords between robots: {} told = {} lost + {} refused + {} under way + {} taken + {} too late + {} repeated"
      " + {} without a possible time\n",
      air.told, air.lost, air.refused, report.on_the_way, report.taken, report.late, report.repeated,
      report.of_no_time);
  if (report.left > 0) text += fmt::format("robots left {} times, came back {} times\n", report.left, report.came_back);
  return text;
}

}  // namespace tassilo
