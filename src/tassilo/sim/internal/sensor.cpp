#include "tassilo/sim/internal/sensor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

constexpr int kTones = 4096;
constexpr std::size_t kNoise = 1U << 13U;

/// sRGB's curve (IEC 61966-2-1), as cameras have about.
float tone(double light) {
  return static_cast<float>(light <= .0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - .055);
}

std::uint64_t mixed(std::uint64_t v) {  // splitmix64
  v += 0x9E3779B97F4A7C15U;
  v = (v ^ (v >> 30U)) * 0xBF58476D1CE4E5B9U;
  v = (v ^ (v >> 27U)) * 0x94D049BB133111EBU;
  return v ^ (v >> 31U);
}

std::uint8_t byte(float v) { return static_cast<std::uint8_t>(std::clamp(v + .5F, 0.F, 255.F)); }

}  // namespace

Sensor::Sensor(const CameraModel& camera, const RenderOptions& options) : width_(camera.width), height_(camera.height) {
  if (options.blur_px > .05) {
    const int reach = static_cast<int>(std::ceil(2.8 * options.blur_px));
    double sum = 0;
    for (int k = 0; k <= reach; ++k) {
      // What a pixel's width has of the bell.
      const double s = options.blur_px * std::numbers::sqrt2;
      const double weight = .5 * (std::erf((k + .5) / s) - std::erf((k - .5) / s));
      kernel_.push_back(static_cast<float>(weight));
      sum += k == 0 ? weight : 2 * weight;
    }
    for (float& weight : kernel_) weight = static_cast<float>(weight / sum);
    ring_.resize(kernel_.size() * 2 * static_cast<std::size_t>(width_));
    row_.resize(static_cast<std::size_t>(width_) + 2 * kernel_.size());
  }
  vignette_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  const double corner =
      std::pow(std::max(camera.cx, width_ - camera.cx), 2) + std::pow(std::max(camera.cy, height_ - camera.cy), 2);
  for (int r = 0; r < height_; ++r)
    for (int c = 0; c < width_; ++c)
      vignette_.push_back(static_cast<float>(
          1 - options.vignetting * (std::pow(c - camera.cx, 2) + std::pow(r - camera.cy, 2)) / corner));
  for (int k = 0; k <= kTones; ++k)
    tone_.push_back(options.flat ? static_cast<float>(k) / kTones : tone(static_cast<double>(k) / kTones));

  // Box and Muller's; the standard library's own distributions differ from one to the other.
  std::mt19937_64 engine(options.seed);
  const auto unit = [&] { return (static_cast<double>(engine() >> 11U) + .5) * 0x1p-53; };
  const auto normal = [&] {
    return static_cast<float>(std::sqrt(-2 * std::log(unit())) * std::cos(2 * std::numbers::pi * unit()));
  };
  for (std::size_t k = 0; k < kNoise; ++k) {
    const float r = normal(), g = normal(), b = normal();
    noise_.emplace_back(r, g, b, 0.F);
  }
  chroma_.resize(2 * static_cast<std::size_t>(width_ / 2 + 1));
}

/// Rows first, then columns of the last few rows.
void Sensor::blur(std::span<Light> light) {
  if (kernel_.empty()) return;
  const int reach = static_cast<int>(kernel_.size()) - 1;
  const auto width = static_cast<std::size_t>(width_);
  const std::size_t ring_rows = kernel_.size() * 2;
  const auto ring_row = [&](int r) { return ring_.data() + static_cast<std::size_t>(r) % ring_rows * width; };
  const auto along = [&](int r) {
    const Light* from = light.data() + static_cast<std::size_t>(r) * width;
    Light* padded = row_.data();
    std::fill(padded, padded + reach, from[0]);
    std::copy(from, from + width, padded + reach);
    std::fill(padded + reach + width_, padded + 2 * reach + width_, from[width - 1]);
    Light* to = ring_row(r);
    for (int c = 0; c < width_; ++c) {
      const Light* middle = padded + reach + c;
      Light sum = kernel_[0] * middle[0];
      for (int k = 1; k <= reach; ++k) sum += kernel_[static_cast<std::size_t>(k)] * (middle[k] + middle[-k]);
      to[c] = sum;
    }
  };
  for (int r = 0; r < std::min(reach, height_); ++r) along(r);
  for (int r = 0; r < height_; ++r) {
    if (r + reach < height_) along(r + reach);
    Light* to = light.data() + static_cast<std::size_t>(r) * width;
    const Light* middle = ring_row(r);
    for (int c = 0; c < width_; ++c) to[c] = kernel_[0] * middle[c];
    for (int k = 1; k <= reach; ++k) {
      const Light* above = ring_row(std::max(r - k, 0));
      const Light* below = ring_row(std::min(r + k, height_ - 1));
      const float weight = kernel_[static_cast<std::size_t>(k)];
      for (int c = 0; c < width_; ++c) to[c] += weight * (above[c] + below[c]);
    }
  }
}

void Sensor::develop(std::span<Light> light, std::uint64_t seed, const RenderOptions& options,
                     const FrameBuffer& into) {
  expects(light.size() == vignette_.size(), "Sensor::develop: the light is of all pixels");
  blur(light);
  const bool limited = options.range == ColorRange::limited, halved_rows = options.format == PixelFormat::yuv420p;
  const float y_scale = limited ? 219 : 255, y_low = limited ? 16 : 0, c_scale = limited ? 224 : 255;
  const auto exposure = static_cast<float>(options.exposure);
  const auto shot = static_cast<float>(options.shot_noise * options.shot_noise);
  const auto read = static_cast<float>(options.read_noise * options.read_noise);
  const bool noisy = shot > 0 || read > 0;
  const auto width = static_cast<std::size_t>(width_);
  const auto rows_of_chroma = [&](int r) { return halved_rows && r + 1 < height_ ? 2.F : 1.F; };
  for (int r = 0; r < height_; ++r) {
    const std::size_t first = static_cast<std::size_t>(r) * width;
    std::size_t at = mixed(seed + static_cast<std::uint64_t>(r));
    std::uint8_t* y = into.planes[0] + r * into.strides[0];
    if (!halved_rows || r % 2 == 0) std::fill(chroma_.begin(), chroma_.end(), 0.F);
    for (std::size_t c = 0; c < width; ++c) {
      Light v = exposure * vignette_[first + c] * light[first + c];
      if (noisy) {
        v += (read + shot * v.max(0.F)).sqrt() * noise_[at & (kNoise - 1)];
        ++at;
      }
      v = (v.max(0.F).min(1.F)) * static_cast<float>(kTones);
      const float red = tone_[static_cast<std::size_t>(v[0])], green = tone_[static_cast<std::size_t>(v[1])],
                  blue = tone_[static_cast<std::size_t>(v[2])];
      const float luma = .299F * red + .587F * green + .114F * blue;
      y[c] = byte(y_low + y_scale * luma);
      float* chroma = chroma_.data() + (c & ~std::size_t{1});
      chroma[0] += blue - luma;
      chroma[1] += red - luma;
    }
    if (halved_rows && r % 2 == 0 && r + 1 < height_) continue;
    const int chroma_row = halved_rows ? r / 2 : r;
    std::uint8_t* u = into.planes[1] + chroma_row * into.strides[1];
    std::uint8_t* v = into.planes[2] + chroma_row * into.strides[2];
    const float rows = rows_of_chroma(r - r % 2);
    for (std::size_t c = 0; c < width; c += 2) {
      const float count = rows * (c + 1 < width ? 2.F : 1.F);
      u[c / 2] = byte(128 + c_scale / (1.772F * count) * chroma_[c]);
      v[c / 2] = byte(128 + c_scale / (1.402F * count) * chroma_[c + 1]);
    }
  }
}

}  // namespace tassilo
