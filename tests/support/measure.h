#pragma once

#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

// For benchmarks only: one way to measure a call, so that all figures mean the same.

namespace tassilo::test {

/// Time this thread has worked: others may want the core, too. [s]
inline double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Times a call on inputs that are cycled: another one each time, so that no branch predictor learns one by heart. The
/// clock is read once a pass over all inputs, as reading it takes longer than some calls.
class PassTimer {
 public:
  explicit PassTimer(std::size_t inputs) : inputs_(inputs) {}

  /// The input of the next call.
  std::size_t next() {
    if (calls_ == 0) start_ = thread_seconds();
    return calls_;
  }
  void called() {
    if (++calls_ == inputs_) end_pass();
  }
  /// Time of a call: a mean over all inputs, of which the first quartile over the passes. What others do to the caches
  /// makes calls slower, never faster. Without a whole pass the mean of what there was. [s]
  double seconds() {
    if (passes_.empty() && calls_ > 0) end_pass();
    if (passes_.empty()) return 0;
    const auto quartile = passes_.begin() + static_cast<std::ptrdiff_t>(passes_.size() / 4);
    std::nth_element(passes_.begin(), quartile, passes_.end());
    return *quartile;
  }

 private:
  void end_pass() {
    passes_.push_back((thread_seconds() - start_) / static_cast<double>(calls_));
    calls_ = 0;
  }

  std::size_t inputs_, calls_ = 0;
  double start_ = 0;
  std::vector<double> passes_;
};

/// Runs call(input) as often as the library asks, input below `inputs`; the counter `us` is the time of a call as
/// PassTimer has it. What comes first finds cold caches and touches new memory: a pass, or what fits in 50 ms of it,
/// runs before the clock. [us]
template <class Call>
void measure(benchmark::State& state, std::size_t inputs, Call call) {
  const double start = thread_seconds();
  for (std::size_t k = 0; k < inputs && thread_seconds() < start + .05; ++k) call(k);
  PassTimer timer(inputs);
  for (auto _ : state) {
    call(timer.next());
    timer.called();
  }
  state.counters["us"] = 1e6 * timer.seconds();
}

}  // namespace tassilo::test
