#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace tassilo {

/// Team pictures of the last minutes, as they are told to browsers.
///
/// threads  one at a time
class TeamHistory {
 public:
  /// What is older, or more, is forgotten: the oldest first. [s, B], > 0
  TeamHistory(double memory_s, std::size_t memory_bytes) : memory_s_(memory_s), memory_bytes_(memory_bytes) {}

  /// Times grow; one that does not is not kept.
  void add(double t, std::shared_ptr<const std::string> picture);
  /// The newest that is not after t; null when there is none.
  std::shared_ptr<const std::string> at(double t) const;
  std::optional<double> begin() const;
  std::optional<double> end() const;

 private:
  struct Entry {
    double t = 0;
    std::shared_ptr<const std::string> picture;
  };
  double memory_s_;
  std::size_t memory_bytes_, bytes_ = 0;
  std::deque<Entry> entries_;
};

}  // namespace tassilo
