#include "tassilo/files/json.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/files/internal/node.h"

namespace tassilo {
namespace {

/// Builds our own tree, because nlohmann's silently keeps the last of several equal keys.
class Handler final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit Handler(std::string_view place) : place_(place), builder_(place_, true) {}

  bool null() override { return add(Node::Kind::null, ""); }
  bool boolean(bool value) override { return add(Node::Kind::scalar, value ? "true" : "false"); }
  bool number_integer(number_integer_t value) override { return add(Node::Kind::scalar, std::to_string(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add(Node::Kind::scalar, std::to_string(value)); }
  bool number_float(number_float_t, const string_t& text) override { return add(Node::Kind::scalar, text); }
  bool string(string_t& value) override { return add(Node::Kind::scalar, std::move(value), true); }
  bool key(string_t& value) override { return string(value); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Node::Kind::map); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(Node::Kind::list); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, const std::string& token, const nlohmann::json::exception&) override {
    throw Error(place_, "is no valid JSON at character " + std::to_string(position) + ", near " + shown(token));
  }

  TreeBuilder& builder() { return builder_; }

 private:
  bool add(Node::Kind kind, std::string text, bool quoted = false) {
    Node node;
    node.kind = kind;
    node.text = std::move(text);
    node.quoted = quoted;
    builder_.value(std::move(node));
    return true;
  }
  bool open(Node::Kind kind) {
    builder_.open(kind, 0, 0);
    return true;
  }
  bool close() {
    builder_.close();
    return true;
  }

  std::string place_;
  TreeBuilder builder_;
};

}  // namespace

Value parse_json(std::string_view text, std::string_view place) {
  Handler handler(place);
  nlohmann::json::sax_parse(text.begin(), text.end(), &handler);
  auto tree = handler.builder().take();
  const Node* root = &tree->root;
  return Value(std::move(tree), root, "");
}

}  // namespace tassilo
