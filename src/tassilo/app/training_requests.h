#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "tassilo/app/training_session.h"
#include "tassilo/web/http.h"

namespace tassilo {

/// What the training asks of the run that it belongs to.
struct TrainingRun {
  std::function<ColorTable()> table_in_use;
  /// The bytes of a frame that was shown, or else of the newest; null when none comes.
  std::function<std::shared_ptr<const std::string>(std::optional<std::int64_t> frame)> frame;
  /// Takes the colors file over that was just written. Throws Error when it is refused.
  std::function<void()> take_over;
};

/// Answers what begins with /api/training, as openapi.yaml says.
WebResponse answer_training(TrainingSession& session, const WebRequest& request, const TrainingRun& run);

}  // namespace tassilo
