#include "tassilo/calibrate/target.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/calibrate/april_grid.h"

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

std::string_view to_string(TargetKind kind) {
  switch (kind) {
    case TargetKind::dots:
      return "dots";
    case TargetKind::checkerboard:
      return "checker";
    case TargetKind::april_grid:
      break;
  }
  return "aprilgrid";
}

TargetPoint Target::at(int column, int row) const {
  if (kind != TargetKind::april_grid) return {column * pitch, row * pitch};
  const auto place = [&](int index) { return pitch * (index / 2 * (1 + spacing) + index % 2); };
  return {place(column), place(row)};
}

void Target::check() const {
  check_count("target.columns", columns);
  check_count("target.rows", rows);
  check_finite("target.pitch", pitch);
  check_above("target.pitch", pitch, 0);
  if (constexpr double most = 1; pitch > most)
    throw Error("target.pitch", "is " + shortest(pitch) + " m, must be at most 1; lengths are in metres");
  if (kind != TargetKind::april_grid && spacing != 0)
    throw Error("target.spacing", "is " + shortest(spacing) + ", must be 0 but for an AprilGrid");
  if (kind == TargetKind::checkerboard) {
    if ((columns + rows) % 2 == 0)
      throw Error("target", "is a checkerboard of " + std::to_string(columns) + " x " + std::to_string(rows) +
                                " inner corners, which looks the same when turned around, must have one side of even "
                                "and one of odd length");
    if (radius != 0) throw Error("target.radius", "is " + shortest(radius) + ", must be 0 for a checkerboard");
  } else if (kind == TargetKind::april_grid) {
    if (columns % 2 != 0 || rows % 2 != 0)
      throw Error("target", "is an AprilGrid of " + std::to_string(columns) + " x " + std::to_string(rows) +
                                " corners, must have an even number each way: two a tag");
    if (const int tags = columns / 2 * (rows / 2); tags > kTagCount)
      throw Error("target", "has " + std::to_string(tags) + " tags, must be at most " + std::to_string(kTagCount));
    if (radius != 0) throw Error("target.radius", "is " + shortest(radius) + ", must be 0 for an AprilGrid");
    if (!(spacing >= .1 && spacing <= 1))
      throw Error("target.spacing",
                  "is " + shortest(spacing) + ", must be within 0.1 and 1, a share of the tag's size");
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
  } else if (fields[0] == "aprilgrid") {
    target.kind = TargetKind::april_grid;
    target.radius = 0;
  } else {
    refuse("is of kind '" + std::string(fields[0]) + "', must be dots, checker or aprilgrid");
  }
  const bool checker = target.kind == TargetKind::checkerboard, tags = target.kind == TargetKind::april_grid;
  const std::string form = checker ? "checker:COLUMNSxROWS:PITCH"
                           : tags  ? "aprilgrid:TAGCOLSxTAGROWS:TAGSIZE:TAGSPACING"
                                   : "dots:COLUMNSxROWS:PITCH:RADIUS";
  if (fields.size() != (checker ? 3U : 4U)) refuse("must be " + form);
  const std::size_t cross = fields[1].find('x');
  const auto columns = number_from<int>(fields[1].substr(0, cross));
  const auto rows = cross == std::string_view::npos ? std::nullopt : number_from<int>(fields[1].substr(cross + 1));
  const auto pitch = number_from<double>(fields[2]);
  const auto last = checker ? std::optional(0.) : number_from<double>(fields[3]);
  if (!columns || !rows || !pitch || !last) refuse("must be " + form + ", with lengths in metres");
  constexpr int most = 1000;  // beyond, the range that is refused could not be told
  const int by = tags ? 2 : 1;
  target.columns = by * std::clamp(*columns, -most, most);
  target.rows = by * std::clamp(*rows, -most, most);
  target.pitch = *pitch;
  (tags ? target.spacing : target.radius) = *last;
  target.check();
  return target;
}

std::string to_text(const Target& target) {
  std::string text(to_string(target.kind));
  const int by = target.kind == TargetKind::april_grid ? 2 : 1;
  text.append(":").append(std::to_string(target.columns / by)).append("x").append(std::to_string(target.rows / by));
  text.append(":").append(shortest(target.pitch));
  if (target.kind == TargetKind::dots) text.append(":").append(shortest(target.radius));
  if (target.kind == TargetKind::april_grid) text.append(":").append(shortest(target.spacing));
  return text;
}

}  // namespace tassilo
