#pragma once

#include <cstddef>
#include <cstdint>

// The loops of PlaneKernel, once for all machines: plain code that the compiler makes vectors of, for each machine in a
// source of its own. Only those sources include this.

namespace tassilo {

#define TASSILO_INLINE inline __attribute__((always_inline))

struct TakeOr {
  TASSILO_INLINE static std::uint64_t join(std::uint64_t a, std::uint64_t b) { return a | b; }
};
struct TakeAnd {
  TASSILO_INLINE static std::uint64_t join(std::uint64_t a, std::uint64_t b) { return a & b; }
};
struct TakeSecond {
  TASSILO_INLINE static std::uint64_t join(std::uint64_t, std::uint64_t b) { return b; }
};

template <class Take>
TASSILO_INLINE void join_shifted(std::uint64_t* __restrict to, const std::uint64_t* __restrict a,
                                 const std::uint64_t* __restrict b, std::size_t words, std::ptrdiff_t shift) {
  // Word i comes from word i - whole and the one below it.
  const std::ptrdiff_t whole = shift >> 6;
  const int part = static_cast<int>(shift & 63);
  const std::uint64_t* const from = b - whole;
  if (part == 0) {
    for (std::size_t i = 0; i < words; ++i) to[i] = Take::join(a[i], from[i]);
    return;
  }
  const std::uint64_t* const below = from - 1;
  for (std::size_t i = 0; i < words; ++i) to[i] = Take::join(a[i], from[i] << part | below[i] >> (64 - part));
}

TASSILO_INLINE void find_changes(std::uint64_t* __restrict to, const std::uint64_t* __restrict b, std::size_t words) {
  const std::uint64_t* const below = b - 1;
  for (std::size_t i = 0; i < words; ++i) to[i] = b[i] ^ (b[i] << 1 | below[i] >> 63);
}

/// Defines the four functions and the kernel `name` for the machine that `target` (an attribute, or nothing) names.
#define TASSILO_PLANE_KERNEL(name, target)                                                                          \
  namespace {                                                                                                       \
  target void join_or(std::uint64_t* to, const std::uint64_t* a, const std::uint64_t* b, std::size_t words,         \
                      std::ptrdiff_t shift) {                                                                       \
    join_shifted<TakeOr>(to, a, b, words, shift);                                                                   \
  }                                                                                                                 \
  target void join_and(std::uint64_t* to, const std::uint64_t* a, const std::uint64_t* b, std::size_t words,        \
                       std::ptrdiff_t shift) {                                                                      \
    join_shifted<TakeAnd>(to, a, b, words, shift);                                                                  \
  }                                                                                                                 \
  target void move(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::ptrdiff_t shift) {            \
    join_shifted<TakeSecond>(to, b, b, words, shift);                                                               \
  }                                                                                                                 \
  target void changes(std::uint64_t* to, const std::uint64_t* b, std::size_t words) { find_changes(to, b, words); } \
  }                                                                                                                 \
  constinit const PlaneKernel name{join_or, join_and, move, changes};

}  // namespace tassilo
