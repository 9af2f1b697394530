#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/color/train.h"
#include "tassilo/files/samples_file.h"

namespace tassilo {

/// A sample that somebody draws in a picture, which has a name of its own there.
struct DraftSample {
  std::string image;
  ColorClass color = ColorClass::no_color;
  SampleShape shape;
  friend bool operator==(const DraftSample&, const DraftSample&) = default;
};

/// All that a color table is trained from, as a browser sends it.
struct TrainingDraft {
  std::int64_t version = 0;  ///< That was changed.
  std::vector<DraftSample> samples;
  TrainingOptions options;
};

/// Reads {"version": 3, "samples": [{"image": "2", "class": "green", "polygon": [..]}, ..], "options": {"closing_px":
/// 7}, "brightness": {"green": [40, 180]}}; see docs/files.md for shapes. Options that are missing have their default.
/// At most 1000 samples. Throws Error saying what is wrong where.
TrainingDraft draft_from_json(std::string_view text, std::string_view place);
/// One sample as such a draft has it: {"image": ..}.
std::string draft_sample_json(const DraftSample& sample);

}  // namespace tassilo
