#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>
#include <vector>

#include "tassilo/team/bus.h"

namespace tassilo::internal {

/// A domain of the middleware, which a process enters once, however many buses it has; shared by them.
class Domain {
 public:
  /// Enters the domain, or shares it. Throws Error when it cannot be entered or is in use with other options.
  explicit Domain(const BusOptions& options);
  ~Domain();
  Domain(const Domain&) = delete;
  Domain& operator=(const Domain&) = delete;

 private:
  int number_;
};

/// The last complaints of the middleware, at most 20.
std::vector<std::string> complaints();

/// Throws Error naming the bus and what the middleware says of a failed call.
[[noreturn]] void fail(const std::string& what, dds_return_t code);

/// A handle of the middleware, given back at the end, with all that was made of it.
class Entity {
 public:
  Entity() = default;
  /// Takes over what a function of the middleware has returned. Throws Error when that is a failure.
  Entity(dds_entity_t handle, const std::string& what) : handle_(handle) {
    if (handle < 0) fail(what, handle);
  }
  ~Entity() {
    if (handle_ > 0) dds_delete(handle_);
  }
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;

  dds_entity_t get() const { return handle_; }

 private:
  dds_entity_t handle_ = 0;
};

}  // namespace tassilo::internal
