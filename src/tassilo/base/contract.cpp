#include "tassilo/base/contract.h"

#include <cstdio>
#include <cstdlib>

namespace tassilo {

void broken_promise(const char* promise, SourcePlace at) {
  std::fprintf(stderr, "tassilo: broken promise: %s (%s:%d, %s)\n", promise, at.file, at.line, at.function);
  std::abort();
}

}  // namespace tassilo
