#include "tassilo/base/recycled.h"

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>

#if defined(__SANITIZE_ADDRESS__)
#define TASSILO_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TASSILO_ASAN 1
#endif
#endif
#ifdef TASSILO_ASAN
extern "C" void __asan_poison_memory_region(void const volatile* address, std::size_t bytes);
extern "C" void __asan_unpoison_memory_region(void const volatile* address, std::size_t bytes);
#endif

namespace tassilo {
namespace {

constexpr std::size_t kSmallest = 5;  ///< Power of two: 32 bytes.
constexpr std::size_t kSizes = 22;    ///< Up to 64 MiB; what is larger is never kept.

std::size_t size_index(std::size_t bytes) {
  return std::max<std::size_t>(std::bit_width(bytes - 1), kSmallest) - kSmallest;
}
constexpr std::size_t block_bytes(std::size_t index) { return std::size_t{1} << (index + kSmallest); }
constexpr std::size_t most_blocks(std::size_t index) {
  const std::size_t bytes = block_bytes(index);
  return std::max<std::size_t>(bytes >= (1 << 20) ? 2 : 8, (256 << 10) / bytes);
}

/// Free blocks of one size; the list's links lie in the blocks.
class BlockList {
 public:
  std::size_t size() const { return size_; }

  void push(void* block, [[maybe_unused]] std::size_t bytes) {
    first_ = new (block) Link{first_};
    ++size_;
#ifdef TASSILO_ASAN
    __asan_poison_memory_region(static_cast<char*>(block) + sizeof(Link), bytes - sizeof(Link));
#endif
  }
  /// Null when there is none.
  void* pop([[maybe_unused]] std::size_t bytes) {
    if (first_ == nullptr) return nullptr;
    Link* const block = first_;
    first_ = block->next;
    --size_;
#ifdef TASSILO_ASAN
    __asan_unpoison_memory_region(block, bytes);
#endif
    return block;
  }

 private:
  struct Link {
    Link* next;
  };
  Link* first_ = nullptr;
  std::size_t size_ = 0;
};

/// What all threads share: blocks that one thread has too many of serve those that have none.
struct Pool {
  std::mutex mutex;
  std::array<BlockList, kSizes> lists;
};
Pool& pool() {
  static Pool* const shared = new Pool;  // never destroyed: vectors of static objects outlive any static pool
  return *shared;
}

/// Moves all but `keep` blocks to the pool, or to the system where the pool has enough.
void shed(BlockList& list, std::size_t index, std::size_t keep) noexcept {
  const std::size_t bytes = block_bytes(index);
  Pool& shared = pool();
  const std::lock_guard lock(shared.mutex);
  while (list.size() > keep) {
    void* const block = list.pop(bytes);
    if (shared.lists[index].size() < most_blocks(index))
      shared.lists[index].push(block, bytes);
    else
      ::operator delete(block);
  }
}

/// Refills an empty list from the pool: half of what a thread may keep.
void refill(BlockList& list, std::size_t index) {
  const std::size_t bytes = block_bytes(index);
  Pool& shared = pool();
  const std::lock_guard lock(shared.mutex);
  while (list.size() < std::max<std::size_t>(1, most_blocks(index) / 2)) {
    void* const block = shared.lists[index].pop(bytes);
    if (block == nullptr) return;
    list.push(block, bytes);
  }
}

struct ThreadCache {
  std::array<BlockList, kSizes> lists;
  ~ThreadCache();
};
/// Objects that are destroyed later than their thread's cache give their memory back to the system.
constinit thread_local bool cache_is_gone = false;

ThreadCache::~ThreadCache() {
  cache_is_gone = true;
  for (std::size_t i = 0; i < kSizes; ++i) shed(lists[i], i, 0);
}

ThreadCache* thread_cache() {
  if (cache_is_gone) return nullptr;
  thread_local ThreadCache cache;
  return &cache;
}

void* block_of_size(std::size_t index) {
  if (ThreadCache* const cache = thread_cache()) {
    BlockList& list = cache->lists[index];
    if (list.size() == 0) refill(list, index);
    if (void* const block = list.pop(block_bytes(index))) return block;
  }
  return ::operator new(block_bytes(index));
}

}  // namespace

void* take_block(std::size_t bytes) {
  const std::size_t index = size_index(bytes);
  if (index >= kSizes) return ::operator new(bytes);
  void* const block = block_of_size(index);
#ifdef TASSILO_ASAN
  __asan_poison_memory_region(static_cast<char*>(block) + bytes, block_bytes(index) - bytes);
#endif
  return block;
}

void give_back_block(void* block, std::size_t bytes) noexcept {
  const std::size_t index = size_index(bytes);
  if (index >= kSizes) {
    ::operator delete(block);
    return;
  }
#ifdef TASSILO_ASAN
  __asan_unpoison_memory_region(block, block_bytes(index));
#endif
  ThreadCache* const cache = thread_cache();
  if (cache == nullptr) {
    ::operator delete(block);
    return;
  }
  BlockList& list = cache->lists[index];
  if (list.size() >= most_blocks(index)) shed(list, index, most_blocks(index) / 2);
  list.push(block, block_bytes(index));
}

}  // namespace tassilo
