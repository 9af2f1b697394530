#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/app/written_files.h"
#include "tassilo/color/quality.h"
#include "tassilo/color/train.h"
#include "tassilo/files/colors_file.h"
#include "tassilo/files/samples_file.h"
#include "tassilo/image/frame.h"

namespace tassilo {

/// Told of what is odd but no error: the thing, and what is odd about it.
using Warn = std::function<void(const std::string& what, const std::string& reason)>;

/// Samples read, with the range of their images.
struct LoadedSamples {
  std::vector<ColorSample> samples;
  int images = 0;                   ///< That have samples; a frame of a video is an image.
  std::vector<NamedFile> files;     ///< All that were read, the list of samples among them.
  std::optional<ColorRange> range;  ///< Nothing when there is no sample.
};

/// The pixels that a shape means in an image of this size; what is far outside of it is cut. The rim of a mask, where
/// two colors mix, is left out. Throws Error(place, ..) when a mask cannot be read or has another size.
Region sample_region(const SampleShape& shape, const FrameView& frame, const std::string& place);

/// A picture that samples were drawn in.
struct SampleImage {
  std::filesystem::path file;
  std::int64_t index = 0;       ///< In the file.
  bool is_one_of_many = false;  ///< Other frames of the file are asked for, too, or it is not the first.
  int first_line = 0;           ///< Of the samples file, that asks for the file.
  Frame frame;
};
/// Reads the images that samples name, each once: files in the order of `list`, their frames by index. `list_name` is
/// how messages call the samples file. RGB images become BT.601 in `images_range`. Throws Error with the place in the
/// samples file that asked for what cannot be read.
void for_sample_images(const std::vector<TrainingSample>& list, const std::string& list_name, ColorRange images_range,
                       const std::function<void(const SampleImage&)>& use);

/// Reads a samples file and the images it names; RGB images become BT.601 in `images_range`. Throws Error with the
/// place in the file where a sample or an image is wrong, and when it holds no samples.
LoadedSamples load_samples(const std::string& file, ColorRange images_range, const Warn& warn);

/// A table and how good it is.
struct TrainedColors {
  ColorsFile file;
  ColorQuality quality;
};

/// Samples and what messages and the provenance call them.
struct TrainingSet {
  std::string name;
  LoadedSamples loaded;
};

/// Trains a table from what load_samples or someone else brought. Quality is measured on `held_out` where that is
/// given, else by cross-validation (or is `measured`, when that is known already), and is noted in the file's
/// provenance with today's date. Throws Error naming `samples` when there is nothing to learn from, or the ranges
/// differ.
TrainedColors train_colors_file(const TrainingSet& samples, const TrainingSet* held_out, const TrainingOptions& options,
                                const Warn& warn, const ColorQuality* measured = nullptr);

}  // namespace tassilo
