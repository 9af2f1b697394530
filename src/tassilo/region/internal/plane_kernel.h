#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tassilo/base/kernel.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// Where rows of bits lie in the image: bit k of the string is at column left + k % row_bits, row top + k / row_bits.
struct RowsOfBits {
  int left = 0, top = 0;  ///< [px]
  int row_bits = 0;
};

/// The inner loops over bit planes. All kernels give the same words.
///
/// A plane is one string of bits; `shift` moves it towards higher places, or, where negative, lower ones. A loop reads
/// as far beyond both ends of `b` as the shift reaches, and one word more; `to` must not overlap `a` or `b`.
struct PlaneKernel {
  Kernel kernel;
  /// to = a | (b shifted), `words` words.
  void (*join_or)(std::uint64_t* to, const std::uint64_t* a, const std::uint64_t* b, std::size_t words,
                  std::ptrdiff_t shift);
  /// to = a & (b shifted).
  void (*join_and)(std::uint64_t* to, const std::uint64_t* a, const std::uint64_t* b, std::size_t words,
                   std::ptrdiff_t shift);
  /// to = b | (b shifted) | (b shifted twice as far): what elements of three columns or rows need, in one go.
  void (*triple_or)(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::ptrdiff_t shift);
  /// to = b & (b shifted) & (b shifted twice as far).
  void (*triple_and)(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::ptrdiff_t shift);
  /// to = the or over b shifted by 0, 1 and 2 columns and by 0, 1 and 2 rows of `row_words` words: three columns and
  /// three rows in one go. To higher places, or, where `sign` is -1, to lower ones.
  void (*nine_or)(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::size_t row_words, int sign);
  /// The same with and.
  void (*nine_and)(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::size_t row_words, int sign);
  /// to = b shifted.
  void (*move)(std::uint64_t* to, const std::uint64_t* b, std::size_t words, std::ptrdiff_t shift);
  /// Numbers of the bits that differ from the one before, by rising number, to `at`, which has room for 64 a word
  /// and 16 more. The word before `b` is read, too. Returns how many there are.
  std::size_t (*changes)(std::uint32_t* at, const std::uint64_t* b, std::size_t words);
  /// The way back: each bit becomes the xor of itself and all before it.
  void (*fill)(std::uint64_t* words, std::size_t count);
  /// The runs between the first and the second of `count` numbers, the third and the fourth, .., each pair within one
  /// row, numbers below 2^20. `to` has room for 8 runs more.
  void (*runs)(PixelRun* to, const std::uint32_t* at, std::size_t count, const RowsOfBits& rows);
};

/// Those of this build, of which the machine may not run all: the plain one first, the fastest last. On aarch64 the
/// compiler makes NEON of the plain one.
std::span<const PlaneKernel> plane_kernels();

extern const PlaneKernel plain_plane_kernel;
#if defined(__x86_64__)
extern const PlaneKernel avx2_plane_kernel;
extern const PlaneKernel avx512_plane_kernel;
#endif

}  // namespace tassilo
