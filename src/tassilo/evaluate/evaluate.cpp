#include "tassilo/evaluate/evaluate.h"

#include <algorithm>

#include "tassilo/base/error.h"
#include "tassilo/evaluate/internal/label_maps.h"
#include "tassilo/evaluate/internal/records.h"
#include "tassilo/evaluate/internal/sequence_score.h"
#include "tassilo/evaluate/internal/single_images.h"

namespace tassilo {
namespace {

/// What a recording is called: the folder of a file with the usual name, else the file's own name.
std::string recording_name(const std::filesystem::path& file, const char* usual) {
  std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  return (path.filename() == usual ? path.parent_path().filename() : path.stem()).string();
}

/// Appends a score by name; by name and file where several are called the same.
template <class Score>
void append(Named<Score>& named, std::string name, const std::filesystem::path& file, Score score) {
  const auto taken = [&] { return std::ranges::any_of(named, [&](const auto& other) { return other.first == name; }); };
  if (taken()) name.append(1, ' ').append(file.string());
  if (taken()) throw Error(file.string(), "is given twice, must be given once");
  named.emplace_back(std::move(name), std::move(score));
}

}  // namespace

Evaluation evaluate(const EvaluateOptions& options) {
  Evaluation out;
  Samples all;
  for (const auto& [truth_file, scenes_file] : options.sequences) {
    const auto truth = read_truth(truth_file);
    const auto scenes = read_scenes(scenes_file, truth, truth_file);
    const auto beside = truth_file.parent_path() / "meta.json";
    std::optional<TrueField> field;
    if (options.meta || std::filesystem::exists(beside)) field = read_true_field(options.meta.value_or(beside));
    Samples own;
    add_sequence(own, truth, scenes, field);
    add_sequence(all, truth, scenes, field);
    append(out.sequences, recording_name(truth_file, "gt.jsonl"), scenes_file, summarize(own));
  }
  if (!options.sequences.empty()) out.overall = summarize(all);

  for (const auto& folders : options.colors)
    append(out.color_sets, recording_name(folders.labels, "labels"), folders.maps, score_label_maps(folders));
  if (!options.colors.empty()) out.colors = pooled(out.color_sets);
  if (options.balls) out.balls = score_ball_images(*options.balls);
  if (options.poses) out.poses = score_pose_images(*options.poses);
  return out;
}

}  // namespace tassilo
