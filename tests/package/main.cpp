// Uses what needs third-party libraries and what is found at run time: a shipped field, a video reader, a picture.
#include <cstdio>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/evaluate/evaluate.h"
#include "tassilo/files/field_file.h"
#include "tassilo/record/json_lines_writer.h"
#include "tassilo/source/frame_source.h"
#include "tassilo/team/bus.h"
#include "tassilo/vision/vision.h"

int main() {
  const tassilo::FieldModel field = tassilo::read_field("msl98");
  std::printf("msl98 is %.2f m long\n", field.length);
  // Links the middleware; entering a domain would need a network interface.
  if (!tassilo::Bus::complaints().empty()) return 1;
  try {
    tassilo::open_source({.location = "no such file.mkv"});
  } catch (const tassilo::Error& error) {
    std::printf("%s\n", error.what());
    return 0;
  }
  return 1;
}
