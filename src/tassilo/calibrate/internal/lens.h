#pragma once

#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "tassilo/calibrate/intrinsics.h"

namespace tassilo {

// The lens models of camera_model.cpp once more, for numbers that carry derivatives. A test compares both.
// Parameters of a camera: fx, fy, cx, cy, then the lens's coefficients in the order of camera files.

inline constexpr int kPinholeCount = 4;

/// Distorts a point in the optical frame to normalized coordinates; false where there is no image of it.
struct DivisionLens {
  static constexpr int kCoefficients = 1;
  template <class T>
  static bool distort(const T* k, const T* p, T* out) {
    using std::sqrt;
    const T root = p[2] * p[2] - 4. * k[0] * (p[0] * p[0] + p[1] * p[1]);
    if (!(p[2] > 0.) || !(root > 0.)) return false;
    const T scale = 2. / (p[2] + sqrt(root));
    out[0] = scale * p[0];
    out[1] = scale * p[1];
    return true;
  }
};

struct PlumbBobLens {
  static constexpr int kCoefficients = 5;
  template <class T>
  static bool distort(const T* k, const T* p, T* out) {
    if (!(p[2] > 0.)) return false;
    const T x = p[0] / p[2], y = p[1] / p[2], q = x * x + y * y;
    const T g = 1. + q * (k[0] + q * (k[1] + q * k[4]));
    out[0] = x * g + 2. * k[2] * x * y + k[3] * (q + 2. * x * x);
    out[1] = y * g + k[2] * (q + 2. * y * y) + 2. * k[3] * x * y;
    return true;
  }
};

struct EquidistantLens {
  static constexpr int kCoefficients = 4;
  template <class T>
  static bool distort(const T* k, const T* p, T* out) {
    using std::atan2;
    using std::sqrt;
    const T square = p[0] * p[0] + p[1] * p[1];
    if (!(square > 1e-24)) {  // on the axis, where the root has no derivative
      if (!(p[2] > 0.)) return false;
      out[0] = p[0] / p[2];
      out[1] = p[1] / p[2];
      return true;
    }
    const T across = sqrt(square), angle = atan2(across, p[2]), s = angle * angle;
    const T scale = angle * (1. + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3])))) / across;
    out[0] = scale * p[0];
    out[1] = scale * p[1];
    return true;
  }
};

/// Calls visit(Lens{}) with the lens of the model.
template <class Visit>
decltype(auto) with_lens(LensModel model, Visit visit) {
  switch (model) {
    case LensModel::plumb_bob:
      return visit(PlumbBobLens{});
    case LensModel::equidistant:
      return visit(EquidistantLens{});
    case LensModel::division:
      break;
  }
  return visit(DivisionLens{});
}

inline int parameter_count(LensModel model) {
  return kPinholeCount + with_lens(model, [](auto lens) { return decltype(lens)::kCoefficients; });
}

/// Names of all parameters, as EstimatedValue has them.
inline std::vector<std::string_view> parameter_names(LensModel model) {
  switch (model) {
    case LensModel::plumb_bob:
      return {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
    case LensModel::equidistant:
      return {"fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"};
    case LensModel::division:
      break;
  }
  return {"fx", "fy", "cx", "cy", "k"};
}

inline CameraModel camera_from(ImageSize size, LensModel model, std::span<const double> p) {
  CameraModel camera{
      .name = {}, .width = size.width, .height = size.height, .fx = p[0], .fy = p[1], .cx = p[2], .cy = p[3]};
  switch (model) {
    case LensModel::plumb_bob:
      camera.distortion = PlumbBob{p[4], p[5], p[6], p[7], p[8]};
      break;
    case LensModel::equidistant:
      camera.distortion = Equidistant{p[4], p[5], p[6], p[7]};
      break;
    case LensModel::division:
      camera.distortion = Division{p[4]};
  }
  return camera;
}

}  // namespace tassilo
