#pragma once

#include <cstddef>
#include <cstdint>

/// Reads the fuzzer's bytes front to back; 0 after the end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return at_ >= size_; }
  std::uint8_t next() { return empty() ? std::uint8_t{0} : data_[at_++]; }
  /// 0 .. n - 1; n in 1..256.
  int below(int n) { return next() % n; }

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
};
