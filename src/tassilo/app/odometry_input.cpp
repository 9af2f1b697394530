#include "tassilo/app/odometry_input.h"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/odometry_file.h"

namespace tassilo {

OdometryInput::OdometryInput(const std::string& location, bool waits) : location_(location) {
  if (location.empty()) return;
  if (is_line_stream(location)) {
    waits_ = waits && location == "-";
    stream_.emplace(location);
    odometry_.emplace();
    return;
  }
  const std::vector<OdometrySample> samples = read_odometry(location);
  odometry_.emplace(std::max<std::size_t>(2, samples.size()));
  for (const OdometrySample& sample : samples) odometry_->add(sample);
}

void OdometryInput::update(double t, const std::function<bool()>& interrupted) {
  if (!stream_) return;
  constexpr std::chrono::milliseconds kPatience(100);
  const auto knows = [&] { return newest_ && *newest_ >= t; };
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
