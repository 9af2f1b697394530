#include "tassilo/region/components.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace tassilo {
namespace {

/// Sets of provisional labels; the smallest label of a set is its root, so that roots keep the order of first runs.
class LabelSets {
 public:
  explicit LabelSets(std::size_t capacity) { parent_.reserve(capacity); }

  int add() {
    parent_.push_back(static_cast<int>(parent_.size()));
    return parent_.back();
  }
  int root(int label) {
    while (parent(label) != label) {
      parent(label) = parent(parent(label));
      label = parent(label);
    }
    return label;
  }
  int join(int a, int b) {
    a = root(a);
    b = root(b);
    parent(std::max(a, b)) = std::min(a, b);
    return std::min(a, b);
  }
  /// Numbers the sets 0, 1, ... by their smallest label; ends the use of all else. Returns the final number by label.
  RecycledVector<int> numbered(int& count) && {
    count = 0;
    // Parents are never larger than their children, so a parent's final number is known before it is needed.
    for (std::size_t label = 0; label < parent_.size(); ++label)
      parent_[label] = parent_[label] == static_cast<int>(label) ? count++ : parent(parent_[label]);
    return std::move(parent_);
  }

 private:
  int& parent(int label) { return parent_[static_cast<std::size_t>(label)]; }

  RecycledVector<int> parent_;
};

}  // namespace

RunLabels label_runs(const Region& region, Connectivity connectivity) {
  const auto runs = region.runs();
  const int reach = connectivity == Connectivity::eight ? 1 : 0;
  RunLabels labels;
  labels.label.resize(runs.size());
  LabelSets sets(runs.size());
  std::size_t above = 0;  // first run that may still touch the current one from the row above
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const PixelRun& run = runs[i];
    while (runs[above].row < run.row - 1 || (runs[above].row == run.row - 1 && runs[above].end + reach <= run.begin))
      ++above;
    int label = -1;
    std::size_t touching = above;
    for (; runs[touching].row == run.row - 1 && runs[touching].begin < run.end + reach; ++touching)
      label = label < 0 ? labels.label[touching] : sets.join(label, labels.label[touching]);
    labels.label[i] = label < 0 ? sets.add() : label;
    // The last one may reach on to the next run of this row.
    if (touching > above) above = touching - 1;
  }
  const RecycledVector<int> number = std::move(sets).numbered(labels.count);
  for (int& label : labels.label) label = number[static_cast<std::size_t>(label)];
  return labels;
}

RecycledVector<Region> components(const Region& region, Connectivity connectivity) {
  const RunLabels labels = label_runs(region, connectivity);
  const auto runs = region.runs();
  RecycledVector<std::size_t> sizes(static_cast<std::size_t>(labels.count), 0);
  for (const int label : labels.label) ++sizes[static_cast<std::size_t>(label)];
  RecycledVector<RunVector> parts(sizes.size());
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].reserve(sizes[k]);
  for (std::size_t i = 0; i < runs.size(); ++i) parts[static_cast<std::size_t>(labels.label[i])].push_back(runs[i]);
  RecycledVector<Region> result;
  result.reserve(parts.size());
  for (RunVector& part : parts) result.push_back(Region::from_sorted(std::move(part)));
  return result;
}

}  // namespace tassilo
