#include "tassilo/files/yaml.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <sstream>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/files/internal/node.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

std::string place_of(const std::string& name, const YAML::Mark& mark) {
  if (mark.is_null()) return name;
  return name + ":" + std::to_string(mark.line + 1) + ":" + std::to_string(mark.column + 1);
}

class Handler final : public YAML::EventHandler {
 public:
  explicit Handler(const std::string& name) : name_(name), builder_(name, false) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (builder_.finished()) throw Error(place_of(name_, mark), "a second document begins, must be one only");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { builder_.value(node(Node::Kind::null, mark)); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw Error(place_of(name_, mark), "an alias (*name) stands here, must be written out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& value) override {
    check_tag(mark, tag);
    Node scalar = node(Node::Kind::scalar, mark);
    scalar.text = value;
    scalar.quoted = tag == "!";
    builder_.value(std::move(scalar));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    check_tag(mark, tag);
    builder_.open(Node::Kind::list, mark.line + 1, mark.column + 1);
  }
  void OnSequenceEnd() override { builder_.close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override {
    check_tag(mark, tag);
    builder_.open(Node::Kind::map, mark.line + 1, mark.column + 1);
  }
  void OnMapEnd() override { builder_.close(); }

  TreeBuilder& builder() { return builder_; }

 private:
  static Node node(Node::Kind kind, const YAML::Mark& mark) {
    Node node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }
  // yaml-cpp says "?" for plain values and "!" for quoted ones.
  void check_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw Error(place_of(name_, mark), "a tag " + shown(tag) + " stands here, must be a plain value");
  }

  std::string name_;
  TreeBuilder builder_;
};

}  // namespace

Value parse_yaml(std::string_view text, std::string_view name) {
  const std::string file(name);
  if (text.size() > kMaxBytes)
    throw Error(file, "has more than " + std::to_string(kMaxBytes) + " bytes, which is the limit");
  Handler handler(file);
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(handler)) {
    }
  } catch (const YAML::Exception& error) {
    throw Error(place_of(file, error.mark), "is no valid YAML: " + error.msg);
  }
  if (!handler.builder().finished()) throw Error(file, "is empty");
  auto tree = handler.builder().take();
  const Node* root = &tree->root;
  return Value(std::move(tree), root, "");
}

Value read_yaml(const std::filesystem::path& file) { return parse_yaml(read_text(file, kMaxBytes), file.string()); }

}  // namespace tassilo
