#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/color/quality.h"
#include "tassilo/files/colors_history.h"
#include "tassilo/files/training_draft.h"
#include "tassilo/image/frame.h"

namespace tassilo {

/// Where a training is kept.
struct TrainingFiles {
  std::filesystem::path colors;   ///< colors.yaml; empty: there is none to be written.
  std::filesystem::path samples;  ///< samples.yaml; need not exist.
  /// A folder for pictures of the camera, made when the first is written.
  std::filesystem::path images() const { return samples.parent_path() / (samples.stem().string() + "_images"); }
};
/// The samples file that belongs to a colors file when nobody named one: samples.yaml beside it.
TrainingFiles training_files(const std::filesystem::path& colors, const std::filesystem::path& samples);

/// A color table while somebody draws it: pictures, samples, what they make, and what was saved before.
///
/// A draft is replaced as a whole; who changes it says which version was changed, so that two browsers do not undo each
/// other's work. Nothing is written before `save`. What cannot be done throws Error with the reason, and changes
/// nothing.
///
/// threads  any; one call at a time does something, quality is measured in a thread of its own
class TrainingSession {
 public:
  /// Reads the samples file and its images, where there is one, and the parameters that the colors file was trained
  /// with. What is wrong with them is in `refusal`, and nothing can be saved: what could not be read is not replaced.
  /// range  of the frames that are to be classified
  TrainingSession(TrainingFiles files, ColorRange range);
  ~TrainingSession();
  TrainingSession(const TrainingSession&) = delete;
  TrainingSession& operator=(const TrainingSession&) = delete;

  /// A picture to draw in.
  struct Image {
    std::string id, name;
    std::shared_ptr<const std::string> bytes;  ///< See frame_bytes.
    std::filesystem::path file;                ///< Empty until it is saved.
    std::int64_t frame = 0;                    ///< In the file.
  };
  struct State {
    std::int64_t version = 0;
    bool is_saved = true;
    ColorRange range = ColorRange::limited;
    TrainingFiles files;
    std::string refusal;
    std::vector<Image> images;
    std::vector<DraftSample> samples;
    TrainingOptions options;
    std::vector<FormerColors> history;
  };
  State state() const;
  const TrainingFiles& files() const { return files_; }

  /// Keeps a picture. Throws Error when there are too many: 64, or 256 MB.
  Image add_image(std::shared_ptr<const std::string> bytes);
  /// Nothing when there is no such picture.
  std::optional<Image> image(const std::string& id) const;
  /// False when there is no such picture. Throws Error when it has samples.
  bool remove_image(const std::string& id);

  /// What the draft makes.
  struct Result {
    std::int64_t version = 0;
    ColorTable table;
    std::vector<std::shared_ptr<const ColorSample>> samples;  ///< Of the draft, in its order, with their pixels.
    std::vector<std::string> warnings;
  };
  /// Takes the draft and trains. Throws Error when it is made of another version than this one is at, when a picture is
  /// not there, a mask is not one of the samples file, or all samples together have more than 20 million pixels. Costs
  /// the training, some 10 ms.
  Result set_draft(TrainingDraft draft);
  Result result() const;

  struct JudgedQuality {
    std::optional<std::int64_t> version;  ///< That was judged last.
    bool is_running = false;              ///< Something newer is being judged, or will be.
    ColorQuality quality;
  };
  JudgedQuality quality() const;

  /// Writes pictures with samples, samples and table. Throws Error when there is a refusal, the version is another one,
  /// or something cannot be written; the files that were written until then are whole, each for itself.
  void save(std::int64_t version, const std::string& notes);
  /// Makes a table of the history the colors file's. False when it is not there. Throws Error when it is broken, or
  /// cannot be written.
  bool restore(const std::string& id);

 private:
  struct Drawn;  ///< A sample with its pixels.

  void load_samples_file();
  void load_parameters();
  std::size_t index_of(const std::string& image) const;
  std::shared_ptr<const Drawn> drawn(const DraftSample& sample) const;
  void train();
  std::vector<std::string> warnings() const;
  std::string classes_without_samples() const;
  std::vector<ColorSample> copied_samples() const;
  static void check_pixels(const std::vector<std::shared_ptr<const Drawn>>& samples);
  void keep_present_table(const std::string& now);
  void keep_present_samples(const std::string& now) const;
  void note_table(const ColorsFile& colors);
  void write_images(const std::string& now);
  void judge();

  const TrainingFiles files_;
  const ColorRange range_;
  mutable std::mutex mutex_;  ///< Guards all below.
  std::condition_variable changed_;
  std::vector<ColorClass> in_file_;     ///< Classes of the colors file that is there.
  std::string trained_from_;            ///< The samples that it names.
  std::string refusal_, samples_text_;  ///< What the samples file said when it was read or written.
  std::vector<Image> images_;
  std::int64_t next_image_ = 1;
  std::vector<DraftSample> masks_;  ///< Of the samples file; no browser may name others.
  std::int64_t version_ = 0, saved_version_ = 0;
  std::vector<std::shared_ptr<const Drawn>> draft_;
  TrainingOptions options_;
  IncrementalTraining trained_;
  ColorTable table_;
  std::optional<std::int64_t> judged_version_;
  ColorQuality quality_;
  std::vector<FormerColors> history_;  ///< As of the last time that it changed from here.
  bool ending_ = false;
  std::thread judge_;  ///< Last: it uses all of the above.
};

}  // namespace tassilo
