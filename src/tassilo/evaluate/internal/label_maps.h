#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "tassilo/evaluate/evaluate.h"

namespace tassilo {

/// Pixels counted [true label][found label], 0..8, row by row as ColorScore::confusion.
using Confusion = std::array<std::array<std::int64_t, 9>, 9>;

ColorScore color_score(const Confusion& confusion, std::int64_t maps, std::int64_t missing);
/// Compares all label maps of a folder. A missing map counts as no_color everywhere; if all are missing: Error.
ColorScore score_label_maps(const EvaluateOptions::LabelMaps& folders);
/// All pixels as one.
ColorScore pooled(const Named<ColorScore>& sets);

}  // namespace tassilo
