#pragma once

#include <cstddef>
#include <vector>

namespace tassilo {

/// A message of `size` bytes after its header whose bytes tell of their place and of the seed.
inline std::vector<std::byte> bus_pattern(std::size_t size, int seed) {
  std::vector<std::byte> data = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  data.reserve(size + 4);
  for (std::size_t i = 0; i < size; ++i)
    data.push_back(static_cast<std::byte>((i * 7 + i / 251 + static_cast<std::size_t>(seed)) & 255));
  return data;
}

}  // namespace tassilo
