#include "tassilo/region/components.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

namespace tassilo {
namespace {

/// Sets of provisional labels; the smallest label of a set is its root, so that roots keep the order of first runs.
class LabelSets {
 public:
  explicit LabelSets(std::size_t most) : parent_(most) {}

  int add() {
    parent_[static_cast<std::size_t>(count_)] = count_;
    return count_++;
  }
  int root(int label) {
    while (parent(label) != label) {
      parent(label) = parent(parent(label));
      label = parent(label);
    }
    return label;
  }
  int join(int a, int b) {
    if (a == b) return a;
    a = root(a);
    b = root(b);
    parent(std::max(a, b)) = std::min(a, b);
    return std::min(a, b);
  }
  int count() const { return count_; }
  /// Never larger than the label itself; equal for a root.
  int& parent(int label) { return parent_[static_cast<std::size_t>(label)]; }

  /// Numbers the sets 0, 1, ... by their smallest label and ends the use of all else: `parent` is the number then.
  /// Returns how many there are.
  int number() {
    int sets = 0;
    // Parents are never larger than their children, so a parent's final number is known before it is needed.
    for (int label = 0; label < count_; ++label)
      parent(label) = parent(label) == label ? sets++ : parent(parent(label));
    return sets;
  }

 private:
  RecycledBuffer<int> parent_;
  int count_ = 0;
};

/// Gives each run a provisional label, joining the sets of those that touch; calls visit(i, label), label >= the number
/// of labels before where it is new.
///
/// Two pointers walk the row at work and the row above it; `above` never goes back but by the one run that may reach
/// on.
template <class Visit>
void label_each(std::span<const PixelRun> runs, Connectivity connectivity, LabelSets& sets, RecycledBuffer<int>& labels,
                Visit visit) {
  const int reach = connectivity == Connectivity::eight ? 1 : 0;
  std::size_t above = 0, above_end = 0;  // runs of the row above
  for (std::size_t i = 0; i < runs.size();) {
    const int row = runs[i].row;
    if (above_end > above && runs[above_end - 1].row != row - 1) above = above_end;
    const std::size_t row_begin = i;
    for (; i < runs.size() && runs[i].row == row; ++i) {
      const int begin = runs[i].begin - reach, end = runs[i].end + reach;
      while (above < above_end && runs[above].end <= begin) ++above;
      int label = -1;
      std::size_t touching = above;
      for (; touching < above_end && runs[touching].begin < end; ++touching)
        label = label < 0 ? labels[touching] : sets.join(label, labels[touching]);
      if (label < 0) label = sets.add();
      labels[i] = label;
      visit(i, label);
      // The last one may reach on to the next run of this row.
      if (touching > above) above = touching - 1;
    }
    above = row_begin;
    above_end = i;
  }
}

/// Sums over a component while it is being found.
struct Sums {
  std::int64_t area, twice_columns, rows;  ///< Number of pixels, twice the sum of their columns, sum of their rows.
  int x0, y0, x1, y1;

  void add(const Sums& other) {
    area += other.area;
    twice_columns += other.twice_columns;
    rows += other.rows;
    x0 = std::min(x0, other.x0);
    y0 = std::min(y0, other.y0);
    x1 = std::max(x1, other.x1);
    y1 = std::max(y1, other.y1);
  }
};

Sums sums_of(const PixelRun& run) {
  const std::int64_t length = run.length();
  return {length, length * (run.begin + run.end - 1), length * run.row, run.begin, run.row, run.end, run.row + 1};
}

}  // namespace

RunLabels label_runs(const Region& region, Connectivity connectivity) {
  const auto runs = region.runs();
  LabelSets sets(runs.size());
  RecycledBuffer<int> provisional(runs.size());
  label_each(runs, connectivity, sets, provisional, [](std::size_t, int) {});
  RunLabels labels;
  labels.count = sets.number();
  labels.label.resize(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i) labels.label[i] = sets.parent(provisional[i]);
  return labels;
}

RecycledVector<ComponentFeatures> component_features(const Region& region, Connectivity connectivity) {
  const auto runs = region.runs();
  LabelSets sets(runs.size());
  RecycledBuffer<int> provisional(runs.size());
  RecycledBuffer<Sums> sums(runs.size());
  int known = 0;
  label_each(runs, connectivity, sets, provisional, [&](std::size_t i, int label) {
    const Sums run = sums_of(runs[i]);
    Sums& of_label = sums[static_cast<std::size_t>(label)];
    if (label == known) {
      of_label = run;
      ++known;
    } else {
      of_label.add(run);
    }
  });
  // From the last label on, each set gathers in its smallest one.
  for (int label = sets.count() - 1; label >= 0; --label)
    if (const int parent = sets.parent(label); parent != label)
      sums[static_cast<std::size_t>(parent)].add(sums[static_cast<std::size_t>(label)]);
  RecycledVector<ComponentFeatures> features;
  features.reserve(static_cast<std::size_t>(sets.count()));
  for (int label = 0; label < sets.count(); ++label) {
    if (sets.parent(label) != label) continue;
    const Sums& of = sums[static_cast<std::size_t>(label)];
    const auto area = static_cast<double>(of.area);
    features.push_back(
        {.area = of.area,
         .center = {static_cast<double>(of.twice_columns) / (2 * area), static_cast<double>(of.rows) / area},
         .box = {of.x0, of.y0, of.x1, of.y1}});
  }
  return features;
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
