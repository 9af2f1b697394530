#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/image/frame.h"
#include "tassilo/source/camera.h"

// To add a kind of source: 1. a FrameReader in a file of its own (see internal/frame_reader.h); 2. when to take it, in
// `open_source`; 3. its laws in frame_source_test.cpp.

namespace tassilo {

/// What bytes without a header cannot say of themselves: `rpicam-vid --codec yuv420 -o -`, `.yuv` files.
///
/// Frames follow each other without gaps, rows without padding (an odd width has a last chroma sample for one pixel).
struct RawFormat {
  PixelFormat format = PixelFormat::yuv420p;
  int width = 0, height = 0;  ///< [px], 1..32767
  ColorRange range = ColorRange::limited;
  double fps = 0;  ///< > 0; frame k is captured at k / fps. [1/s]
  /// Throws Error naming the first field out of range.
  void check() const;
};

struct SourceOptions {
  /// `-` (standard input), a file, a folder of PNG and JPEG images, a URL that FFmpeg reads (rtsp, udp, http, ...), or
  /// a camera, see is_camera.
  std::string location = {};
  /// Given: `location` is read as raw frames. Else the bytes must say what they are.
  std::optional<RawFormat> raw = {};
  /// RGB and palette pictures become BT.601 in this range; YUV keeps its own. Normally the color table's range.
  ColorRange images_range = ColorRange::limited;
  /// Rate of sources without time stamps of their own: folders (0: one image a second) and elementary streams (0: what
  /// the stream says, else 25). [1/s], >= 0
  double fps = 0;
  int threads = 1;  ///< For decoding, where a codec has slices. >= 1
  /// Asked now and then while waiting for data, from the reading thread; true ends the source as if it were over.
  std::function<bool()> interrupted = {};
  CameraOptions camera = {};  ///< For cameras only.
  /// Told what happens to a camera, from the reading thread, while it reads.
  std::function<void(const CameraNews&)> camera_news = {};
  /// Throws Error naming the first field out of range.
  void check() const;
};

/// What is known of a source once its first frame is there.
struct SourceInfo {
  std::string name;           ///< As messages name it: the location, or "standard input".
  std::string description;    ///< One line for people: codec, container, native format, size, range, remarks.
  int width = 0, height = 0;  ///< Of the first frame. [px]
  ColorRange range = ColorRange::limited;   ///< Of the first frame.
  std::optional<std::int64_t> frame_count;  ///< As far as the container tells; an estimate for progress bars.
  /// A network stream or a camera: frames come when they come, and late ones are worth nothing.
  bool live = false;
};

class FrameReader;

/// Frames of one source in capture order. Move-only; one thread at a time.
///
/// Pixels stay in the codec's native layout and memory where that is one of PixelFormat, without a copy. Other YUV
/// layouts (4:4:4, 4:1:1, 10 bit, ...) become yuv422p of 8 bit with their range kept, RGB becomes BT.601 yuv422p in
/// `images_range`; alpha is ignored. Range: as tagged, else full for JPEG and yuvj formats, else limited. Values tagged
/// BT.709 are not converted; the description says so.
/// Time: the stored time stamps, each frame its own; constant rate only where the source has none. Where a video file
/// has VIDEO.frames.jsonl beside it, as recordings do, times and indices are those of that file.
///
/// A camera is grabbed by a thread of its own, and `next` gives the newest frame, whatever was missed meanwhile: it
/// waits for one through stalls and absences, which `camera_news` tells. Its pixels are the driver's buffers; who keeps
/// more than a few frames gets copies. Time is the driver's monotonic time of capture, since the UNIX epoch.
class FrameSource {
 public:
  explicit FrameSource(std::unique_ptr<FrameReader> reader);
  FrameSource(FrameSource&&) noexcept;
  FrameSource& operator=(FrameSource&&) noexcept;
  ~FrameSource();

  /// The next frame; nothing at the end, and ever after.
  ///
  /// Throws Error naming source and frame when the source is damaged, cut short or changes its size; every frame before
  /// the damage has been returned then. Calls after that throw the same again.
  std::optional<Frame> next();

  const SourceInfo& info() const { return info_; }
  /// What a camera did not deliver so far; all 0 for other sources.
  CameraCounts camera_counts() const;
  /// What a camera's clock shows now, the clock of its frames' `t`; nothing for other sources. [s]
  std::optional<double> now() const;

 private:
  std::unique_ptr<FrameReader> reader_;
  SourceInfo info_;
  std::optional<Frame> first_;  ///< Read while opening, for `info_`.
  std::optional<Error> damage_;
  bool over_ = false;
};

/// Opens a source and reads its first frame. Throws Error when there is none: a missing or empty file, a folder without
/// images, bytes that are no video, a frame larger than 32767 in a direction.
FrameSource open_source(const SourceOptions& options);

/// The frames at 0-based positions `indices` (any order, repeats allowed), in that order; `options.location` as for
/// open_source. Decodes once up to the largest. Throws Error when the source has fewer frames.
std::vector<Frame> read_frames(const SourceOptions& options, std::span<const std::int64_t> indices);
/// One frame, for training stills.
Frame read_frame(const SourceOptions& options, std::int64_t index);

}  // namespace tassilo
