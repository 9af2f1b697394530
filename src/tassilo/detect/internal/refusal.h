#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "tassilo/base/recycled_string.h"
#include "tassilo/region/features.h"

namespace tassilo {

/// What a region turned out to be, or in plain words why it is none: "is too small for ...".
template <class Object>
struct Verdict {
  Verdict(Object seen) : object(std::move(seen)) {}
  Verdict(std::string_view reason) : refusal(reason) {}

  std::optional<Object> object;
  std::string_view refusal;  ///< Lives as long as the program.
};

/// "no red region of 4 px or more"
inline RecycledString nothing_seen(std::string_view color, int min_area_px) {
  return RecycledString("no ").append(color).append(" region of ").append(std::to_string(min_area_px)) + " px or more";
}

/// "the largest red region, 812 px at (412, 203), is too small for ..."
inline RecycledString largest_refused(std::string_view color, const Region& region, std::string_view refusal) {
  const PixelBox box = bounding_box(region);
  RecycledString text("the largest ");
  text.append(color).append(" region, ").append(std::to_string(area(region))).append(" px at (");
  text.append(std::to_string((box.x0 + box.x1) / 2)).append(", ").append(std::to_string((box.y0 + box.y1) / 2));
  return text.append("), ").append(refusal);
}

}  // namespace tassilo
