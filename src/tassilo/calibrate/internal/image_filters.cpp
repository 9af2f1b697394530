#include "tassilo/calibrate/internal/image_filters.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tassilo {
namespace {

std::size_t place(int width, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
}

std::vector<float> gaussian(double sigma) {
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  std::vector<float> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) sum += std::exp(-.5 * i * i / (sigma * sigma));
  for (int i = -reach; i <= reach; ++i)
    weights.push_back(static_cast<float>(std::exp(-.5 * i * i / (sigma * sigma)) / sum));
  return weights;
}

/// For each i the best of values[i - radius .. i + radius] by `better`, by a queue of falling candidates. O(n).
/// source   D. Lemire, "Streaming maximum-minimum filter using no more than three comparisons per element", 2006.
template <class Better>
std::vector<float> best_around(const std::vector<float>& values, int radius, Better better) {
  const int n = static_cast<int>(values.size());
  const auto value = [&](int i) { return values[static_cast<std::size_t>(i)]; };
  std::vector<float> best(values.size());
  std::vector<int> queue(values.size());
  std::size_t first = 0, end = 0;
  for (int i = 0; i < n + radius; ++i) {
    if (i < n) {
      while (end > first && !better(value(queue[end - 1]), value(i))) --end;
      queue[end++] = i;
    }
    const int middle = i - radius;
    if (middle < 0) continue;
    while (queue[first] < middle - radius) ++first;
    best[static_cast<std::size_t>(middle)] = value(queue[first]);
  }
  return best;
}

template <class Better>
GrayPlane best_in_square(const GrayPlane& image, int radius, Better better) {
  GrayPlane out = image;
  std::vector<float> line;
  for (int r = 0; r < image.height; ++r) {
    const auto begin = out.values.begin() + static_cast<std::ptrdiff_t>(place(image.width, 0, r));
    line.assign(begin, begin + image.width);
    std::ranges::copy(best_around(line, radius, better), begin);
  }
  for (int c = 0; c < image.width; ++c) {
    line.clear();
    for (int r = 0; r < image.height; ++r) line.push_back(out.values[place(image.width, c, r)]);
    line = best_around(line, radius, better);
    for (int r = 0; r < image.height; ++r) out.values[place(image.width, c, r)] = line[static_cast<std::size_t>(r)];
  }
  return out;
}

}  // namespace

float GrayPlane::at(int column, int row) const {
  return values[place(width, std::clamp(column, 0, width - 1), std::clamp(row, 0, height - 1))];
}

double GrayPlane::sample(double column, double row) const {
  column = std::clamp(column, 0., static_cast<double>(width - 1));
  row = std::clamp(row, 0., static_cast<double>(height - 1));
  const int c = static_cast<int>(column), r = static_cast<int>(row);
  const double right = column - c, below = row - r;
  return (1 - below) * ((1 - right) * at(c, r) + right * at(c + 1, r)) +
         below * ((1 - right) * at(c, r + 1) + right * at(c + 1, r + 1));
}

GrayPlane blurred(ByteView image, double sigma) {
  GrayPlane plane{image.width, image.height, {}};
  plane.values.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (int r = 0; r < image.height; ++r)
    for (const std::uint8_t y : image.row(r)) plane.values.push_back(y);
  if (!(sigma > 0)) return plane;
  const std::vector<float> weights = gaussian(sigma);
  const int reach = static_cast<int>(weights.size() / 2);
  GrayPlane out = plane;
  const auto filter = [&](const GrayPlane& from, GrayPlane& to, int step_c, int step_r) {
    for (int r = 0; r < from.height; ++r)
      for (int c = 0; c < from.width; ++c) {
        float sum = 0;
        for (int i = -reach; i <= reach; ++i)
          sum += weights[static_cast<std::size_t>(i + reach)] * from.at(c + i * step_c, r + i * step_r);
        to.values[place(from.width, c, r)] = sum;
      }
  };
  filter(plane, out, 1, 0);
  filter(out, plane, 0, 1);
  return plane;
}

std::vector<std::uint8_t> locally_dark(ByteView image, int radius, double contrast) {
  const GrayPlane smooth = blurred(image, .6);
  const GrayPlane low = best_in_square(smooth, radius, [](float a, float b) { return a < b; });
  const GrayPlane high = best_in_square(smooth, radius, [](float a, float b) { return a > b; });
  std::vector<std::uint8_t> dark(smooth.values.size(), 0);
  for (std::size_t i = 0; i < dark.size(); ++i)
    if (high.values[i] - low.values[i] >= contrast && 2 * smooth.values[i] < high.values[i] + low.values[i])
      dark[i] = 255;
  return dark;
}

}  // namespace tassilo
