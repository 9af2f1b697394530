#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tassilo/app/recorder.h"
#include "tassilo/web/http.h"

namespace tassilo {

/// What programs and pages are told of it: schema Recording in openapi.yaml.
nlohmann::json recording_json(const RecordingState& state);

/// GET, and PUT of {"on": true} or {"on": false}. Any thread.
WebResponse answer_recording(Recorder& recorder, const WebRequest& request);

}  // namespace tassilo
