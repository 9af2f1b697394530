#pragma once

#include "tassilo/evaluate/evaluate.h"

namespace tassilo {

BallImageScore score_ball_images(const EvaluateOptions::BallImages& options);
Named<PoseImageScore> score_pose_images(const EvaluateOptions::PoseImages& options);

}  // namespace tassilo
