#pragma once

#include <chrono>

namespace tassilo {

/// What this machine's clock shows. [s since the UNIX epoch]
inline double unix_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// Shows the same when it is made, and then goes on evenly, whoever sets the machine's clock.
class EvenClock {
 public:
  double now() const {
    return begin_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_steady_).count();
  }

 private:
  double begin_ = unix_now();
  std::chrono::steady_clock::time_point begin_steady_ = std::chrono::steady_clock::now();
};

}  // namespace tassilo
