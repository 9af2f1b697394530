#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/evaluate/evaluate.h"

// The figures of a sequence as rows, for the table of one and for the table of two beside each other.

namespace tassilo {

enum class Better { unknown, higher, lower };

struct Figure {
  std::string name;             ///< "recall"
  std::optional<double> value;  ///< As `text` takes it.
  std::string (*text)(std::optional<double>) = nullptr;
  Better better = Better::unknown;
  std::string rest;                ///< What more there is to tell of it, in words.
  const Spread* spread = nullptr;  ///< Whose median the value is; lives as long as the score.
};

/// All figures of one subject.
struct FigureGroup {
  std::string subject;            ///< "ball"
  std::vector<Figure> figures;    ///< In the same order for every score, but for the stages of "time".
  std::string none, none_reason;  ///< Why no figure says anything; `none` is empty where they do.
};

/// pose, ball, yellow goal, blue goal, both goals, robots, free space, time; in this order.
std::vector<FigureGroup> figure_groups(const SequenceScore& score);

/// Stages in the order they run, unknown ones before the total.
std::vector<std::string> stages_in_order(std::vector<std::string> stages);

/// "median; 90 % below 1 m, at most 2 m"; empty for a spread of nothing.
std::string rest_of(const Spread& spread, std::string (*text)(std::optional<double>));

}  // namespace tassilo
