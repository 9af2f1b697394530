#include "tassilo/app/training_session.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "tassilo/app/frame_bytes.h"
#include "tassilo/app/training.h"
#include "tassilo/base/error.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/kept_copies.h"
#include "tassilo/files/text.h"
#include "tassilo/record/lossless_video.h"
#include "tassilo/region/algebra.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostImages = 64;
constexpr std::size_t kMostImageBytes = 256u << 20;      // [B]
constexpr std::size_t kMostSamplesText = 1 << 20;        // as of every YAML file [B]
constexpr std::int64_t kMostPixels = 20'000'000;         // of all samples: 65 pictures of 640 x 480, 60 MB
constexpr double kMuchOverlap = 0.01;                    // share of a class's pixels that another one claims, too
constexpr auto kQuiet = std::chrono::milliseconds(250);  // a draft that changes more often is still being drawn

/// Nothing when there is no such file.
std::string text_of(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored) ? read_text(file, kMostSamplesText) : std::string();
}

/// A frame as a video of one picture that is whole or not there.
void write_still(const fs::path& file, const Frame& frame) {
  const fs::path draft = fs::path(file).replace_extension(".part.mkv");
  std::error_code ignored;
  const auto remove = [&] {
    fs::remove(draft, ignored);
    fs::remove(fs::path(draft.string() + ".frames.jsonl"), ignored);
  };
  try {
    LosslessVideo video(draft.string());
    video.write(frame);
    video.finish();
    write_atomically(file, read_text(draft, kMostImageBytes));
  } catch (...) {
    remove();
    throw;
  }
  remove();
}

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

struct TrainingSession::Drawn {
  DraftSample sample;
  Region region;  ///< Within the picture.
  std::shared_ptr<const ColorSample> pixels;
};

TrainingFiles training_files(const fs::path& colors, const fs::path& samples) {
  return {colors, !samples.empty() || colors.empty() ? samples : colors.parent_path() / "samples.yaml"};
}

TrainingSession::TrainingSession(TrainingFiles files, ColorRange range) : files_(std::move(files)), range_(range) {
  table_.range = range_;
  try {
    if (files_.colors.empty()) throw Error("colors", "no color table is named that could be written");
    load_parameters();
    history_ = read_history(files_.colors);
    load_samples_file();
  } catch (const Error& error) {
    refusal_ = error.what();
    images_.clear();
    draft_.clear();
    masks_.clear();
  }
  train();
  judge_ = std::thread([this] { judge(); });
}

TrainingSession::~TrainingSession() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  judge_.join();
}

void TrainingSession::load_parameters() {
  std::error_code ignored;
  if (!fs::exists(files_.colors, ignored)) return;
  const ColorsFile colors = read_colors(files_.colors);
  table_.priority = colors.table.priority;
  note_table(colors);
  if (!colors.trained_from) return;
  for (const TrainingNumber& number : training_numbers())
    if (const auto found = colors.trained_from->options.find(number.key); found != colors.trained_from->options.end())
      number.set(options_, found->second);
  for (const auto& [color, interval] : colors.trained_from->brightness)
    options_.brightness[static_cast<std::size_t>(class_index(color))] = interval;
}

void TrainingSession::note_table(const ColorsFile& colors) {
  in_file_.clear();
  for (const ColorClass color : kColorClasses)
    if (std::ranges::any_of(colors.table.chroma, [&](ClassBits bits) { return (bits & class_bit(color)) != 0; }))
      in_file_.push_back(color);
  trained_from_ = colors.trained_from ? colors.trained_from->samples : "";
}

void TrainingSession::load_samples_file() {
  samples_text_ = text_of(files_.samples);
  if (samples_text_.empty()) return;
  const auto list = samples_from_yaml(samples_text_, files_.samples);
  auto by_file = list;
  std::ranges::stable_sort(by_file, {}, &TrainingSample::image);
  std::map<std::pair<fs::path, std::int64_t>, std::string> ids;
  std::size_t size = 0;
  for_sample_images(by_file, files_.samples.string(), range_, [&](const SampleImage& image) {
    if (image.frame.range != range_)
      throw Error(files_.samples.string(),
                  fmt::format("{} has {} color range, what is seen now has {}; a table is for one range",
                              image.file.string(), to_string(image.frame.range), to_string(range_)));
    auto bytes = std::make_shared<const std::string>(frame_bytes(image.frame));
    size += bytes->size();
    if (images_.size() == kMostImages || size > kMostImageBytes)
      throw Error(files_.samples.string(), fmt::format("has samples in more than {} pictures or {} MB of them",
                                                       kMostImages, kMostImageBytes >> 20));
    const std::string name = image.file.filename().string();
    images_.push_back({std::to_string(next_image_++),
                       image.is_one_of_many ? fmt::format("{}, frame {}", name, image.index) : name, std::move(bytes),
                       image.file, image.index});
    ids[{image.file, image.index}] = images_.back().id;
  });
  for (const TrainingSample& sample : list) {
    const DraftSample one{ids.at({sample.image, sample.frame}), sample.color, sample.shape};
    if (std::holds_alternative<SampleMask>(one.shape)) masks_.push_back(one);
    draft_.push_back(drawn(one));
    check_pixels(draft_);
  }
}

void TrainingSession::check_pixels(const std::vector<std::shared_ptr<const Drawn>>& samples) {
  std::int64_t pixels = 0;
  for (const auto& one : samples) pixels += static_cast<std::int64_t>(one->pixels->pixels.size());
  if (pixels > kMostPixels)
    throw Error("samples", fmt::format("have {} pixels, must have at most {}", pixels, kMostPixels));
}

std::size_t TrainingSession::index_of(const std::string& image) const {
  const auto found = std::ranges::find(images_, image, &Image::id);
  return static_cast<std::size_t>(found - images_.begin());
}

std::shared_ptr<const TrainingSession::Drawn> TrainingSession::drawn(const DraftSample& sample) const {
  // What was drawn before is not looked up in the picture again.
  const auto known = std::ranges::find_if(draft_, [&](const auto& one) { return one->sample == sample; });
  if (known != draft_.end()) return *known;
  const std::size_t index = index_of(sample.image);
  if (index == images_.size())
    throw Error("samples", "one is of image '" + sample.image + "', must be one of the pictures here");
  if (std::holds_alternative<SampleMask>(sample.shape) && std::ranges::find(masks_, sample) == masks_.end())
    throw Error("samples", "one is a mask that the samples file does not have, must be drawn");
  const Frame frame = frame_of_bytes(images_[index].bytes);
  auto drawn = std::make_shared<Drawn>();
  drawn->sample = sample;
  drawn->region =
      clipped(sample_region(sample.shape, frame.view, "samples"), {0, 0, frame.view.width(), frame.view.height()});
  auto pixels = std::make_shared<ColorSample>();
  pixels->color = sample.color;
  pixels->pixels = pixels_of(frame.view, drawn->region);
  drawn->pixels = std::move(pixels);
  return drawn;
}

std::vector<ColorSample> TrainingSession::copied_samples() const {
  std::vector<ColorSample> samples;
  for (const auto& one : draft_) {
    if (one->pixels->pixels.empty()) continue;
    samples.push_back(*one->pixels);
    samples.back().group = static_cast<int>(index_of(one->sample.image));
  }
  return samples;
}

void TrainingSession::train() {
  const ClassPriority priority = table_.priority;
  std::vector<std::shared_ptr<const ColorSample>> samples;
  for (const auto& one : draft_) samples.push_back(one->pixels);
  table_ = trained_(samples, range_, options_);
  table_.priority = priority;
}

std::string TrainingSession::classes_without_samples() const {
  std::string lost;
  for (const ColorClass color : in_file_)
    if (std::ranges::none_of(draft_, [&](const auto& one) { return one->sample.color == color; }))
      lost.append(lost.empty() ? "" : ", ").append(to_string(color));
  return lost;
}

std::vector<std::string> TrainingSession::warnings() const {
  std::vector<std::string> warnings;
  ColorQuality quality;
  const Classifier classifier(table_);
  for (const auto& one : draft_) {
    add_quality(quality, classifier, {one->pixels.get(), 1});
    if (one->pixels->pixels.empty())
      warnings.push_back(fmt::format("a sample of {} has no pixel in its picture", to_string(one->sample.color)));
  }
  for (std::size_t i = 0; i < draft_.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Drawn &a = *draft_[i], &b = *draft_[k];
      if (a.sample.color == b.sample.color || a.sample.image != b.sample.image ||
          intersection(bounding_box(a.region), bounding_box(b.region)).empty())
        continue;
      if (const auto shared = area(intersection(a.region, b.region)); shared > 0)
        warnings.push_back(fmt::format("{} and {} share {} pixels of {}: one of them is drawn wrong",
                                       to_string(b.sample.color), to_string(a.sample.color), shared,
                                       images_[index_of(a.sample.image)].name));
    }
  if (std::string lost = classes_without_samples(); !lost.empty() && !draft_.empty())
    warnings.push_back(
        fmt::format("the table that is there has {}, of which there is no sample: saving this one loses them{}", lost,
                    trained_from_.empty() ? "" : "; it was trained from " + trained_from_));
  for (const ColorClass color : kColorClasses) {
    const std::int64_t pixels = quality.pixels(color);
    if (pixels > 0 &&
        std::ranges::none_of(table_.chroma, [&](ClassBits bits) { return (bits & class_bit(color)) != 0; }))
      warnings.push_back(
          fmt::format("the samples of {} have no common color: the class stays empty", to_string(color)));
    for (const ColorClass other : kColorClasses) {
      const double overlap =
          share(quality.overlap[static_cast<std::size_t>(color)][static_cast<std::size_t>(other)], pixels);
      if (overlap > kMuchOverlap)
        warnings.push_back(fmt::format("{} overlaps {}: it claims {:.1f} % of the samples of {}, too", to_string(other),
                                       to_string(color), 100 * overlap, to_string(color)));
    }
  }
  return warnings;
}

TrainingSession::State TrainingSession::state() const {
  State state;
  {
    const std::lock_guard lock(mutex_);
    state = {version_, saved_version_ == version_, range_, files_, refusal_, images_, {}, options_, history_};
    for (const auto& one : draft_) state.samples.push_back(one->sample);
  }
  return state;
}

TrainingSession::Image TrainingSession::add_image(std::shared_ptr<const std::string> bytes) {
  const Frame frame = frame_of_bytes(bytes);
  const std::lock_guard lock(mutex_);
  if (frame.range != range_)
    throw Error("picture",
                fmt::format("has {} color range, the others have {}", to_string(frame.range), to_string(range_)));
  std::size_t size = bytes->size();
  for (const Image& image : images_) size += image.bytes->size();
  if (images_.size() >= kMostImages || size > kMostImageBytes)
    throw Error("pictures",
                fmt::format("there are {} of {} MB with this one, must be at most {} and {} MB; remove some",
                            images_.size() + 1, size >> 20, kMostImages, kMostImageBytes >> 20));
  images_.push_back({std::to_string(next_image_++), fmt::format("frame {}", frame.index), std::move(bytes), {}, 0});
  return images_.back();
}

std::optional<TrainingSession::Image> TrainingSession::image(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const std::size_t index = index_of(id);
  return index < images_.size() ? std::optional(images_[index]) : std::nullopt;
}

bool TrainingSession::remove_image(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const std::size_t index = index_of(id);
  if (index == images_.size()) return false;
  if (std::ranges::any_of(draft_, [&](const auto& one) { return one->sample.image == id; }))
    throw Error(images_[index].name, "has samples; remove them first");
  images_.erase(images_.begin() + static_cast<std::ptrdiff_t>(index));
  return true;
}

TrainingSession::Result TrainingSession::set_draft(TrainingDraft draft) {
  draft.options.check();
  {
    const std::lock_guard lock(mutex_);
    if (draft.version != version_)
      throw Error("draft",
                  fmt::format("is made of version {}, must be of version {}: somebody else changed it meanwhile",
                              draft.version, version_));
    std::vector<std::shared_ptr<const Drawn>> all;
    all.reserve(draft.samples.size());
    for (const DraftSample& sample : draft.samples) {
      all.push_back(drawn(sample));
      check_pixels(all);
    }
    draft_ = std::move(all);
    options_ = draft.options;
    ++version_;
    train();
  }
  changed_.notify_all();
  return result();
}

TrainingSession::Result TrainingSession::result() const {
  const std::lock_guard lock(mutex_);
  Result result{version_, table_, {}, warnings()};
  for (const auto& one : draft_) result.samples.push_back(one->pixels);
  return result;
}

TrainingSession::JudgedQuality TrainingSession::quality() const {
  const std::lock_guard lock(mutex_);
  return {judged_version_, judged_version_ != version_, quality_};
}

void TrainingSession::judge() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ending_ || judged_version_ != version_; });
    const std::int64_t version = version_;
    if (changed_.wait_for(lock, kQuiet, [&] { return ending_ || version_ != version; })) {
      if (ending_) return;
      continue;
    }
    const std::vector<ColorSample> samples = copied_samples();
    const TrainingOptions options = options_;
    lock.unlock();
    ColorQuality quality;
    try {
      quality = cross_validate(samples, range_, options);
    } catch (const std::exception&) {  // no memory, say: nothing is known of this draft
    }
    lock.lock();
    judged_version_ = version;
    quality_ = quality;
  }
}

void TrainingSession::write_images(const std::string& now) {
  std::error_code error;
  fs::create_directories(files_.images(), error);
  if (error) throw Error(files_.images().string(), "cannot be created: " + error.message());
  for (Image& image : images_) {
    const bool is_used = std::ranges::any_of(draft_, [&](const auto& one) { return one->sample.image == image.id; });
    if (!is_used || !image.file.empty()) continue;
    const Frame frame = frame_of_bytes(image.bytes);
    fs::path file;
    for (int n = 1; file.empty() || fs::exists(file, error); ++n)
      file = files_.images() / fmt::format("{}_{}.mkv", now, n);
    write_still(file, frame);
    image.file = file;
  }
}

void TrainingSession::keep_present_table(const std::string& now) {
  std::error_code ignored;
  if (!fs::exists(files_.colors, ignored)) return;
  std::optional<ColorsFile> present;
  try {
    present = read_colors(files_.colors);
  } catch (const Error&) {  // broken, but perhaps somebody's work
    const fs::path kept = files_.colors.parent_path() / fmt::format("{}_{}.yaml", files_.colors.stem().string(), now);
    write_atomically(kept, text_of(files_.colors));
    return;
  }
  keep_in_history(files_.colors, *present, now, history_);
}

/// In a folder of their own, with paths that hold there.
void TrainingSession::keep_present_samples(const std::string& now) const {
  if (samples_text_.empty()) return;
  const fs::path folder = history_folder(files_.samples);
  const std::string text = samples_yaml(samples_from_yaml(samples_text_, files_.samples), folder);
  write_atomically(unused_file(folder, now, ".yaml"), text);
}

void TrainingSession::save(std::int64_t version, const std::string& notes) {
  const std::lock_guard lock(mutex_);
  if (!refusal_.empty()) throw Error("saving", "is refused: " + refusal_);
  if (version != version_)
    throw Error("draft", fmt::format("is at version {}, version {} was to be saved: somebody else changed it meanwhile",
                                     version_, version));
  LoadedSamples loaded{copied_samples(), 0, {}, range_};
  std::set<int> groups;
  for (const ColorSample& sample : loaded.samples) groups.insert(sample.group);
  loaded.images = static_cast<int>(groups.size());
  std::error_code error;
  const fs::path from_colors = fs::proximate(files_.samples, files_.colors.parent_path(), error);
  ColorsFile colors =
      train_colors_file(
          {error ? files_.samples.string() : from_colors.string(), std::move(loaded)}, nullptr, options_,
          [](const std::string&, const std::string&) {}, judged_version_ == version_ ? &quality_ : nullptr)
          .file;
  colors.table.priority = table_.priority;
  if (!notes.empty()) colors.trained_from->notes = notes + "; " + colors.trained_from->notes;

  const std::string now = time_for_names();
  if (std::ranges::any_of(draft_, [&](const auto& one) { return images_[index_of(one->sample.image)].file.empty(); }))
    write_images(now);
  std::vector<TrainingSample> samples;
  for (const auto& one : draft_) {
    const Image& image = images_[index_of(one->sample.image)];
    samples.push_back({image.file, image.frame, one->sample.color, one->sample.shape});
  }
  const std::string text = samples_yaml(samples, files_.samples.parent_path());
  if (text.size() > kMostSamplesText)
    throw Error(files_.samples.string(), fmt::format("would have {} bytes, must have at most {} to be read again",
                                                     text.size(), kMostSamplesText));
  // What somebody else wrote meanwhile is no less work than this.
  if (const std::string there = text_of(files_.samples); there != samples_text_)
    write_atomically(files_.samples.parent_path() / fmt::format("{}_{}.yaml", files_.samples.stem().string(), now),
                     there);
  if (text != samples_text_) keep_present_samples(now);
  write_atomically(files_.samples, text);
  samples_text_ = text;
  history_ = read_history(files_.colors);
  keep_present_table(now);
  write_colors(files_.colors, colors);
  note_table(colors);
  keep_in_history(files_.colors, colors, now, history_);  // after the former one, also within a second
  saved_version_ = version_;
}

bool TrainingSession::restore(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (files_.colors.empty()) throw Error("colors", "no color table is named that could be written");
  history_ = read_history(files_.colors);
  const auto former = std::ranges::find(history_, id, &FormerColors::id);
  if (former == history_.end()) return false;
  if (!former->fault.empty()) throw Error(id, "cannot be read: " + former->fault);
  if (former->colors.table.range != range_)
    throw Error(id, fmt::format("is for {} color range, what is seen now has {}", to_string(former->colors.table.range),
                                to_string(range_)));
  const ColorsFile colors = former->colors;
  keep_present_table(time_for_names());
  write_colors(files_.colors, colors);
  note_table(colors);
  return true;
}

}  // namespace tassilo
