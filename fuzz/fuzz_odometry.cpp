// Any bytes are odometry or refused with an Error; what was read answers at each of its times with the sample itself.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/odometry_file.h"

namespace {

/// The bytes as a file in memory, overwritten each time: the reader wants a path.
std::string file_with(const std::uint8_t* data, std::size_t size) {
  static const int descriptor = memfd_create("odometry", 0);
  tassilo::expects(descriptor >= 0 && ftruncate(descriptor, 0) == 0, "a file in memory");
  tassilo::expects(pwrite(descriptor, data, size, 0) == static_cast<ssize_t>(size), "the file holds all bytes");
  return "/proc/self/fd/" + std::to_string(descriptor);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1 << 16) return 0;
  using namespace tassilo;
  try {
    const auto samples = read_odometry(file_with(data, size));
    Odometry odometry(samples.size() + 2);
    for (const OdometrySample& sample : samples) odometry.add(sample);
    for (const OdometrySample& sample : samples) {
      const auto seen = odometry.at(sample.t);
      expects(seen && seen->x == sample.x && seen->y == sample.y, "a sample is found at its own time");
    }
  } catch (const Error&) {
  }
  return 0;
}
