#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace tassilo {

/// A block of `bytes` > 0, aligned for any fundamental type: one that was given back before, or a new one.
/// Throws std::bad_alloc. Use RecyclingAllocator instead.
void* take_block(std::size_t bytes);
/// Takes back a block that take_block gave for the same number of bytes, on whatever thread.
void give_back_block(void* block, std::size_t bytes) noexcept;

/// Gives containers memory that was in use before: what one frame leaves behind serves the next, so that nothing is
/// allocated per frame in steady state, and plain calls such as opening(region, disc(3.5)) need no workspace.
///
/// Sizes are rounded up to powers of two. A thread keeps what it frees, of each size some 256 KiB or 8 blocks, of
/// blocks from 1 MiB on two (so at most some 260 MiB, and only of sizes it has used), and hands what is more to a pool
/// that all threads share, equally bounded; the rest goes back to the system. Under AddressSanitizer kept blocks are
/// poisoned, so that no use after free hides.
///
/// cost     some ns where memory is at hand; stateless, safe from any thread
template <class T>
struct RecyclingAllocator {
  static_assert(alignof(T) <= alignof(std::max_align_t), "blocks are aligned for fundamental types");
  using value_type = T;

  RecyclingAllocator() = default;
  template <class U>
  RecyclingAllocator(const RecyclingAllocator<U>&) {}

  T* allocate(std::size_t n) {
    if (n > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(take_block(n * sizeof(T)));
  }
  void deallocate(T* block, std::size_t n) noexcept { give_back_block(block, n * sizeof(T)); }
  friend bool operator==(const RecyclingAllocator&, const RecyclingAllocator&) { return true; }
};

/// A std::vector for what lives as long as a frame.
template <class T>
using RecycledVector = std::vector<T, RecyclingAllocator<T>>;

/// Room for values that are written before they are read: recycled memory, not initialized.
template <class T>
class RecycledBuffer {
 public:
  static_assert(std::is_trivially_copyable_v<T>);

  RecycledBuffer() = default;
  explicit RecycledBuffer(std::size_t size)
      : data_(RecyclingAllocator<T>().allocate(std::max<std::size_t>(size, 1))), size_(size) {}
  RecycledBuffer(RecycledBuffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  RecycledBuffer& operator=(RecycledBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  ~RecycledBuffer() {
    if (data_ != nullptr) RecyclingAllocator<T>().deallocate(data_, std::max<std::size_t>(size_, 1));
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace tassilo
