// Any bytes are odometry or refused with an Error; what was read answers at each of its times with the first sample of
// that time, and between them whatever the order of other samples.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/frames_file.h"
#include "tassilo/files/odometry_file.h"

namespace {

/// What of them are stamps of frames reads back to the last bit.
void stamps(const std::string& file) {
  using namespace tassilo;
  try {
    FrameStampReader reader(file);
    while (const auto stamp = reader.next()) {
      const std::string line = frame_stamp_line(*stamp);
      expects(line.find('\n') == std::string::npos, "a stamp is one line");
    }
  } catch (const Error&) {
  }
}

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
  stamps(file_with(data, size));
  try {
    for (const OdometryLine& line : read_odometry_lines(file_with(data, size)))
      expects(read_odometry_line(odometry_line(line), "again") == line, "a written line reads back equal");
    const auto samples = read_odometry(file_with(data, size));
    Odometry odometry(samples.size() + 2), in_order(samples.size() + 2);
    std::map<double, OdometrySample> first;
    for (const OdometrySample& sample : samples)
      expects((odometry.add(sample) == Added::duplicate) == !first.emplace(sample.t, sample).second,
              "each time is there once");
    const SequenceCounts& counts = odometry.counts();
    expects(odometry.size() == first.size() && counts.added + counts.duplicates == std::ssize(samples) &&
                counts.out_of_order <= counts.added && counts.too_late == 0,
            "what was read is there or was counted");
    for (const auto& [t, sample] : first) in_order.add(sample);
    for (const auto& [t, sample] : first) {
      const auto seen = odometry.at(t);
      expects(seen && seen->x == sample.x && seen->y == sample.y, "a sample is found at its own time");
      expects(odometry.at(t + 0.05).has_value() == in_order.at(t + 0.05).has_value(), "order makes no difference");
    }
  } catch (const Error&) {
  }
  return 0;
}
