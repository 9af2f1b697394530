#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tassilo/color/internal/color_kernel.h"

// Loops over a row of labels that machines with vectors of bytes have in common. A kernel's source includes this after
// it has defined TASSILO_ROW_TARGET, what functions of that machine are marked with, be it nothing. `Bytes` says how
// the machine works on a vector:
//
//   kSize, Vector                       how many bytes, and their type
//   zero(), load(from), store(to, v)
//   left_of(before, here)               each byte's left neighbor, from two vectors side by side
//   right_of(here, after)
//   same(a, b, c)                       bytes that all three share, else 0
//   any(a, b, c)                        a | b | c
//   kBitsPerByte, changes(a, b)         a mask with one bit for each byte that differs, kBitsPerByte apart

namespace tassilo {

template <class Bytes>
TASSILO_ROW_TARGET int runs_of(const std::uint8_t* labels, int width, RowRuns runs) {
  int count = 0;
  std::uint8_t label = 0;  // of the run at work
  const auto change = [&](int c, std::uint8_t to) {
    runs.end[count] = static_cast<std::uint16_t>(c);
    count += label != 0;
    runs.begin[count] = static_cast<std::uint16_t>(c);
    runs.label[count] = label = to;
  };
  if (width > 0 && labels[0] != 0) change(0, labels[0]);
  int c = 1;
  for (; c + Bytes::kSize <= width; c += Bytes::kSize) {
    auto changed = Bytes::changes(Bytes::load(labels + c), Bytes::load(labels + c - 1));
    for (; changed != 0; changed &= changed - 1) {
      const int at = c + __builtin_ctzll(changed) / Bytes::kBitsPerByte;
      change(at, labels[at]);
    }
  }
  for (; c < width; ++c)
    if (labels[c] != labels[c - 1]) change(c, labels[c]);
  if (width > 0 && label != 0) change(width, 0);
  return count;
}

/// The bytes from c on, of which those from `width` on are 0.
template <class Bytes>
TASSILO_ROW_TARGET typename Bytes::Vector load_inside(const std::uint8_t* row, int c, int width) {
  if (c + Bytes::kSize <= width) return Bytes::load(row + c);
  std::array<std::uint8_t, Bytes::kSize> rest{};
  for (int k = 0; k < width - c; ++k) rest[static_cast<std::size_t>(k)] = row[c + k];
  return Bytes::load(rest.data());
}

template <class Bytes>
struct Same {
  TASSILO_ROW_TARGET static typename Bytes::Vector join(typename Bytes::Vector a, typename Bytes::Vector b,
                                                        typename Bytes::Vector c) {
    return Bytes::same(a, b, c);
  }
};
template <class Bytes>
struct Any {
  TASSILO_ROW_TARGET static typename Bytes::Vector join(typename Bytes::Vector a, typename Bytes::Vector b,
                                                        typename Bytes::Vector c) {
    return Bytes::any(a, b, c);
  }
};

/// Joins the nine pixels around and at each place: down the columns, then along the row.
template <class Bytes, class Operation>
TASSILO_ROW_TARGET void over_nine(ThreeRows rows, int width, std::uint8_t* labels) {
  using Vector = typename Bytes::Vector;
  const auto column = [&](int c) TASSILO_ROW_TARGET -> Vector {
    if (c >= width) return Bytes::zero();
    return Operation::join(load_inside<Bytes>(rows.above, c, width), load_inside<Bytes>(rows.here, c, width),
                           load_inside<Bytes>(rows.below, c, width));
  };
  Vector before = Bytes::zero(), here = column(0);
  for (int c = 0; c < width; c += Bytes::kSize) {
    const Vector after = column(c + Bytes::kSize);
    const Vector out = Operation::join(Bytes::left_of(before, here), here, Bytes::right_of(here, after));
    if (c + Bytes::kSize <= width) {
      Bytes::store(labels + c, out);
    } else {
      std::array<std::uint8_t, Bytes::kSize> rest;
      Bytes::store(rest.data(), out);
      for (int k = 0; k < width - c; ++k) labels[c + k] = rest[static_cast<std::size_t>(k)];
    }
    before = here;
    here = after;
  }
}

template <class Bytes>
TASSILO_ROW_TARGET void erode_rows(const ThreeRows& rows, int width, std::uint8_t* labels) {
  over_nine<Bytes, Same<Bytes>>(rows, width, labels);
}
template <class Bytes>
TASSILO_ROW_TARGET int dilate_rows(const ThreeRows& rows, int width, std::uint8_t* labels, const RowRuns& runs) {
  over_nine<Bytes, Any<Bytes>>(rows, width, labels);
  return runs_of<Bytes>(labels, width, runs);
}

}  // namespace tassilo
