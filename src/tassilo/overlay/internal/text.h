#pragma once

#include <initializer_list>
#include <string>

namespace tassilo {

std::string fixed(double value, int decimals);
std::string meters(double value);      ///< "1.86 m"
std::string percent(double fraction);  ///< "97 %"
std::string number_text(int id);       ///< "#3"
/// The parts that are not empty with " · " between them.
std::string joined(std::initializer_list<std::string> parts);
std::string bearing_text(double angle);  ///< "12° left", "ahead"

}  // namespace tassilo
