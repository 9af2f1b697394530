#pragma once

#include <functional>

#include "tassilo/app/calibration_session.h"
#include "tassilo/web/http.h"

namespace tassilo {

/// Answers what begins with /api/calibration, as openapi.yaml says. Who asks looks on, see `watched`.
///
/// take_over   has the run use the camera file that was just written; throws Error when it is refused
WebResponse answer_calibration(CalibrationSession& session, const WebRequest& request,
                               const std::function<void()>& take_over);

}  // namespace tassilo
