#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

// Messages as ROS 2 sends them: plain CDR, version 1 (DDSI-RTPS 2.5, chapter 10), behind four bytes that say so.
//
// A message is a struct with `kType`, its name ("std_msgs/Header"), and `fields`, which shows each field with its name
// to a visitor, in the order of its .msg file. Bytes, reading and definition all come from this one list.

namespace tassilo {

template <class T>
concept Message = requires {
  T::kType;
};

/// Bytes of a little-endian message; what is wrong with a value is not its business.
class CdrWriter {
 public:
  CdrWriter() : bytes_{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}} {}

  template <class T>
  void operator()(std::string_view /*name*/, const T& value) {
    write(value);
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

  void raw(const void* data, std::size_t size) {
    const auto* const begin = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }
  void align(std::size_t to) { bytes_.resize(4 + (bytes_.size() - 4 + to - 1) / to * to); }

  template <class T>
  void write(const T& value) {
    if constexpr (Message<T>) {
      T::fields(value, *this);
    } else {
      static_assert(std::is_arithmetic_v<T>);
      align(sizeof(T));
      raw(&value, sizeof(T));
    }
  }
  void write(const std::string& text) {
    write(static_cast<std::uint32_t>(text.size() + 1));
    raw(text.c_str(), text.size() + 1);
  }
  template <class T>
  void write(const std::vector<T>& values) {
    write(static_cast<std::uint32_t>(values.size()));
    write_all(std::span<const T>(values));
  }
  template <class T, std::size_t n>
  void write(const std::array<T, n>& values) {
    write_all(std::span<const T>(values));
  }
  template <class T>
  void write_all(std::span<const T> values) {
    if constexpr (std::is_arithmetic_v<T>) {
      if (values.empty()) return;  // what is not there is not aligned either
      align(sizeof(T));
      raw(values.data(), values.size_bytes());
    } else {
      for (const T& value : values) write(value);
    }
  }

  std::vector<std::byte> bytes_;
};

/// Reads what anybody may have sent: never beyond the bytes, and no more memory than they justify.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::byte> bytes) : bytes_(bytes) {
    const bool is_plain = bytes.size() >= 4 && bytes[0] == std::byte{0} && bytes[1] <= std::byte{1};
    if (!is_plain) {
      ok_ = false;
      return;
    }
    is_swapped_ = bytes[1] == std::byte{0};
    bytes_ = bytes.subspan(4);
  }

  template <class T>
  void operator()(std::string_view /*name*/, T& value) {
    read(value);
  }
  /// All was there, and nothing follows but what fills the last four bytes.
  bool is_whole() const { return ok_ && bytes_.size() - at_ < 4; }

 private:
  const std::byte* take(std::size_t count) {
    if (!ok_ || count > bytes_.size() - at_) {
      ok_ = false;
      return nullptr;
    }
    const std::byte* const here = bytes_.data() + at_;
    at_ += count;
    return here;
  }
  void align(std::size_t to) { take((to - at_ % to) % to); }

  template <class T>
  void read(T& value) {
    if constexpr (Message<T>) {
      T::fields(value, *this);
    } else if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = 0;
      read(byte);
      ok_ = ok_ && byte <= 1;
      value = byte == 1;
    } else {
      static_assert(std::is_arithmetic_v<T>);
      align(sizeof(T));
      read_all(std::span<T>(&value, 1));
    }
  }
  void read(std::string& text) {
    std::uint32_t size = 0;
    read(size);
    const auto* const characters = reinterpret_cast<const char*>(take(size));
    ok_ = ok_ && size > 0 && std::memchr(characters, 0, size) == characters + size - 1;
    if (ok_) text.assign(characters, size - 1);
  }
  template <class T>
  void read(std::vector<T>& values) {
    std::uint32_t count = 0;
    read(count);
    values.clear();
    if constexpr (std::is_arithmetic_v<T>) {
      if (count > 0) align(sizeof(T));
      if (!ok_ || count > (bytes_.size() - at_) / sizeof(T)) {
        ok_ = false;
        return;
      }
      values.resize(count);
      read_all(std::span<T>(values));
    } else {
      // Each takes at least one byte, so it ends when they do, whatever the count says.
      for (std::uint32_t i = 0; i < count && ok_; ++i) read(values.emplace_back());
    }
  }
  /// A look at the bytes themselves.
  void read(std::span<const std::uint8_t>& values) {
    std::uint32_t count = 0;
    read(count);
    const auto* const begin = reinterpret_cast<const std::uint8_t*>(take(count));
    values = ok_ ? std::span(begin, count) : std::span<const std::uint8_t>();
  }
  template <class T, std::size_t n>
  void read(std::array<T, n>& values) {
    align(sizeof(T));
    read_all(std::span<T>(values));
  }
  /// Aligned already.
  template <class T>
  void read_all(std::span<T> values) {
    static_assert(std::is_arithmetic_v<T>);
    const std::byte* const from = take(values.size_bytes());
    if (from == nullptr || values.empty()) return;
    std::memcpy(values.data(), from, values.size_bytes());
    if (!is_swapped_ || sizeof(T) == 1) return;
    for (T& value : values) {
      std::array<std::byte, sizeof(T)> swapped;
      std::memcpy(swapped.data(), &value, sizeof(T));
      std::ranges::reverse(swapped);
      std::memcpy(&value, swapped.data(), sizeof(T));
    }
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true, is_swapped_ = false;
};

}  // namespace tassilo
