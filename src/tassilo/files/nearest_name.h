#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace tassilo {

/// The known name that a typing error away from `name` is most likely meant; nothing when none is close.
///
/// Close: edit distance with swaps of neighbors (Damerau-Levenshtein, optimal string alignment) at most a third of the
/// length, at least 1. O(known.size() * length^2); names longer than 64 characters are close to nothing.
std::optional<std::string_view> nearest_name(std::string_view name, std::span<const std::string_view> known);

}  // namespace tassilo
