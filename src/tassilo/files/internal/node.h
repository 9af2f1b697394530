#pragma once

#include <memory>
#include <string>
#include <vector>

namespace tassilo {

/// One value of a parsed file and all below it. Depth is bounded by TreeBuilder, so recursion over it is safe.
struct Node {
  enum class Kind { null, scalar, list, map };
  struct Key {
    std::string text;
    int line = 0, column = 0;
  };

  Kind kind = Kind::null;
  std::string text;            ///< Of a scalar.
  bool quoted = false;         ///< The scalar stood in quotes.
  int line = 0, column = 0;    ///< 1-based; column 0: not known.
  std::vector<Key> keys;       ///< Of a map, one for each child.
  std::vector<Node> children;  ///< Of a list or a map.
};

struct Tree {
  std::string file;             ///< As messages name it.
  bool strings_quoted = false;  ///< JSON: a string stands in quotes, and only there.
  Node root;

  std::string place(int line, int column) const;
};

/// Makes a Tree from parser events; refuses what no project file has: too deep or too many values, duplicate keys, keys
/// that are no names. Throws Error with file, line and column.
class TreeBuilder {
 public:
  explicit TreeBuilder(std::string file, bool strings_quoted);

  void open(Node::Kind kind, int line, int column);  ///< A list or a map begins.
  void close();                                      ///< It ends.
  void value(Node node);                             ///< A null or a scalar; in a map: key, value, key, value...
  bool finished() const { return finished_; }
  /// The finished tree.
  std::shared_ptr<const Tree> take();

 private:
  struct Level {
    Node node;
    bool key_pending = false;
  };
  void count(int line, int column);
  void attach(Node node);
  void check_unique_keys(const Node& map) const;

  std::shared_ptr<Tree> tree_;
  std::vector<Level> levels_;
  std::size_t values_ = 0;
  bool finished_ = false;
};

}  // namespace tassilo
