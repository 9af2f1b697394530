#include "tassilo/color/internal/run_sinks.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

namespace tassilo {
namespace {

/// What a kernel may write beyond the entries it reports.
constexpr std::size_t kSlack = 128;

/// Most runs of one class in a row, as two of them have a pixel between, and room for two bytes written too many.
std::size_t most_runs(int width) { return static_cast<std::size_t>(width) / 2 + 2; }

/// Runs are written as one word of 64 bits; the two bytes too many belong to the next run.
void write(PixelRun* to, int row, std::uint16_t begin, std::uint16_t end) {
  static_assert(sizeof(PixelRun) == 6 && std::endian::native == std::endian::little);
  const std::uint64_t word = static_cast<std::uint16_t>(row) | std::uint64_t{begin} << 16 | std::uint64_t{end} << 32;
  std::memcpy(static_cast<void*>(to), &word, sizeof word);
}

}  // namespace

RunSinks::RunSinks(const Segmentation& segmentation)
    : width_(segmentation.width),
      begin_(static_cast<std::size_t>(width_) + kSlack),
      end_(static_cast<std::size_t>(width_) + kSlack),
      label_(static_cast<std::size_t>(width_) + kSlack) {
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    const std::size_t expected = segmentation.regions[k].runs().size();
    runs_[k] = RecycledBuffer<PixelRun>(expected + expected / 4 + 2 * most_runs(width_));
    end_of_[k] = runs_[k].data();
    limit_of_[k] = runs_[k].data() + runs_[k].size() - most_runs(width_);
  }
}

void RunSinks::make_room(std::size_t k) {
  const auto used = static_cast<std::size_t>(end_of_[k] - runs_[k].data());
  RecycledBuffer<PixelRun> larger(2 * runs_[k].size());
  std::copy_n(runs_[k].data(), used, larger.data());
  runs_[k] = std::move(larger);
  end_of_[k] = runs_[k].data() + used;
  limit_of_[k] = runs_[k].data() + runs_[k].size() - most_runs(width_);
}

void RunSinks::add_row(int r, int count) {
  for (std::size_t k = 0; k < runs_.size(); ++k)
    if (end_of_[k] > limit_of_[k]) make_room(k);
  const RowRuns runs = row_runs();
  for (int i = 0; i < count; ++i) {
    PixelRun*& end = end_of_[runs.label[i] - 1u];
    PixelRun* const to = end++;
    write(to, r, runs.begin[i], runs.end[i]);
  }
}

void RunSinks::finish(Segmentation& segmentation) && {
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    RunVector runs = segmentation.regions[k].take_runs();
    runs.assign(runs_[k].data(), end_of_[k]);
    segmentation.regions[k] = Region::from_sorted(std::move(runs));
  }
}

}  // namespace tassilo
