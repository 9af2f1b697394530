#include "tassilo/base/kernel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

struct Supported {
  std::array<Kernel, 4> kernels{};
  std::size_t count = 0;

  Supported() {
    add(Kernel::plain);
#if defined(__aarch64__)
    add(Kernel::neon);
#elif defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
        __builtin_cpu_supports("popcnt")) {
      add(Kernel::avx2);
      if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
          __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
          __builtin_cpu_supports("avx512vbmi") && __builtin_cpu_supports("avx512vbmi2") &&
          __builtin_cpu_supports("avx512bitalg"))
        add(Kernel::avx512);
    }
#endif
  }
  void add(Kernel kernel) { kernels[count++] = kernel; }
};

std::atomic<Kernel>& in_use() {
  static std::atomic<Kernel> kernel = supported_kernels().back();
  return kernel;
}

}  // namespace

std::string_view to_string(Kernel kernel) {
  switch (kernel) {
    case Kernel::plain:
      return "plain";
    case Kernel::neon:
      return "neon";
    case Kernel::avx2:
      return "avx2";
    case Kernel::avx512:
      return "avx512";
  }
  broken_promise("a known kernel");
}

std::span<const Kernel> supported_kernels() {
  static const Supported supported;
  return std::span(supported.kernels).first(supported.count);
}

bool is_supported(Kernel kernel) { return std::ranges::count(supported_kernels(), kernel) == 1; }

Kernel kernel_in_use() { return in_use().load(std::memory_order_relaxed); }

void use_kernel(Kernel kernel) {
  expects(is_supported(kernel), "a kernel that this machine runs");
  in_use().store(kernel, std::memory_order_relaxed);
}

void use_kernel(std::string_view name) {
  std::string known;
  for (const Kernel kernel : supported_kernels()) {
    if (to_string(kernel) == name) return use_kernel(kernel);
    known += (known.empty() ? "" : ", ") + std::string(to_string(kernel));
  }
  throw Error("TASSILO_KERNEL", "is '" + std::string(name) + "', must be one that this machine runs: " + known);
}

}  // namespace tassilo
