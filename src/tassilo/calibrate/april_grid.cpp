#include "tassilo/calibrate/april_grid.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/calibrate/internal/plane_map.h"
#include "tassilo/calibrate/internal/saddle_fit.h"

namespace tassilo {
namespace {

constexpr int kMostSide = 16000;           ///< libapriltag keeps doubled coordinates in 16 bits. [px]
constexpr int kBorder = 2;                 ///< Black cells around the code; libapriltag's own family has one.
constexpr int kCorrected = 1;              ///< Wrong cells, of 11 by which codes differ: seven more are another tag.
constexpr double kExpected = .35;          ///< How far a neighbor may be from where a tag lets expect it. [tag size]
constexpr std::size_t kLeastCorners = 12;  ///< Like kLeastPoints of a calibration.

struct FreeFamily {
  void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};
struct FreeDetector {
  void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
};
struct FreeDetections {
  void operator()(zarray_t* detections) const { apriltag_detections_destroy(detections); }
};

using Family = std::unique_ptr<apriltag_family_t, FreeFamily>;

/// The family with a border as wide as Kalibr prints it.
Family wide_family() {
  Family family(tag36h11_create());
  if (!family) throw Error("libapriltag", "has no tag36h11");
  const int wider = kBorder - 1;
  family->width_at_border += 2 * wider;
  family->total_width += 2 * wider;
  for (std::uint32_t i = 0; i < family->nbits; ++i) {
    family->bit_x[i] += wider;
    family->bit_y[i] += wider;
  }
  return family;
}

/// A tag in the image, corners as seen upright: top left, top right, bottom right, bottom left. [px]
struct Tag {
  int id = 0, column = 0, row = 0;  ///< Place in the grid, rows from the top; set for ids within it.
  std::array<PixelPoint, 4> corners;
};

/// The brightest of each pixel and its neighbors: cuts the tags from the black squares that touch their corners, which
/// would make one blob of the whole grid. Edges move into the black by a pixel.
std::vector<std::uint8_t> white_widened(ByteView image) {
  std::vector<std::uint8_t> out;
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c) {
      std::uint8_t most = 0;
      for (int y = std::max(0, r - 1); y <= std::min(image.height - 1, r + 1); ++y)
        for (int x = std::max(0, c - 1); x <= std::min(image.width - 1, c + 1); ++x)
          most = std::max(most, image.row(y)[static_cast<std::size_t>(x)]);
      out.push_back(most);
    }
  return out;
}

std::vector<Tag> find_tags(ByteView image) {
  const Family family = wide_family();
  const std::unique_ptr<apriltag_detector_t, FreeDetector> detector(apriltag_detector_create());
  apriltag_detector_add_family_bits(detector.get(), family.get(), kCorrected);
  detector->nthreads = 1;
  detector->quad_decimate = 1;
  std::vector<std::uint8_t> pixels = white_widened(image);
  image_u8_t copy{image.width, image.height, image.width, pixels.data()};
  const std::unique_ptr<zarray_t, FreeDetections> found(apriltag_detector_detect(detector.get(), &copy));
  std::vector<Tag> tags;
  for (int i = 0; i < zarray_size(found.get()); ++i) {
    apriltag_detection_t* one = nullptr;
    zarray_get(found.get(), i, &one);
    Tag tag{.id = one->id, .corners = {}};
    // Its corners begin at the bottom left and go on to the right; its pixels' centres are at (.5, .5).
    for (const std::size_t k : {0U, 1U, 2U, 3U}) tag.corners[3 - k] = {one->p[k][0] - .5, one->p[k][1] - .5};
    // Back out by the pixel that white was widened by.
    const auto shrunk = tag.corners;
    for (const std::size_t k : {0U, 1U, 2U, 3U})
      for (const std::size_t other : {(k + 1) % 4, (k + 3) % 4}) {
        const PixelPoint edge = shrunk[k] - shrunk[other];
        if (norm(edge) > 0) tag.corners[k] = tag.corners[k] + 1 / norm(edge) * edge;
      }
    tags.push_back(tag);
  }
  std::ranges::stable_sort(tags, std::ranges::less{}, &Tag::id);
  return tags;
}

/// Throws out what is no part of the grid by its id; sets the places of the others.
std::vector<Tag> tags_of(const Target& target, const std::vector<Tag>& tags, std::vector<std::string>& remarks) {
  const int columns = target.columns / 2, rows = target.rows / 2;
  std::vector<Tag> out;
  for (const Tag& tag : tags) {
    const std::string name = "tag " + std::to_string(tag.id);
    if (tag.id >= columns * rows) {
      remarks.push_back(name + " is not used: ids of the grid end at " + std::to_string(columns * rows - 1));
      continue;
    }
    const auto seen = std::ranges::count(tags, tag.id, &Tag::id);
    if (seen > 1) {
      if (out.empty() || remarks.empty() || remarks.back().find(name + " ") != 0)
        remarks.push_back(name + " is not used: it is seen " + std::to_string(seen) + " times");
      continue;
    }
    out.push_back(tag);
    out.back().column = tag.id % columns;
    out.back().row = rows - 1 - tag.id / columns;
  }
  return out;
}

/// Whether `other`, a neighbor on the grid, is where the corners of `tag` let expect it.
bool agrees(const Target& target, const Tag& tag, const Tag& other) {
  const std::array<Eigen::Vector2d, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  std::array<Eigen::Vector2d, 4> seen;
  for (const std::size_t k : {0U, 1U, 2U, 3U}) seen[k] = {tag.corners[k].x, tag.corners[k].y};
  const auto map = plane_map(square, seen);
  if (!map) return false;
  const double step = 1 + target.spacing;
  const double x = .5 + step * (other.column - tag.column), y = .5 + step * (other.row - tag.row);
  const Eigen::Vector3d at = *map * Eigen::Vector3d(x, y, 1), middle = *map * Eigen::Vector3d(.5, .5, 1);
  if (!(at.z() * middle.z() > 0)) return false;
  PixelPoint center{};
  double size = 0;
  for (const std::size_t k : {0U, 1U, 2U, 3U}) {
    center = center + .25 * other.corners[k];
    size += .25 * norm(other.corners[(k + 1) % 4] - other.corners[k]);
  }
  return norm(PixelPoint{at.x() / at.z(), at.y() / at.z()} - center) < kExpected * size;
}

/// Throws out what no neighbor confirms.
std::vector<Tag> confirmed(const Target& target, const std::vector<Tag>& tags, std::vector<std::string>& remarks) {
  std::vector<Tag> out;
  for (const Tag& tag : tags) {
    const bool is_confirmed = std::ranges::any_of(tags, [&](const Tag& other) {
      const int away = std::max(std::abs(other.column - tag.column), std::abs(other.row - tag.row));
      return away == 1 && agrees(target, tag, other) && agrees(target, other, tag);
    });
    if (is_confirmed)
      out.push_back(tag);
    else
      remarks.push_back("tag " + std::to_string(tag.id) + " is not used: no neighbor is where it lets expect one");
  }
  return out;
}

/// A tag's corner placed between the pixels. What else is near: the end of the black square, and of the border.
std::optional<PixelPoint> placed(ByteView image, const Target& target, const Tag& tag, std::size_t corner) {
  const double clear = std::min(target.spacing, static_cast<double>(kBorder) / kTagCells);
  const bool is_left = corner == 0 || corner == 3, is_top = corner < 2;
  const PixelPoint along = is_top ? tag.corners[1] - tag.corners[0] : tag.corners[2] - tag.corners[3];
  const PixelPoint down = is_left ? tag.corners[3] - tag.corners[0] : tag.corners[2] - tag.corners[1];
  return fitted_corner(image, {.at = tag.corners[corner], .along = clear * along, .down = clear * down});
}

}  // namespace

std::vector<bool> tag_cells(int id) {
  expects(id >= 0 && id < kTagCount, "tag_cells: an id of the family");
  const Family family = wide_family();
  std::vector<bool> black(std::size_t{kTagCells} * kTagCells, true);
  for (std::uint32_t i = 0; i < family->nbits; ++i)
    if (family->codes[id] >> (family->nbits - 1 - i) & 1)
      black[std::size_t{family->bit_y[i]} * kTagCells + family->bit_x[i]] = false;
  return black;
}

TargetSearch find_april_grid(ByteView image, const Target& target) {
  expects(target.kind == TargetKind::april_grid, "find_april_grid: an AprilGrid");
  target.check();
  TargetSearch out{{}, "the image is too small", {}};
  if (image.width < 16 || image.height < 16) return out;
  if (image.width > kMostSide || image.height > kMostSide) {
    out.reason = "the image is larger than " + std::to_string(kMostSide) + " px";
    return out;
  }
  const std::vector<Tag> tags = confirmed(target, tags_of(target, find_tags(image), out.remarks), out.remarks);
  TargetView view{target, {}};
  for (Tag tag : tags) {
    std::array<bool, 4> is_placed{};
    // The second time with the directions as the first has found them.
    for (int round = 0; round < 2; ++round) {
      const Tag before = tag;
      for (const std::size_t k : {0U, 1U, 2U, 3U}) {
        const auto at = placed(image, target, before, k);
        is_placed[k] = at.has_value();
        if (at) tag.corners[k] = *at;
      }
    }
    for (const std::size_t k : {0U, 1U, 2U, 3U})
      if (is_placed[k])
        view.points.push_back({2 * tag.column + (k == 1 || k == 2), 2 * tag.row + (k >= 2), tag.corners[k]});
  }
  if (view.points.size() < kLeastCorners) {
    out.reason = std::to_string(tags.size()) + " tags with " + std::to_string(view.points.size()) +
                 " corners that can be placed, must be at least " + std::to_string(kLeastCorners) + " corners";
    return out;
  }
  std::ranges::sort(view.points, [](const SeenPoint& a, const SeenPoint& b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  });
  out.view = std::move(view);
  out.reason.clear();
  return out;
}

}  // namespace tassilo
