#include "tassilo/evaluate/internal/single_images.h"

#include <algorithm>
#include <set>

#include "tassilo/base/error.h"
#include "tassilo/evaluate/internal/boxes.h"
#include "tassilo/evaluate/internal/pose_judgement.h"
#include "tassilo/evaluate/internal/records.h"
#include "tassilo/evaluate/internal/statistics.h"

namespace tassilo {
namespace {

using ImageScenes = std::map<std::string, std::vector<ReportedScene>>;

/// Images to leave out: as asked for, and those of the training samples.
std::set<std::string> excluded_images(const EvaluateOptions::BallImages& options, const std::set<std::string>& images) {
  std::set<std::string> out;
  for (const std::string& name : options.exclude) {
    if (!images.contains(name)) throw Error("excluded image", name + " is not in " + options.balls.string());
    out.insert(name);
  }
  if (options.exclude_samples) {
    for (const std::string& name : read_sample_images(*options.exclude_samples))
      if (images.contains(name)) out.insert(name);
  }
  return out;
}

bool on_ignored(const ScoreBox& ball, const TrueBallImage& image) {
  return std::ranges::any_of(
      image.ignore, [&](const ScoreBox& box) { return same_ball(ball, box) || contains(box, box_center(ball)); });
}

void add_image(BallImageScore& score, const TrueBallImage& image, const ReportedScene* scene) {
  static const std::vector<ReportedBall> none;
  std::vector<ScoreBox> left = image.balls;
  std::int64_t found = 0, reported = 0;
  for (const ReportedBall& ball : scene ? scene->balls : none) {
    const auto same = std::ranges::find_if(left, [&](const ScoreBox& box) { return same_ball(ball.box, box); });
    if (same == left.end() && on_ignored(ball.box, image)) continue;
    const bool best = reported++ == 0;
    if (same == left.end()) {
      score.wrong.push_back({image.image, ball.box, best});
      continue;
    }
    ++found;
    score.found_best += best;
    left.erase(same);
  }
  ++score.images;
  if (!scene) score.missing.push_back(image.image);
  score.balls += static_cast<std::int64_t>(image.balls.size());
  score.found += found;
  score.reported += reported;
  score.reported_best += reported > 0;
  for (const ScoreBox& box : left) score.missed.push_back({image.image, box, false});
}

PoseImageScore score_poses(const std::vector<const TrueImagePose*>& chosen, const ImageScenes& scenes) {
  PoseImageScore score;
  Numbers position, heading;
  Tally wrong;
  for (const TrueImagePose* truth : chosen) {
    ++score.images;
    const auto draws = scenes.find(truth->image);
    if (draws == scenes.end()) {
      ++score.images_missing;
      continue;
    }
    score.draws += static_cast<std::int64_t>(draws->second.size());
    const auto poses_before = score.poses;
    for (const ReportedScene& scene : draws->second) {
      if (!scene.pose) continue;
      const PoseJudgement judged = judge_pose(*scene.pose, truth->pose);
      position.push_back(judged.position_m);
      heading.push_back(judged.heading_deg);
      wrong.add(judged.wrong);
      ++score.poses;
    }
    score.images_with_pose += score.poses > poses_before;
  }
  score.position_m = spread(position);
  score.heading_deg = spread(heading);
  score.wrong = wrong.share();
  return score;
}

}  // namespace

BallImageScore score_ball_images(const EvaluateOptions::BallImages& options) {
  const auto truth = read_ball_images(options.balls);
  const ImageScenes scenes = read_image_scenes(options.scenes);
  std::set<std::string> images;
  for (const TrueBallImage& image : truth)
    if (!images.insert(image.image).second)
      throw Error(options.balls.string(), "image " + image.image + " appears twice");
  const auto excluded = excluded_images(options, images);

  BallImageScore score;
  std::int64_t with_balls = 0;
  for (const TrueBallImage& image : truth) {
    if (excluded.contains(image.image)) continue;
    const auto lines = scenes.find(image.image);
    if (lines != scenes.end() && lines->second.size() > 1)
      throw Error(lines->second[1].place, "image " + image.image + " appears twice, must be one line an image");
    add_image(score, image, lines == scenes.end() ? nullptr : &lines->second[0]);
    with_balls += !image.balls.empty();
  }
  score.excluded = static_cast<std::int64_t>(excluded.size());
  for (const auto& [name, lines] : scenes)
    if (!images.contains(name)) score.unknown.push_back(name);
  score.recall_best = ratio(score.found_best, with_balls);
  score.recall_any = ratio(score.found, score.balls);
  score.precision_best = ratio(score.found_best, score.reported_best);
  score.precision_all = ratio(score.found, score.reported);
  return score;
}

Named<PoseImageScore> score_pose_images(const EvaluateOptions::PoseImages& options) {
  const auto truth = read_image_poses(options.poses);
  const ImageScenes scenes = read_image_scenes(options.scenes);
  // Known qualities from best to worst, then any others by name.
  std::vector<std::string> qualities{"static", "good", "fair", "poor"};
  std::set<std::string> there;
  for (const TrueImagePose& pose : truth) there.insert(pose.quality);
  std::erase_if(qualities, [&](const std::string& quality) { return there.erase(quality) == 0; });
  qualities.insert(qualities.end(), there.begin(), there.end());

  Named<PoseImageScore> out;
  std::vector<const TrueImagePose*> all;
  for (const std::string& quality : qualities) {
    std::vector<const TrueImagePose*> chosen;
    for (const TrueImagePose& pose : truth)
      if (pose.quality == quality) chosen.push_back(&pose);
    out.emplace_back(quality, score_poses(chosen, scenes));
    all.insert(all.end(), chosen.begin(), chosen.end());
  }
  out.emplace_back("all", score_poses(all, scenes));
  return out;
}

}  // namespace tassilo
