#include "tassilo/app/boundary_steps.h"

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

/// A straight segment on the floor, curved as the lens shows it.
Contour in_image(const BoundarySegment& segment, const MountedCamera& camera) {
  constexpr int pieces = 16;
  Contour contour;
  for (int k = 0; k <= pieces; ++k) {
    const FloorPoint at = segment.p + static_cast<double>(k) / pieces * (segment.q - segment.p);
    if (const auto pixel = camera.project({at.x, at.y, 0})) contour.points.push_back(*pixel);
  }
  return contour;
}

}  // namespace

StepPicture boundary_step(const Boundary& boundary, std::size_t step, const MountedCamera& camera) {
  expects(step < kBoundarySteps.size(), "boundary_step: a step that there is");
  StepPicture picture;
  picture.title = kBoundarySteps[step];
  const auto add_pieces = [&](const RecycledVector<BoundaryPiece>& pieces) {
    for (const BoundaryPiece& piece : pieces) picture.contours.push_back({.points = {piece.image_p, piece.image_q}});
  };
  switch (step) {
    case 0:
      picture.region = boundary.region;
      break;
    case 1:
      picture.contours.assign(boundary.contours.begin(), boundary.contours.end());
      break;
    case 2:
      add_pieces(boundary.pieces);
      break;
    case 3:
      add_pieces(boundary.lines);
      break;
    default:
      for (const BoundarySegment& segment : boundary.segments) {
        Contour contour = in_image(segment, camera);
        if (!contour.points.empty()) picture.contours.push_back(std::move(contour));
      }
  }
  return picture;
}

}  // namespace tassilo
