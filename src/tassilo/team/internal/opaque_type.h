#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tassilo::internal {

/// What a type of ours has thrown away; outlives it.
struct OpaqueCounts {
  std::atomic<std::int64_t> refused = 0;
};

/// A type of messages whose content the middleware does not look at; without keys, as all of ROS 2.
/// The caller owns it until dds_create_topic_sertype succeeds.
ddsi_sertype* make_opaque_type(const std::string& type_name, std::size_t max_bytes);
std::shared_ptr<const OpaqueCounts> counts_of(const ddsi_sertype* type);

/// A message to write, with its encapsulation header, which is at least there; `number` counts the writer's messages.
ddsi_serdata* make_opaque_data(const ddsi_sertype* type, std::span<const std::byte> data, std::int64_t number);

struct OpaqueContent {
  std::vector<std::byte> data;
  std::int64_t arrival_ns = 0;
  std::int64_t number = 0;  ///< In its writer's count; 0: unknown.
};
/// What a message holds; the data must be of an opaque type.
OpaqueContent content_of(const ddsi_serdata* data);

}  // namespace tassilo::internal
