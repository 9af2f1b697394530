#include "tassilo/base/contract.h"

#include <cstdio>
#include <cstdlib>

namespace tassilo {

void broken_promise(const char* promise, std::source_location at) {
  std::fprintf(stderr, "tassilo: broken promise: %s (%s:%u, %s)\n", promise, at.file_name(),
               static_cast<unsigned>(at.line()), at.function_name());
  std::abort();
}

}  // namespace tassilo
