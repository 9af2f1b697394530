#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "tassilo/message/cdr.h"

namespace tassilo {

/// The message's CDR bytes with their four bytes of encapsulation. O(size).
template <Message M>
std::vector<std::byte> encoded(const M& message) {
  CdrWriter writer;
  M::fields(message, writer);
  return writer.take();
}

/// The message in these bytes, of either byte order; nothing when they are not exactly one such message. Says nothing
/// of its values, see plausible.h. Memory: a few times the bytes, whatever they claim.
template <Message M>
std::optional<M> decoded(std::span<const std::byte> bytes) {
  std::optional<M> message(std::in_place);
  CdrReader reader(bytes);
  M::fields(*message, reader);
  if (!reader.is_whole()) message.reset();
  return message;
}

/// "geometry_msgs/msg/Point", as ROS 2 and log files name it.
template <Message M>
std::string ros_type_name() {
  const std::size_t slash = M::kType.find('/');
  return std::string(M::kType.substr(0, slash)).append("/msg").append(M::kType.substr(slash));
}
/// "geometry_msgs::msg::dds_::Point_", as it is on the wire.
template <Message M>
std::string wire_type_name() {
  const std::size_t slash = M::kType.find('/');
  return std::string(M::kType.substr(0, slash)).append("::msg::dds_::").append(M::kType.substr(slash + 1)).append("_");
}

/// Writes definitions as .msg files have them, without comments.
class DefinitionWriter {
 public:
  template <class T>
  void operator()(std::string_view name, const T&) {
    own_.append(name_of<T>()).append(" ").append(name).append("\n");
  }
  template <Message M>
  void begin() {
    if constexpr (requires { M::kConstants; }) own_ += M::kConstants;
    M::fields(kExample<M>, *this);
  }
  const std::string& own() const { return own_; }
  /// The definition, and behind it those of all types it uses, each once.
  std::string whole() const {
    std::string text = own_;
    for (const auto& [type, definition] : used_) {
      text.append(80, '=').append("\nMSG: ").append(type).append("\n").append(definition);
    }
    return text;
  }

 private:
  template <class M>
  static inline const M kExample{};

  template <class T>
  struct Element {};
  template <class T>
  struct Element<std::vector<T>> {
    using Type = T;
    static std::string suffix() { return "[]"; }
  };
  template <class T, std::size_t n>
  struct Element<std::array<T, n>> {
    using Type = T;
    static std::string suffix() { return std::string("[").append(std::to_string(n)).append("]"); }
  };

  template <class T>
  std::string name_of() {
    if constexpr (requires { typename Element<T>::Type; }) {
      return name_of<typename Element<T>::Type>() + Element<T>::suffix();
    } else if constexpr (Message<T>) {
      use<T>();
      return std::string(T::kType);
    } else if constexpr (std::is_same_v<T, std::string>) {
      return "string";
    } else if constexpr (std::is_same_v<T, bool>) {
      return "bool";
    } else if constexpr (std::is_floating_point_v<T>) {
      return std::string("float").append(std::to_string(8 * sizeof(T)));
    } else {
      static_assert(std::is_integral_v<T>);
      return std::string(std::is_signed_v<T> ? "int" : "uint").append(std::to_string(8 * sizeof(T)));
    }
  }
  template <Message M>
  void use() {
    for (const auto& [type, definition] : used_)
      if (type == M::kType) return;
    DefinitionWriter inner;
    inner.begin<M>();
    used_.emplace_back(M::kType, inner.own_);
    for (auto& [type, definition] : inner.used_) {
      bool is_known = false;
      for (const auto& known : used_) is_known = is_known || known.first == type;
      if (!is_known) used_.emplace_back(type, definition);
    }
  }

  std::string own_;
  std::vector<std::pair<std::string, std::string>> used_;
};

/// The definition as log files carry it ("ros2msg"): fields, then the types they use.
template <Message M>
std::string definition() {
  DefinitionWriter writer;
  writer.begin<M>();
  return writer.whole();
}

}  // namespace tassilo
