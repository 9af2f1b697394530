#pragma once

// Counts what a program takes by operator new. It replaces the operators: included by one source of the program.

#if defined(__GNUC__) && !defined(__clang__)
// Where g++ 12 inlines one of our operators and not the other, it takes `free` for the wrong end of `new`.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace tassilo::test {

/// Calls of operator new, and the bytes that malloc has set aside for those not deleted yet: now and at most.
inline std::atomic<std::int64_t> allocations = 0, held_bytes = 0, peak_bytes = 0;

inline void* counted(std::size_t bytes, std::size_t alignment) {
  const std::size_t rounded = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
  void* const block = std::aligned_alloc(alignment, rounded);
  if (block == nullptr) throw std::bad_alloc();
  ++allocations;
  const std::int64_t held = held_bytes += static_cast<std::int64_t>(malloc_usable_size(block));
  peak_bytes = std::max<std::int64_t>(peak_bytes, held);
  return block;
}
inline void release(void* block) {
  if (block != nullptr) held_bytes -= static_cast<std::int64_t>(malloc_usable_size(block));
  std::free(block);
}

}  // namespace tassilo::test

void* operator new(std::size_t bytes) { return tassilo::test::counted(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return tassilo::test::counted(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return operator new(bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* block) noexcept { tassilo::test::release(block); }
void operator delete(void* block, std::size_t) noexcept { tassilo::test::release(block); }
void operator delete(void* block, std::align_val_t) noexcept { tassilo::test::release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { tassilo::test::release(block); }
