#include "tassilo/app/odometry_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tassilo/base/error.h"

namespace tassilo {

OdometryInput::OdometryInput(const std::string& location, bool waits,
                             std::function<std::vector<OdometrySample>()> taken)
    : location_(location), taken_(std::move(taken)) {
  if (taken_) {
    odometry_.emplace();
    return;
  }
  if (location.empty()) return;
  if (is_line_stream(location)) {
    waits_ = waits && location == "-";
    stream_.emplace(location);
    odometry_.emplace();
    return;
  }
  recorded_ = read_odometry_lines(location);
  is_recorded_ = std::ranges::any_of(recorded_, [](const OdometryLine& line) { return line.frame.has_value(); });
  if (is_recorded_) {
    restart();
    return;
  }
  odometry_.emplace(std::max<std::size_t>(2, recorded_.size()));
  for (const OdometryLine& line : recorded_) odometry_->add(line.sample);
  recorded_ = {};
}

void OdometryInput::restart() {
  if (!is_recorded_) return;
  odometry_.emplace();  // as large as that of the run that was recorded
  for (next_recorded_ = 0; next_recorded_ < recorded_.size() && !recorded_[next_recorded_].frame; ++next_recorded_)
    odometry_->add(recorded_[next_recorded_].sample);
}

void OdometryInput::update(const Frame& frame, const std::function<bool()>& interrupted) {
  arrived_.clear();
  for (; next_recorded_ < recorded_.size() && recorded_[next_recorded_].frame.value_or(0) <= frame.index;
       ++next_recorded_) {
    odometry_->add(recorded_[next_recorded_].sample);
    arrived_.push_back(recorded_[next_recorded_].sample);
  }
  if (taken_)
    for (const OdometrySample& sample : taken_()) {
      odometry_->add(sample);
      arrived_.push_back(sample);
    }
  if (!stream_) return;
  constexpr std::chrono::milliseconds kPatience(100);
  const auto knows = [&] { return newest_ && *newest_ >= frame.t; };
  while (true) {
    const bool is_over = stream_->over();
    const bool may_wait = waits_ && !is_over && !knows();
    for (const std::string& line : stream_->take(may_wait ? kPatience : kPatience * 0)) add(line);
    if (!may_wait || interrupted()) return;
  }
}

void OdometryInput::add(const std::string& line) {
  ++lines_;
  try {
    const OdometrySample sample =
        read_odometry_line(line, fmt::format("{}:{}", location_ == "-" ? "standard input" : location_, lines_)).sample;
    odometry_->add(sample);
    arrived_.push_back(sample);
    newest_ = std::max(newest_.value_or(sample.t), sample.t);
  } catch (const Error& refusal) {
    if (refused_++ == 0) first_refusal_ = refusal.what();
  }
}

std::string OdometryInput::summary() const {
  std::string text;
  if (refused_ > 0)
    text += fmt::format("odometry: {} of {} lines refused, the first: {}\n", refused_, lines_, first_refusal_);
  const std::int64_t dropped = stream_ ? stream_->dropped() : 0;
  if (dropped > 0) text += fmt::format("odometry: {} lines dropped, too long or too many\n", dropped);
  return text;
}

}  // namespace tassilo
