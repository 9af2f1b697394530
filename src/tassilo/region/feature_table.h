#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "tassilo/base/recycled.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/features.h"
#include "tassilo/region/feret.h"
#include "tassilo/region/region.h"
#include "tassilo/region/roundness.h"

namespace tassilo {

/// Every feature of one region that is one number. To add one: 1. its name here, 2. its row in the table of
/// feature_table.cpp, in the same order, 3. its row in docs/regions.md.
enum class Feature : std::uint8_t {
  area,
  row,
  column,
  row1,
  column1,
  row2,
  column2,
  width,
  height,
  ra,
  rb,
  phi,
  orientation,
  anisometry,
  bulkiness,
  structure_factor,
  circularity,
  compactness,
  convexity,
  rectangularity,
  roundness,
  dist_mean,
  dist_deviation,
  num_sides,
  contour_length,
  connect_num,
  holes_num,
  area_holes,
  euler_number,
  max_diameter,
  min_feret,
  outer_radius,
  inner_radius,
  inner_width,
  inner_height,
  rect2_len1,
  rect2_len2,
  rect2_phi,
  moments_m20,
  moments_m11,
  moments_m02,
};

/// What the table says of a feature.
struct FeatureInfo {
  Feature feature;
  std::string_view name;     ///< As in HALCON `region_features` where that has it.
  std::string_view unit;     ///< "px", "px^2", "rad" or "" for a pure number.
  std::string_view meaning;  ///< One line.
};
/// All, in the order of Feature.
std::span<const FeatureInfo> all_features();
/// The feature of that name; nothing when there is none.
std::optional<Feature> feature_named(std::string_view name);
std::string_view to_string(Feature feature);

/// Measures features of one region, each when it is asked for; what several have in common is computed once. Borrows
/// the region; for one thread.
class FeatureMeter {
 public:
  explicit FeatureMeter(const Region& region) : region_(region) {}
  explicit FeatureMeter(Region&&) = delete;  ///< Would outlive the region.

  double operator()(Feature feature);

  const Region& region() const { return region_; }
  const ShapeFeatures& shape();
  const RotatedRectangle& rectangle();
  const FeretDiameters& feret();
  const PixelBox& inner_box();
  const Roundness& round();

 private:
  const Region& region_;
  std::optional<ShapeFeatures> shape_;
  std::optional<RotatedRectangle> rectangle_;
  std::optional<FeretDiameters> feret_;
  std::optional<PixelBox> inner_box_;
  std::optional<Roundness> round_;
};

/// One number of one region; 0 for the empty region. Costs what the feature costs: most O(R), the inner ones O(pixels
/// of the bounding box). HALCON `region_features`. Pure, safe from any thread.
double feature_value(const Region& region, Feature feature);
/// Several, in the order asked for.
RecycledVector<double> feature_values(const Region& region, std::span<const Feature> features);

}  // namespace tassilo
