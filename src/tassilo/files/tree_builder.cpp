#include <algorithm>
#include <numeric>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/internal/node.h"
#include "tassilo/files/setting.h"

namespace tassilo {
namespace {

constexpr std::size_t kMaxDepth = 32;          // the deepest project file has 5
constexpr std::size_t kMaxValues = 2'000'000;  // bounds the memory to some hundred MB

}  // namespace

std::string Tree::place(int line, int column) const {
  std::string text = file;
  if (line > 0) text.append(":").append(std::to_string(line));
  if (column > 0) text.append(":").append(std::to_string(column));
  return text;
}

TreeBuilder::TreeBuilder(std::string file, bool strings_quoted) : tree_(std::make_shared<Tree>()) {
  tree_->file = std::move(file);
  tree_->strings_quoted = strings_quoted;
}

void TreeBuilder::open(Node::Kind kind, int line, int column) {
  count(line, column);
  if (!levels_.empty() && levels_.back().node.kind == Node::Kind::map && !levels_.back().key_pending)
    throw Error(tree_->place(line, column), "a key is a list or a map, must be a name");
  if (levels_.size() == kMaxDepth)
    throw Error(tree_->place(line, column), "is nested deeper than " + std::to_string(kMaxDepth) + " levels");
  Level level;
  level.node.kind = kind;
  level.node.line = line;
  level.node.column = column;
  levels_.push_back(std::move(level));
}

void TreeBuilder::close() {
  expects(!levels_.empty(), "TreeBuilder: close after open");
  Node node = std::move(levels_.back().node);
  levels_.pop_back();
  if (node.kind == Node::Kind::map) check_unique_keys(node);
  attach(std::move(node));
}

void TreeBuilder::value(Node node) {
  count(node.line, node.column);
  if (!levels_.empty() && levels_.back().node.kind == Node::Kind::map && !levels_.back().key_pending) {
    if (node.kind == Node::Kind::null)
      throw Error(tree_->place(node.line, node.column), "a key is empty, must be a name");
    levels_.back().node.keys.push_back({std::move(node.text), node.line, node.column});
    levels_.back().key_pending = true;
    return;
  }
  if (node.kind == Node::Kind::null && !levels_.empty() && levels_.back().node.kind == Node::Kind::map) {
    node.line = levels_.back().node.keys.back().line;  // nothing stands nowhere: its key is the place to look at
    node.column = levels_.back().node.keys.back().column;
  }
  attach(std::move(node));
}

std::shared_ptr<const Tree> TreeBuilder::take() {
  expects(finished_, "TreeBuilder: the tree is finished");
  return std::move(tree_);
}

void TreeBuilder::count(int line, int column) {
  if (++values_ > kMaxValues)
    throw Error(tree_->place(line, column),
                "has more than " + std::to_string(kMaxValues) + " values, which is the limit");
}

void TreeBuilder::attach(Node node) {
  if (levels_.empty()) {
    tree_->root = std::move(node);
    finished_ = true;
    return;
  }
  levels_.back().node.children.push_back(std::move(node));
  levels_.back().key_pending = false;
}

void TreeBuilder::check_unique_keys(const Node& map) const {
  std::vector<std::size_t> order(map.keys.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) -> const std::string& { return map.keys[i].text; });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Node::Key &first = map.keys[order[i - 1]], &second = map.keys[order[i]];
    if (first.text == second.text)
      throw Error(tree_->place(second.line, second.column),
                  "key " + shown(second.text) + " appears twice, first at " + tree_->place(first.line, first.column));
  }
}

}  // namespace tassilo
