#include "tassilo/timeline/sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

struct Length {
  double m = 0;
};

}  // namespace

template <>
struct Interpolation<Length> {
  static constexpr double kMaxGap = 1, kMaxExtrapolation = 0.25;
  static Length between(const Length& a, const Length& b, double share) { return {a.m + share * (b.m - a.m)}; }
};

namespace {

static_assert(Interpolated<Length>);
static_assert(!Interpolated<std::string>);

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class T>
std::vector<double> times_of(const Sequence<T>& sequence) {
  std::vector<double> times;
  for (std::size_t i = 0; i < sequence.size(); ++i) times.push_back(sequence[i].t);
  return times;
}

Sequence<Length> lengths(const std::vector<std::pair<double, double>>& values) {
  Sequence<Length> sequence(values.size());
  for (const auto& [t, m] : values) sequence.add(t, {m});
  return sequence;
}

TEST(Sequence, EmptyHasNothing) {
  const Sequence<Length> sequence(3);
  EXPECT_TRUE(sequence.empty());
  EXPECT_EQ(sequence.capacity(), 3u);
  EXPECT_EQ(sequence.latest(), nullptr);
  EXPECT_EQ(sequence.before(kInfinity), nullptr);
  EXPECT_EQ(sequence.at_or_before(0), nullptr);
  EXPECT_FALSE(sequence.at(0));
  EXPECT_EQ(sequence.counts(), SequenceCounts{});
}

// Whatever the order: the newest distinct times are kept, sorted, each with the value that came first, and the counts
// add up. The definition is a map.
TEST(Sequence, KeepsTheNewestInWhateverOrderTheyCome) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::size_t capacity = 1 + random() % 12;
    const int values = static_cast<int>(random() % 60);
    // From in order with few that are late to no order at all.
    std::uniform_int_distribution<int> delay(0, 1 << random() % 7);
    Sequence<int> sequence(capacity);
    std::map<double, int> kept;
    SequenceCounts counts;
    for (int value = 0; value < values; ++value) {
      const double t = value - delay(random);
      Added expected = kept.empty() || t > kept.rbegin()->first ? Added::newest : Added::inserted;
      if (kept.contains(t))
        expected = Added::duplicate;
      else if (kept.size() == capacity && t < kept.begin()->first)
        expected = Added::too_late;
      ASSERT_EQ(sequence.add(t, value), expected) << "value " << value << " at " << t;
      if (expected == Added::newest || expected == Added::inserted) {
        if (kept.size() == capacity) kept.erase(kept.begin());
        kept[t] = value;
      }
      counts.added += expected == Added::newest || expected == Added::inserted;
      counts.out_of_order += expected == Added::inserted;
      counts.duplicates += expected == Added::duplicate;
      counts.too_late += expected == Added::too_late;
      ASSERT_EQ(sequence.size(), kept.size());
      std::size_t i = 0;
      for (const auto& [time, first] : kept) {
        ASSERT_EQ(sequence[i].t, time);
        ASSERT_EQ(sequence[i++].value, first);
      }
    }
    EXPECT_EQ(sequence.counts(), counts);
    EXPECT_EQ(counts.added + counts.duplicates + counts.too_late, values);
  }
}

TEST(Sequence, IsTheSameForAnyOrder) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::vector<int> values(40);
    for (int i = 0; i < 40; ++i) values[static_cast<std::size_t>(i)] = i;
    const auto sequence_of = [&](std::size_t capacity) {
      Sequence<int> sequence(capacity);
      for (const int value : values) sequence.add(0.1 * value, value);
      return sequence;
    };
    const Sequence<int> all = sequence_of(40), some = sequence_of(7);
    std::ranges::shuffle(values, random);
    const Sequence<int> all_shuffled = sequence_of(40), some_shuffled = sequence_of(7);
    EXPECT_EQ(times_of(all_shuffled), times_of(all));
    EXPECT_EQ(times_of(some_shuffled), times_of(some));
    EXPECT_EQ(all_shuffled.counts().added, 40);
    EXPECT_EQ(all_shuffled.counts().too_late, 0);
    EXPECT_EQ(some_shuffled.counts().added + some_shuffled.counts().too_late, 40);
  }
}

TEST(Sequence, FindsWhatIsBefore) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Sequence<int> sequence(1 + random() % 8);
    for (int value = 0; value < 20; ++value) sequence.add(static_cast<double>(random() % 16), value);
    for (int half = -2; half < 36; ++half) {
      const double t = 0.5 * half;
      const Timed<int>*before = nullptr, *at_or_before = nullptr;
      for (std::size_t i = 0; i < sequence.size(); ++i) {
        if (sequence[i].t < t) before = &sequence[i];
        if (sequence[i].t <= t) at_or_before = &sequence[i];
      }
      EXPECT_EQ(sequence.before(t), before) << t;
      EXPECT_EQ(sequence.at_or_before(t), at_or_before) << t;
    }
    EXPECT_EQ(sequence.latest(), &sequence[sequence.size() - 1]);
    EXPECT_EQ(sequence.before(kInfinity), sequence.latest());
    EXPECT_EQ(sequence.at_or_before(kInfinity), sequence.latest());
    EXPECT_EQ(sequence.before(kNan), nullptr);
    EXPECT_EQ(sequence.at_or_before(kNan), nullptr);
  }
}

// Every value is in one of `capacity` places, all taken when the sequence was made.
TEST(Sequence, TakesItsMemoryOnce) {
  std::mt19937 random(1);
  Sequence<int> sequence(16);
  std::set<const void*> places;
  for (int value = 0; value < 2000; ++value) {
    sequence.add(value - static_cast<double>(random() % 24), value);
    if (value % 500 == 499) sequence.clear();
    for (std::size_t i = 0; i < sequence.size(); ++i) places.insert(&sequence[i]);
  }
  EXPECT_EQ(places.size(), 16u);
  EXPECT_EQ(static_cast<const Timed<int>*>(*places.rbegin()) - static_cast<const Timed<int>*>(*places.begin()), 15);
}

TEST(Sequence, IsAsNewOnceCleared) {
  Sequence<Length> sequence = lengths({{1, 1}, {2, 2}, {1, 3}, {1.5, 4}});
  EXPECT_EQ(sequence.counts(), (SequenceCounts{.added = 3, .out_of_order = 1, .duplicates = 1}));
  sequence.clear();
  EXPECT_TRUE(sequence.empty());
  EXPECT_EQ(sequence.capacity(), 4u);
  EXPECT_EQ(sequence.counts(), SequenceCounts{});
  EXPECT_EQ(sequence.latest(), nullptr);
  EXPECT_FALSE(sequence.at(1.5));
  EXPECT_EQ(sequence.add(-5, {7}), Added::newest);
  EXPECT_EQ(sequence.at(-5)->m, 7);
}

TEST(Sequence, HoldsWhatCanOnlyBeMoved) {
  Sequence<std::unique_ptr<int>> sequence(3);
  for (const int t : {5, 1, 3, 4, 2}) sequence.add(t, std::make_unique<int>(t));
  EXPECT_EQ(times_of(sequence), (std::vector<double>{3, 4, 5}));
  for (std::size_t i = 0; i < sequence.size(); ++i) EXPECT_EQ(*sequence[i].value, sequence[i].t);
}

TEST(Sequence, RefusesATimeThatIsNone) {
  Sequence<int> sequence(2);
  for (const double t : {kNan, kInfinity, -kInfinity}) EXPECT_THROW(sequence.add(t, 1), Error);
  EXPECT_THAT([&] { sequence.add(kNan, 1); }, testing::ThrowsMessage<Error>("sequence: t is nan, must be finite"));
  EXPECT_EQ(sequence.counts(), SequenceCounts{});
}

// What is linear in time is found again at any time that is known; what is known is told by the distance to the values.
TEST(SequenceAt, IsLinearBetweenAndBesideValues) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> rate(-2, 2), step(0.01, 1.2), anywhere(-1, 20);
    const double slope = rate(random), offset = rate(random);
    Sequence<Length> sequence(64);
    double time = 0;
    while (time < 18) {
      sequence.add(time, {offset + slope * time});
      time += step(random);
    }
    const std::vector<double> times = times_of(sequence);
    for (int i = 0; i < 300; ++i) {
      const double t = anywhere(random);
      const auto next = static_cast<std::size_t>(std::ranges::lower_bound(times, t) - times.begin());
      // Values that only have gaps around them say nothing of other times.
      const auto near = [&](std::size_t a, std::size_t b) {
        return a < sequence.size() && b < sequence.size() && std::abs(sequence[a].t - sequence[b].t) <= 1;
      };
      const bool inside = next > 0 && near(next - 1, next);
      const bool just_after = next > 1 && t - sequence[next - 1].t <= 0.25 && near(next - 1, next - 2);
      const bool just_before = next < sequence.size() && sequence[next].t - t <= 0.25 && near(next, next + 1);
      const auto value = sequence.at(t);
      ASSERT_EQ(value.has_value(), inside || just_after || just_before) << t;
      if (value) {
        EXPECT_NEAR(value->m, offset + slope * t, 1e-9);
      }
    }
    for (std::size_t i = 0; i < sequence.size(); ++i) EXPECT_EQ(sequence.at(sequence[i].t)->m, sequence[i].value.m);
  }
}

TEST(SequenceAt, StaysBetweenItsNeighbors) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(-5, 5), share(0, 1);
    Sequence<Length> sequence(20);
    for (int i = 0; i < 20; ++i) sequence.add(0.5 * i, {value(random)});
    for (std::size_t i = 0; i + 1 < 20; ++i) {
      const double a = sequence[i].value.m, b = sequence[i + 1].value.m, s = share(random);
      const auto at = sequence.at(sequence[i].t + s * 0.5);
      ASSERT_TRUE(at);
      EXPECT_NEAR(at->m, (1 - s) * a + s * b, 1e-12);
    }
  }
}

// A robot that has waited for a value and one that replays a recording get the same answers about a gap.
TEST(SequenceAt, AValueAfterAGapChangesNoAnswer) {
  for (const double gap : {1.01, 2.0, 100.0}) {
    SCOPED_TRACE(gap);
    const auto before = lengths({{0, 0}, {0.5, 1}, {0.625, 3}});
    const auto after = lengths({{0, 0}, {0.5, 1}, {0.625, 3}, {0.625 + gap, -20}});
    for (int step = -8; 0.0625 * step < 0.625 + gap; ++step) {
      const double t = 0.0625 * step;
      ASSERT_EQ(before.at(t).has_value(), after.at(t).has_value()) << t;
      if (before.at(t)) {
        EXPECT_EQ(before.at(t)->m, after.at(t)->m) << t;
      }
    }
  }
}

TEST(SequenceAt, ExtrapolatesNotByWhatIsBeyondAGap) {
  const auto sequence = lengths({{0, 0}, {2, 100}, {2.125, 101}, {4, 7}, {6, 0}, {6.5, 1}});
  EXPECT_EQ(sequence.at(2.25)->m, 102);
  EXPECT_EQ(sequence.at(2.375)->m, 103);
  EXPECT_EQ(sequence.at(1.875)->m, 99);
  EXPECT_EQ(sequence.at(1.75)->m, 98);
  EXPECT_EQ(sequence.at(5.75)->m, -0.5);
  for (const double t : {-0.1, 0.1, 1.0, 1.74, 2.376, 3.9, 4.1, 5.0, 5.74, 6.76}) EXPECT_FALSE(sequence.at(t)) << t;
  EXPECT_EQ(sequence.at(4)->m, 7);
}

TEST(SequenceAt, OneValueAloneSaysNothingOfOtherTimes) {
  const auto sequence = lengths({{1, 2}});
  EXPECT_EQ(sequence.at(1)->m, 2);
  for (const double t : {0.99, 1.01, kNan, kInfinity, -kInfinity}) EXPECT_FALSE(sequence.at(t));
}

}  // namespace
}  // namespace tassilo
