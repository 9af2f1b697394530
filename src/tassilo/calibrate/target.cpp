#include "tassilo/calibrate/target.h"

#include <charconv>
#include <cmath>

#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"

namespace tassilo {
namespace {

/// The fields between colons; at least one.
std::vector<std::string_view> fields_of(std::string_view text) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t colon = text.find(':');
    fields.push_back(text.substr(0, colon));
    if (colon == std::string_view::npos) return fields;
    text.remove_prefix(colon + 1);
  }
}

template <class Number>
std::optional<Number> number_from(std::string_view text) {
  Number value{};
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string shortest(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

void check_count(const char* option, int count) {
  if (count < 3 || count > 64) throw Error(option, "is " + std::to_string(count) + ", must be within 3 and 64");
}

}  // namespace

std::string_view to_string(TargetKind kind) { return kind == TargetKind::dots ? "dots" : "checker"; }

void Target::check() const {
  check_count("target.columns", columns);
  check_count("target.rows", rows);
  check_finite("target.pitch", pitch);
  check_above("target.pitch", pitch, 0);
  if (constexpr double most = 1; pitch > most)
    throw Error("target.pitch", "is " + shortest(pitch) + " m, must be at most 1; lengths are in metres");
  if (kind == TargetKind::checkerboard) {
    if ((columns + rows) % 2 == 0)
      throw Error("target", "is a checkerboard of " + std::to_string(columns) + " x " + std::to_string(rows) +
                                " inner corners, which looks the same when turned around, must have one side of even "
                                "and one of odd length");
    if (radius != 0) throw Error("target.radius", "is " + shortest(radius) + ", must be 0 for a checkerboard");
  } else if (!(radius > 0 && radius < pitch / 2)) {
    throw Error("target.radius",
                "is " + shortest(radius) + ", must be > 0 and < half the pitch, " + shortest(pitch / 2));
  }
}

Target target_from_text(std::string_view text) {
  const auto refuse = [&](const std::string& reason) { throw Error("target " + std::string(text), reason); };
  const auto fields = fields_of(text);
  Target target;
  if (fields[0] == "dots") {
    target.kind = TargetKind::dots;
  } else if (fields[0] == "checker") {
    target.kind = TargetKind::checkerboard;
    target.radius = 0;
  } else {
    refuse("is of kind '" + std::string(fields[0]) + "', must be dots or checker");
  }
  const bool dots = target.kind == TargetKind::dots;
  const std::string form = dots ? "dots:COLUMNSxROWS:PITCH:RADIUS" : "checker:COLUMNSxROWS:PITCH";
  if (fields.size() != (dots ? 4U : 3U)) refuse("must be " + form);
  const std::size_t cross = fields[1].find('x');
  const auto columns = number_from<int>(fields[1].substr(0, cross));
  const auto rows = cross == std::string_view::npos ? std::nullopt : number_from<int>(fields[1].substr(cross + 1));
  const auto pitch = number_from<double>(fields[2]);
  const auto radius = dots ? number_from<double>(fields[3]) : std::optional(0.);
  if (!columns || !rows || !pitch || !radius) refuse("must be " + form + ", with lengths in metres");
  target.columns = *columns;
  target.rows = *rows;
  target.pitch = *pitch;
  target.radius = *radius;
  target.check();
  return target;
}

std::string to_text(const Target& target) {
  std::string text(to_string(target.kind));
  text.append(":").append(std::to_string(target.columns)).append("x").append(std::to_string(target.rows));
  text.append(":").append(shortest(target.pitch));
  if (target.kind == TargetKind::dots) text.append(":").append(shortest(target.radius));
  return text;
}

}  // namespace tassilo
