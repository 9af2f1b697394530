#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tassilo {

using McapPairs = std::vector<std::pair<std::string, std::string>>;

/// A stream of messages of one kind in a log; equal topics in two channels are two streams.
struct McapChannel {
  std::string topic{};
  std::string schema_name{};                ///< "geometry_msgs/msg/PoseWithCovarianceStamped"; empty: no schema.
  std::string definition{};                 ///< What the messages consist of, in the language of schema_encoding.
  McapPairs metadata{};                     ///< Keys differ.
  std::string schema_encoding = "ros2msg";  ///< Other programs also write "ros1msg", "jsonschema", ..
  std::string message_encoding = "cdr";     ///< How the bytes of a message are to be understood.

  bool operator==(const McapChannel&) const = default;
};

/// A named note in a log.
struct McapMetadata {
  std::string name;
  McapPairs pairs;  ///< Keys differ.

  bool operator==(const McapMetadata&) const = default;
};

}  // namespace tassilo
