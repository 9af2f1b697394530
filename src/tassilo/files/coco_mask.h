#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/region/region.h"

namespace tassilo {

// Masks as COCO data sets and the tools around them keep them: run lengths along columns, either as a list
// ("uncompressed RLE") or as a string ("compressed RLE").
//
// source   Lin et al., "Microsoft COCO: Common objects in context", ECCV 2014, and the format of its mask API.

/// A region and the size of the image it belongs to, both 1 to 32767. [px]
struct CocoMask {
  int width = 0, height = 0;
  Region region;
  friend bool operator==(const CocoMask&, const CocoMask&) = default;
};

/// Lengths of background, foreground, background, ... down the first column, then the next; they begin with background,
/// which may be 0 long, and add up to width x height. What of the region lies outside the image is cut. O(R log R).
std::vector<std::uint32_t> coco_counts(const CocoMask& mask);
/// The mask of such counts. `mask` gives the size, its region plays no part. Throws Error(place, reason) unless the
/// counts add up to width x height; counts of 0 are fine anywhere. O(C log C + columns) for C counts.
CocoMask coco_mask_from_counts(CocoMask mask, std::span<const std::uint32_t> counts, const std::string& place);

/// Counts as COCO packs them: from the fourth on less the last but one, five bits a character from the lowest on,
/// characters '0' to 'o'.
std::string coco_string(std::span<const std::uint32_t> counts);
/// Undoes coco_string. Throws Error(place, reason) for characters that never occur, a cut number, and numbers that are
/// negative or beyond 2^30, which no image has pixels for.
std::vector<std::uint32_t> coco_counts_from_string(std::string_view text, const std::string& place);

/// How counts are written.
enum class CocoCounts { string, list };

/// {"size": [height, width], "counts": ...} on one line, without a line end.
std::string coco_json(const CocoMask& mask, CocoCounts counts = CocoCounts::string);
/// Reads one such object with either kind of counts, of at most 2^26 pixels. `place` is how messages call it. Throws
/// Error(place, what is wrong).
CocoMask coco_mask_from_json(std::string_view text, const std::string& place);

/// A file with a JSON list of such objects, at most 64 MiB.
std::vector<CocoMask> read_coco_masks(const std::filesystem::path& file);
/// Written atomically.
void write_coco_masks(const std::filesystem::path& file, std::span<const CocoMask> masks,
                      CocoCounts counts = CocoCounts::string);

}  // namespace tassilo
