#pragma once

#include <optional>
#include <string>

#include "tassilo/app/run.h"
#include "tassilo/record/image_folder.h"
#include "tassilo/record/json_lines_writer.h"
#include "tassilo/record/picture_writer.h"
#include "tassilo/vision/vision.h"

namespace tassilo {

/// Where scenes, pictures and label maps go; any of them may not be wanted.
class RunSinks {
 public:
  /// Throws Error when one of them cannot be written.
  explicit RunSinks(const RunArguments& arguments);

  void write(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace, const Optics* optics);
  /// Completes the video. After an error the destructor does what can be done.
  void finish();
  /// For people, a line each; empty for scenes on standard output.
  std::string names() const;

 private:
  Picture picture_of(const Frame& frame, const Scene& scene, const VisionWorkspace& workspace,
                     const Optics* optics) const;

  const RunArguments& arguments_;
  std::optional<PictureWriter> overlay_;
  std::optional<ImageFolder> label_maps_;
  std::optional<JsonLinesWriter> output_;
};

}  // namespace tassilo
