#pragma once

#include <cstdint>

#include "tassilo/color/color_table.h"
#include "tassilo/sim/renderer.h"

namespace tassilo {

struct TrainedHall {
  ColorTable colors;
  double quality = 0;  ///< Share of the stills' pixels that a table of the other stills classifies right. 0..1
};

/// Colors of a hall, from rendered stills all over the field: what a team does in the hour before a match. Some
/// seconds; the same seed, the same table.
TrainedHall train_on_stills(Renderer& renderer, const FieldModel& field, std::uint64_t seed);

}  // namespace tassilo
