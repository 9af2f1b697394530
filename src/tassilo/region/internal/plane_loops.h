#pragma once

#include <cstddef>
#include <cstdint>

#include "tassilo/region/internal/coordinate.h"
#include "tassilo/region/internal/plane_kernel.h"

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

template <class Take>
TASSILO_INLINE void join_triple(std::uint64_t* __restrict to, const std::uint64_t* __restrict b, std::size_t words,
                                std::ptrdiff_t shift) {
  const std::ptrdiff_t whole = shift >> 6;
  const int part = static_cast<int>(shift & 63);
  const std::uint64_t* const once = b - whole;
  const std::uint64_t* const twice = b - 2 * whole - (part >= 32 ? 1 : 0);
  const int part_twice = 2 * part & 63;
  if (part == 0) {
    for (std::size_t i = 0; i < words; ++i) to[i] = Take::join(b[i], Take::join(once[i], twice[i]));
    return;
  }
  if (part_twice == 0) {
    for (std::size_t i = 0; i < words; ++i)
      to[i] = Take::join(b[i], Take::join(once[i] << part | (once - 1)[i] >> (64 - part), twice[i]));
    return;
  }
  for (std::size_t i = 0; i < words; ++i)
    to[i] = Take::join(b[i], Take::join(once[i] << part | (once - 1)[i] >> (64 - part),
                                        twice[i] << part_twice | (twice - 1)[i] >> (64 - part_twice)));
}

template <class Take>
TASSILO_INLINE void join_nine(std::uint64_t* __restrict to, const std::uint64_t* __restrict b, std::size_t words,
                              std::size_t row_words, int sign) {
  const auto row = static_cast<std::ptrdiff_t>(row_words);
  const auto rows = [](const std::uint64_t* from, const std::uint64_t* next, const std::uint64_t* last, std::size_t i) {
    return Take::join(from[i], Take::join(next[i], last[i]));
  };
  if (sign > 0) {
    const std::uint64_t *const once = b - row, *const twice = once - row;
    for (std::size_t i = 0; i < words; ++i) {
      const std::uint64_t here = rows(b, once, twice, i), below = rows(b - 1, once - 1, twice - 1, i);
      to[i] = Take::join(here, Take::join(here << 1 | below >> 63, here << 2 | below >> 62));
    }
  } else {
    const std::uint64_t *const once = b + row, *const twice = once + row;
    for (std::size_t i = 0; i < words; ++i) {
      const std::uint64_t here = rows(b, once, twice, i), above = rows(b + 1, once + 1, twice + 1, i);
      to[i] = Take::join(here, Take::join(here >> 1 | above << 63, here >> 2 | above << 62));
    }
  }
}

/// The numbers of a word's bits, `first` being that of its lowest; returns where the next ones go.
TASSILO_INLINE std::uint32_t* write_bits(std::uint64_t word, std::uint32_t first, std::uint32_t* at) {
  for (; word != 0; word &= word - 1) *at++ = first + static_cast<std::uint32_t>(__builtin_ctzll(word));
  return at;
}

TASSILO_INLINE std::size_t find_changes(std::uint32_t* at, const std::uint64_t* b, std::size_t words) {
  std::uint32_t* end = at;
  std::uint64_t below = b[-1];
  for (std::size_t i = 0; i < words; ++i) {
    end = write_bits(b[i] ^ (b[i] << 1 | below >> 63), static_cast<std::uint32_t>(64 * i), end);
    below = b[i];
  }
  return static_cast<std::size_t>(end - at);
}

/// Most words hold no change.
TASSILO_INLINE void fill_between(std::uint64_t* words, std::size_t count) {
  std::uint64_t inside = 0;  // all bits as the one before this word
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t word = words[i];
    if (word != 0) {
      for (int step = 1; step < 64; step *= 2) word ^= word << step;
      word ^= inside;
      inside = 0 - (word >> 63);
      words[i] = word;
    } else {
      words[i] = inside;
    }
  }
}

TASSILO_INLINE void runs_between(PixelRun* to, const std::uint32_t* at, std::size_t count, const RowsOfBits& rows) {
  // Exact: a number has 20 bits, a float 24, and a bit's middle lies half a bit from the next row.
  const float rows_per_bit = 1 / static_cast<float>(rows.row_bits);
  for (std::size_t k = 0; k < count; k += 2) {
    const int row = static_cast<int>((static_cast<float>(at[k]) + 0.5f) * rows_per_bit);
    const int left = rows.left - row * rows.row_bits;
    *to++ = {to_coordinate(rows.top + row), to_coordinate(left + static_cast<int>(at[k])),
             to_coordinate(left + static_cast<int>(at[k + 1]))};
  }
}

/// Defines the joining functions for the machine that `target` (an attribute, or nothing) names.
#define TASSILO_PLANE_JOINS(target)                                                                            \
  target void join_or(std::uint64_t* to, const std::uint64_t* a, const std::uint64_t* b, std::size_t words,    \
                      std::ptrdiff_t shift) {                                                                  \
    join_shifted<TakeOr>(to, a, b, words, shift);                                                              \
  }                                                                                                            \
  target void join_and(std::uint64_t* to, const std::uint64_t* a, const std::uint64_t* b, std::size_t words,   \
                       std::ptrdiff_t shift) {                                                                 \
    join_shifted<TakeAnd>(to, a, b, words, shift);                                                             \
  }                                                                                                            \
  target void triple_or(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::ptrdiff_t shift) {  \
    join_triple<TakeOr>(to, b, words, shift);                                                                  \
  }                                                                                                            \
  target void triple_and(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::ptrdiff_t shift) { \
    join_triple<TakeAnd>(to, b, words, shift);                                                                 \
  }                                                                                                            \
  target void move(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::ptrdiff_t shift) {       \
    join_shifted<TakeSecond>(to, b, b, words, shift);                                                          \
  }

#define TASSILO_PLANE_NINES(target)                                                                               \
  target void nine_or(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::size_t row, int sign) {  \
    join_nine<TakeOr>(to, b, words, row, sign);                                                                   \
  }                                                                                                               \
  target void nine_and(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::size_t row, int sign) { \
    join_nine<TakeAnd>(to, b, words, row, sign);                                                                  \
  }

}  // namespace tassilo
