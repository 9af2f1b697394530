#include "tassilo/app/recording_api.h"

#include <nlohmann/json.hpp>

#include "tassilo/base/error.h"
#include "tassilo/files/json.h"

namespace tassilo {
namespace {}  // namespace

nlohmann::json recording_json(const RecordingState& state) {
  return {{"on", state.on},           {"finishing", state.finishing}, {"folder", state.folder}, {"name", state.name},
          {"parts", state.parts},     {"seconds", state.seconds},     {"frames", state.frames}, {"bytes", state.bytes},
          {"dropped", state.dropped}, {"trouble", state.trouble}};
}

WebResponse answer_recording(Recorder& recorder, const WebRequest& request) {
  bool on = false;
  if (request.method == "PUT") {
    try {
      on = parse_json(request.body, "request").map({"on"}).at("on").boolean();
    } catch (const Error& error) {
      return refusal(400, error.what());
    }
    try {
      on ? recorder.start() : recorder.stop();
    } catch (const Error& error) {
      return refusal(409, error.what());
    }
  } else if (request.method != "GET" && request.method != "HEAD") {
    return refusal(405, "the recording is read by GET, begun and ended by PUT");
  }
  const nlohmann::json json = recording_json(recorder.state());
  return {200, "application/json", json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

}  // namespace tassilo
