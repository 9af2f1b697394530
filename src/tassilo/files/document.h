#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tassilo/files/setting.h"

namespace tassilo {

struct Node;
struct Tree;
class Map;

/// A look at one value of a parsed YAML or JSON file; what it points to lives as long as any Value or Map of the file.
///
/// Every reader checks: what is not as asked throws Error("file:line:column", "NAME is WHAT, must be ...").
class Value {
 public:
  Value(std::shared_ptr<const Tree> tree, const Node* node, std::string name);

  bool is_null() const;
  bool is_list() const;
  bool is_map() const;

  /// A map with no other keys than `known`.
  Map map(std::initializer_list<std::string_view> known) const;
  /// A map with any keys.
  Map any_map() const;
  /// A list of at least min and at most max values.
  std::vector<Value> list(std::size_t min = 0, std::size_t max = std::numeric_limits<std::size_t>::max()) const;
  /// A list of exactly `count` finite numbers.
  std::vector<double> numbers(std::size_t count) const;
  /// A scalar as written, not empty.
  std::string string() const;
  /// A file name: relative ones are taken from the folder `base`.
  std::filesystem::path path(const std::filesystem::path& base) const;
  /// A scalar, to be read later.
  Setting setting() const;

  double number(double low = -std::numeric_limits<double>::max(),
                double high = std::numeric_limits<double>::max()) const;
  double positive() const;
  std::int64_t integer(std::int64_t low = std::numeric_limits<std::int64_t>::min(),
                       std::int64_t high = std::numeric_limits<std::int64_t>::max()) const;
  bool boolean() const;
  std::size_t choice(std::span<const std::string_view> names) const;

  /// "file:line:column".
  std::string place() const;
  int line() const;
  /// Throws Error(place(), NAME + " " + reason).
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  [[noreturn]] void fail_kind(const std::string& must) const;

  std::shared_ptr<const Tree> tree_;
  const Node* node_;
  std::string name_;  ///< "start_pose.x", "balls[0].box"; empty for the whole file.
};

/// A look at a map whose keys were checked.
class Map {
 public:
  Map(std::shared_ptr<const Tree> tree, const Node* node, std::string name);

  /// The value of a key that must be there.
  Value at(std::string_view key) const;
  /// The value of a key, nothing when it is missing.
  std::optional<Value> find(std::string_view key) const;
  /// All, in the order of the file.
  std::vector<std::pair<std::string, Value>> entries() const;
  /// The map itself, for messages.
  Value value() const;

 private:
  std::string child_name(std::string_view key) const;

  std::shared_ptr<const Tree> tree_;
  const Node* node_;
  std::string name_;
};

}  // namespace tassilo
