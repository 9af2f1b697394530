#pragma once

#include <string>
#include <utility>

#include "tassilo/base/error.h"

namespace tassilo {

/// A value that came from a file, after its own check(); an Error then names the file, too.
template <class T>
T checked(T value, const std::string& file) {
  try {
    value.check();
  } catch (const Error& error) {
    throw Error(file, error.what());
  }
  return value;
}

}  // namespace tassilo
