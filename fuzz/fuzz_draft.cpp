// Whatever a browser sends as a draft of color samples is refused, or read and written back alike.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/training_draft.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tassilo;
  if (size > 1 << 16) return 0;
  TrainingDraft draft;
  try {
    draft = draft_from_json({reinterpret_cast<const char*>(data), size}, "request");
  } catch (const Error&) {
    return 0;
  }
  std::string samples;
  for (const DraftSample& sample : draft.samples)
    samples.append(samples.empty() ? "" : ",").append(draft_sample_json(sample));
  const TrainingDraft again =
      draft_from_json(R"({"version":0,"samples":[)" + samples + R"(],"options":{},"brightness":{}})", "written");
  expects(again.samples == draft.samples, "written samples read back equal");
  return 0;
}
