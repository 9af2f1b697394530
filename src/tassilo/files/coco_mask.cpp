#include "tassilo/files/coco_mask.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/json.h"
#include "tassilo/files/text.h"
#include "tassilo/region/algebra.h"

namespace tassilo {
namespace {

constexpr int kMostSide = std::numeric_limits<std::int16_t>::max();
constexpr std::int64_t kMostCount = std::int64_t{1} << 30;  // kMostSide^2 is less
/// A few bytes can say "every other column", which is half a run a pixel.
constexpr std::int64_t kMostPixels = std::int64_t{1} << 26;
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 26;
constexpr char kFirst = '0', kLast = 'o';  // 6 bits from '0' on
constexpr unsigned kValueBits = 0x1f, kMore = 0x20, kSign = 0x10;

void check_size(const CocoMask& mask) {
  expects(mask.width >= 1 && mask.width <= kMostSide && mask.height >= 1 && mask.height <= kMostSide,
          "a mask's image is 1 to 32767 pixels wide and high");
}

int side_of(const Value& value) { return static_cast<int>(value.integer(1, kMostSide)); }

std::vector<std::uint32_t> counts_of(const Value& value) {
  if (!value.is_list()) {
    const bool is_text = !value.is_map() && !value.is_null() && value.setting().quoted;
    if (!is_text) value.fail("is no text, must be a text or a list of numbers");
    return coco_counts_from_string(value.string(), value.place());
  }
  std::vector<std::uint32_t> counts;
  for (const Value& count : value.list()) counts.push_back(static_cast<std::uint32_t>(count.integer(0, kMostCount)));
  return counts;
}

CocoMask mask_of(const Value& value, const std::string& place) {
  const Map map = value.map({"size", "counts"});
  const std::vector<Value> size = map.at("size").list(2, 2);
  const CocoMask mask{side_of(size[1]), side_of(size[0]), {}};
  if (const std::int64_t pixels = std::int64_t{mask.width} * mask.height; pixels > kMostPixels)
    map.at("size").fail("is " + std::to_string(pixels) + " pixels, must be at most " + std::to_string(kMostPixels));
  return coco_mask_from_counts(mask, counts_of(map.at("counts")), place);
}

}  // namespace

std::vector<std::uint32_t> coco_counts(const CocoMask& mask) {
  check_size(mask);
  const Region columns = transposed(clipped(mask.region, {0, 0, mask.width, mask.height}));
  std::vector<std::uint32_t> counts{0};
  const auto lengthen = [&](std::int64_t by, bool inside) {
    const bool is_inside = counts.size() % 2 == 0;
    if (by > 0 && is_inside != inside) counts.push_back(0);
    counts.back() += static_cast<std::uint32_t>(by);
  };
  std::int64_t at = 0;
  for (const PixelRun& run : columns.runs()) {  // its row is a column
    const std::int64_t begin = std::int64_t{run.row} * mask.height + run.begin;
    lengthen(begin - at, false);
    lengthen(run.length(), true);
    at = begin + run.length();
  }
  lengthen(std::int64_t{mask.width} * mask.height - at, false);
  return counts;
}

CocoMask coco_mask_from_counts(CocoMask mask, std::span<const std::uint32_t> counts, const std::string& place) {
  check_size(mask);
  const std::int64_t pixels = std::int64_t{mask.width} * mask.height;
  std::int64_t sum = 0;
  for (const std::uint32_t count : counts) sum += count;
  if (sum != pixels)
    throw Error(place, "counts add up to " + std::to_string(sum) + ", must be height x width, " +
                           std::to_string(mask.height) + " x " + std::to_string(mask.width) + " = " +
                           std::to_string(pixels));
  RunVector columns;
  std::int64_t at = 0;
  bool inside = false;
  for (const std::uint32_t count : counts) {
    const std::int64_t end = at + count;
    while (inside && at < end) {
      const std::int64_t column = at / mask.height, row = at % mask.height;
      const std::int64_t here = std::min<std::int64_t>(end - at, mask.height - row);
      columns.push_back(
          {static_cast<std::int16_t>(column), static_cast<std::int16_t>(row), static_cast<std::int16_t>(row + here)});
      at += here;
    }
    at = end;
    inside = !inside;
  }
  mask.region = transposed(Region::from_runs(std::move(columns)));
  return mask;
}

std::string coco_string(std::span<const std::uint32_t> counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    std::int64_t value = counts[i];
    if (i > 2) value -= counts[i - 2];
    for (bool more = true; more;) {
      unsigned bits = static_cast<unsigned>(value) & kValueBits;
      value >>= 5;
      more = value != (bits & kSign ? -1 : 0);
      if (more) bits |= kMore;
      text.push_back(static_cast<char>(kFirst + static_cast<int>(bits)));
    }
  }
  return text;
}

std::vector<std::uint32_t> coco_counts_from_string(std::string_view text, const std::string& place) {
  constexpr int kMostBits = 35;  // enough for the difference of any two counts
  std::vector<std::uint32_t> counts;
  std::int64_t value = 0;
  int shift = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto fail = [&](const std::string& reason) {
      throw Error(place, "counts, character " + std::to_string(i) + ": " + reason);
    };
    if (text[i] < kFirst || text[i] > kLast) fail("is " + shown(text.substr(i, 1)) + ", must be '0' to 'o'");
    if (shift == kMostBits) fail("the number goes on, must have at most 7 characters");
    const auto bits = static_cast<unsigned>(text[i] - kFirst);
    value |= std::int64_t{bits & kValueBits} << shift;
    shift += 5;
    if (bits & kMore) continue;
    if (bits & kSign) value -= std::int64_t{1} << shift;
    if (counts.size() > 2) value += counts[counts.size() - 2];
    if (value < 0 || value > kMostCount)
      fail("count " + std::to_string(counts.size()) + " is " + std::to_string(value) + ", must be 0 to " +
           std::to_string(kMostCount));
    counts.push_back(static_cast<std::uint32_t>(value));
    value = 0;
    shift = 0;
  }
  if (shift != 0) throw Error(place, "counts end within a number, they are cut");
  return counts;
}

std::string coco_json(const CocoMask& mask, CocoCounts form) {
  std::string json =
      "{\"size\": [" + std::to_string(mask.height) + ", " + std::to_string(mask.width) + "], \"counts\": ";
  const std::vector<std::uint32_t> counts = coco_counts(mask);
  if (form == CocoCounts::string) {
    json += '"';
    for (const char c : coco_string(counts)) {
      if (c == '\\') json += '\\';
      json += c;
    }
    return json + "\"}";
  }
  json += '[';
  for (std::size_t i = 0; i < counts.size(); ++i) json.append(i > 0 ? ", " : "").append(std::to_string(counts[i]));
  return json + "]}";
}

CocoMask coco_mask_from_json(std::string_view text, const std::string& place) {
  return mask_of(parse_json(text, place), place);
}

std::vector<CocoMask> read_coco_masks(const std::filesystem::path& file) {
  const Value root = parse_json(read_text(file, kMaxFileBytes), file.string());
  std::vector<CocoMask> masks;
  for (const Value& value : root.list())
    masks.push_back(mask_of(value, file.string() + ": mask " + std::to_string(masks.size())));
  return masks;
}

void write_coco_masks(const std::filesystem::path& file, std::span<const CocoMask> masks, CocoCounts counts) {
  std::string json = "[";
  for (std::size_t i = 0; i < masks.size(); ++i) json.append(i > 0 ? ",\n" : "\n").append(coco_json(masks[i], counts));
  write_atomically(file, json + "\n]\n");
}

}  // namespace tassilo
