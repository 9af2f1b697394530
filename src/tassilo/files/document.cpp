#include "tassilo/files/document.h"

#include <algorithm>

#include "tassilo/base/error.h"
#include "tassilo/files/internal/node.h"
#include "tassilo/files/nearest_name.h"

namespace tassilo {
namespace {

std::string described(const Node& node) {
  switch (node.kind) {
    case Node::Kind::list:
      return "is a list";
    case Node::Kind::map:
      return "is a map";
    case Node::Kind::scalar:
      return "is " + shown(node.text);
    case Node::Kind::null:
      break;
  }
  return "is empty";
}

void check_keys(const Tree& tree, const Node& map, std::span<const std::string_view> known) {
  for (const Node::Key& key : map.keys) {
    if (std::ranges::find(known, std::string_view(key.text)) != known.end()) continue;
    const auto near = nearest_name(key.text, known);
    throw Error(tree.place(key.line, key.column), "unknown key " + shown(key.text) + ", must be " + joined(known) +
                                                      (near ? "; did you mean " + std::string(*near) + "?" : ""));
  }
}

}  // namespace

Value::Value(std::shared_ptr<const Tree> tree, const Node* node, std::string name)
    : tree_(std::move(tree)), node_(node), name_(std::move(name)) {}

bool Value::is_null() const { return node_->kind == Node::Kind::null; }
bool Value::is_list() const { return node_->kind == Node::Kind::list; }
bool Value::is_map() const { return node_->kind == Node::Kind::map; }

Map Value::map(std::initializer_list<std::string_view> known) const {
  const Map map = any_map();
  check_keys(*tree_, *node_, {known.begin(), known.size()});
  return map;
}

Map Value::any_map() const {
  if (!is_map()) fail_kind("must be a map");
  return Map(tree_, node_, name_);
}

std::vector<Value> Value::list(std::size_t min, std::size_t max) const {
  if (!is_list()) fail_kind("must be a list");
  const std::size_t count = node_->children.size();
  if (count < min || count > max) {
    const std::string must = min == max ? std::to_string(min)
                             : max == std::numeric_limits<std::size_t>::max()
                                 ? "at least " + std::to_string(min)
                                 : std::to_string(min) + " to " + std::to_string(max);
    fail("has " + std::to_string(count) + " values, must have " + must);
  }
  std::vector<Value> values;
  values.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    values.emplace_back(tree_, &node_->children[i], name_ + "[" + std::to_string(i) + "]");
  return values;
}

std::vector<double> Value::numbers(std::size_t count) const {
  std::vector<double> numbers;
  for (const Value& value : list(count, count)) numbers.push_back(value.number());
  return numbers;
}

std::string Value::string() const {
  if (node_->kind != Node::Kind::scalar || (tree_->strings_quoted && !node_->quoted)) fail_kind("must be a text");
  if (node_->text.empty()) fail("is empty, must be a text");
  return node_->text;
}

std::filesystem::path Value::path(const std::filesystem::path& base) const {
  const std::string text = string();
  if (std::ranges::any_of(text, [](unsigned char c) { return c < 32; }))
    fail("is " + shown(text) + ", must be a file name");
  return base / text;
}

Setting Value::setting() const {
  if (node_->kind != Node::Kind::scalar) fail_kind("must be one value");
  return {place(), name_, node_->text, node_->quoted};
}

double Value::number(double low, double high) const {
  if (node_->kind != Node::Kind::scalar) fail_kind("must be a finite number");
  return setting().number(low, high);
}
double Value::positive() const {
  if (node_->kind != Node::Kind::scalar) fail_kind("must be a finite number");
  return setting().positive();
}
std::int64_t Value::integer(std::int64_t low, std::int64_t high) const {
  if (node_->kind != Node::Kind::scalar) fail_kind("must be a whole number");
  return setting().integer(low, high);
}
bool Value::boolean() const {
  if (node_->kind != Node::Kind::scalar) fail_kind("must be true or false");
  return setting().boolean();
}
std::size_t Value::choice(std::span<const std::string_view> names) const {
  if (node_->kind != Node::Kind::scalar || (tree_->strings_quoted && !node_->quoted))
    fail_kind("must be " + joined(names));
  Setting plain = setting();
  plain.quoted = false;  // only names that need no quotes are asked for, so messages need not show them
  return plain.choice(names);
}

std::string Value::place() const { return tree_->place(node_->line, node_->column); }
int Value::line() const { return node_->line; }

void Value::fail(const std::string& reason) const {
  throw Error(place(), name_.empty() ? reason : name_ + " " + reason);
}
void Value::fail_kind(const std::string& must) const { fail(described(*node_) + ", " + must); }

Map::Map(std::shared_ptr<const Tree> tree, const Node* node, std::string name)
    : tree_(std::move(tree)), node_(node), name_(std::move(name)) {}

Value Map::at(std::string_view key) const {
  if (auto value = find(key)) return *std::move(value);
  throw Error(tree_->place(node_->line, node_->column), "key '" + child_name(key) + "' is missing");
}

std::optional<Value> Map::find(std::string_view key) const {
  const auto found = std::ranges::find(node_->keys, key, &Node::Key::text);
  if (found == node_->keys.end()) return std::nullopt;
  return Value(tree_, &node_->children[static_cast<std::size_t>(found - node_->keys.begin())], child_name(key));
}

std::vector<std::pair<std::string, Value>> Map::entries() const {
  std::vector<std::pair<std::string, Value>> entries;
  for (std::size_t i = 0; i < node_->keys.size(); ++i) {
    const std::string& key = node_->keys[i].text;
    entries.emplace_back(key, Value(tree_, &node_->children[i], child_name(key)));
  }
  return entries;
}

Value Map::value() const { return Value(tree_, node_, name_); }

std::string Map::child_name(std::string_view key) const {
  return name_.empty() ? std::string(key) : name_ + "." + std::string(key);
}

}  // namespace tassilo
