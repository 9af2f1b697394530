#pragma once

#include <memory>

#include "bindings.h"
#include "tassilo/color/segment.h"
#include "tassilo/files/colors_file.h"

namespace tassilo::python {

/// What tassilo.ColorTable is: a table ready for frames, with where it comes from. Never changed.
struct Colors {
  explicit Colors(ColorsFile content) : file(std::move(content)), classifier(file.table) {}

  ColorsFile file;
  Classifier classifier;
};
using SharedColors = std::shared_ptr<Colors>;

}  // namespace tassilo::python
