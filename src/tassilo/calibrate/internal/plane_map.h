#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace tassilo {

/// The projective map from one plane to another that fits pairs of points best (DLT with normalized coordinates), of
/// norm 1 up to sign; nothing with fewer than 4 pairs or where they are degenerate.
/// source   R. Hartley, "In defense of the eight-point algorithm", IEEE PAMI 19(6), 1997. O(n).
std::optional<Eigen::Matrix3d> plane_map(std::span<const Eigen::Vector2d> from, std::span<const Eigen::Vector2d> to);

}  // namespace tassilo
