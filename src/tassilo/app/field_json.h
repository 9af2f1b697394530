#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tassilo/field/field_model.h"

namespace tassilo {

/// With the keys of a field file, as far as a view of the field wants them.
nlohmann::json field_json(const FieldModel& field);

}  // namespace tassilo
