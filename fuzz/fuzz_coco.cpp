// Any text is a COCO mask or refused with an Error; a mask that was read is written, either way, and read back equal.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/coco_mask.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1 << 16) return 0;
  using namespace tassilo;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto counts = coco_counts_from_string(text, "counts");
    expects(coco_counts_from_string(coco_string(counts), "again") == counts, "written counts read back equal");
  } catch (const Error&) {
  }
  CocoMask mask;
  try {
    mask = coco_mask_from_json(text, "mask.json");
  } catch (const Error&) {
    return 0;
  }
  // Larger ones take the same path, and seconds.
  if (std::int64_t{mask.width} * mask.height > 1 << 20) return 0;
  for (const CocoCounts form : {CocoCounts::string, CocoCounts::list})
    expects(coco_mask_from_json(coco_json(mask, form), "again.json") == mask, "a written mask reads back equal");
  return 0;
}
