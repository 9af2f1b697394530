#include "tassilo/message/camera_info.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

constexpr std::string_view kCompressed = "/compressed";

std::string_view last_of(std::string_view topic) { return topic.substr(topic.rfind('/') + 1); }
std::string_view raw_topic_of(std::string_view topic) {
  return topic.ends_with(kCompressed) ? topic.substr(0, topic.size() - kCompressed.size()) : topic;
}

/// The first n of D; missing ones are 0, further ones must be.
template <std::size_t n>
std::array<double, n> coefficients(const ros::CameraInfo& info) {
  std::array<double, n> values{};
  for (std::size_t i = 0; i < info.d.size(); ++i) {
    if (i < n)
      values[i] = info.d[i];
    else if (info.d[i] != 0)
      throw Error("camera info", "has " + std::to_string(info.d.size()) +
                                     " coefficients of distortion, must have at most " + std::to_string(n) +
                                     " that are not 0 for " + info.distortion_model);
  }
  return values;
}

Distortion distortion_from(const ros::CameraInfo& info) {
  if (info.distortion_model == "plumb_bob" || (info.distortion_model.empty() && info.d.empty())) {
    const auto d = coefficients<5>(info);
    return PlumbBob{d[0], d[1], d[2], d[3], d[4]};
  }
  if (info.distortion_model == "rational_polynomial") {
    const auto d = coefficients<8>(info);
    return RationalPolynomial{d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7]};
  }
  if (info.distortion_model == "equidistant") {
    const auto d = coefficients<4>(info);
    return Equidistant{d[0], d[1], d[2], d[3]};
  }
  std::string name = info.distortion_model.substr(0, 40);
  for (char& c : name) c = c > ' ' && c <= '~' ? c : '?';
  throw Error("camera info",
              "has distortion model \"" + name + "\", must be plumb_bob, rational_polynomial or equidistant");
}

bool all_zero(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return value == 0; });
}

struct Side {
  std::uint32_t begin = 0, size = 0;  ///< Of the whole image. [px]
  std::uint32_t binning = 1;
  int sent() const { return static_cast<int>(size / binning); }
};

Side side_of(std::uint32_t whole, std::uint32_t begin, std::uint32_t size, std::uint32_t binning) {
  constexpr std::uint32_t most = 32767;
  Side side{begin, size == 0 ? whole : size, std::max(1U, binning)};
  if (whole < 1 || whole > most || side.size > whole || begin > whole - side.size || side.sent() < 1)
    throw Error("camera info", "has a size, a region of interest or a binning that do not belong together");
  return side;
}

}  // namespace

std::string camera_info_topic_of(std::string_view image_topic) {
  const std::string_view raw = raw_topic_of(image_topic);
  return std::string(raw.substr(0, raw.rfind('/') + 1)).append("camera_info");
}

bool is_rectified_topic(std::string_view image_topic) {
  return last_of(raw_topic_of(image_topic)).starts_with("image_rect");
}

ToldLens lens_from(const ros::CameraInfo& info, bool is_rectified) {
  // A region of interest of size 0 is the whole image; its offset counts all the same.
  const Side columns = side_of(info.width, info.roi.x_offset, info.roi.width, info.binning_x);
  const Side rows = side_of(info.height, info.roi.y_offset, info.roi.height, info.binning_y);
  ToldLens lens{columns.sent(), rows.sent(), std::nullopt};
  const std::span<const double> matrix = is_rectified ? std::span<const double>(info.p) : info.k;
  if (all_zero(matrix)) return lens;
  const std::size_t width = is_rectified ? 4 : 3;  // of the matrix
  CameraModel model;
  model.name = "camera info";
  model.width = lens.width;
  model.height = lens.height;
  model.fx = matrix[0] / columns.binning;
  model.cx = (matrix[2] - columns.begin) / columns.binning;
  model.fy = matrix[width + 1] / rows.binning;
  model.cy = (matrix[width + 2] - rows.begin) / rows.binning;
  if (!is_rectified) model.distortion = distortion_from(info);
  const bool is_finite = std::ranges::all_of(matrix, [](double value) { return std::isfinite(value); }) &&
                         std::ranges::all_of(info.d, [](double value) { return std::isfinite(value); });
  if (!is_finite || !(model.fx > 0) || !(model.fy > 0) || matrix[1] != 0)
    throw Error("camera info", "has a matrix or coefficients that describe no camera");
  lens.model = model;
  return lens;
}

LensDifference difference(const CameraModel& first, const CameraModel& second) {
  constexpr int columns = 17, rows = 13;
  LensDifference most;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const PixelPoint at{(first.width - 1.) * c / (columns - 1), (first.height - 1.) * r / (rows - 1)};
      const auto ray = unproject(first, at);
      if (!ray) continue;  // nothing shows there
      const auto shown = project(second, *ray);
      double px = std::numeric_limits<double>::infinity();
      if (shown) px = std::hypot(shown->x - at.x, shown->y - at.y);
      if (std::isnan(px)) px = std::numeric_limits<double>::infinity();
      if (px > most.px) most = {px, at};
    }
  return most;
}

}  // namespace tassilo
