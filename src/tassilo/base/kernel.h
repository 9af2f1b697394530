#pragma once

#include <span>
#include <string_view>

namespace tassilo {

// Which instructions the fast versions of inner loops may use. Every loop has a plain version that all others equal bit
// for bit; a loop that has none of its own for the kernel in use takes the next simpler one.

enum class Kernel {
  plain,   ///< Portable C++; the reference.
  neon,    ///< aarch64, always there.
  avx2,    ///< x86-64 with AVX2 and BMI.
  avx512,  ///< x86-64 with AVX-512 F, BW, DQ, VL, VBMI, VBMI2 and BITALG (Ice Lake, Zen 4 and later).
};

/// Lower-case name, as in TASSILO_KERNEL.
std::string_view to_string(Kernel kernel);
/// Those that this build has and this machine runs, the plain one first, the fastest last; at least one. Some ns.
std::span<const Kernel> supported_kernels();

/// Does this build have it and this machine run it?
bool is_supported(Kernel kernel);

/// The kernel in use: the fastest, unless `use_kernel` said otherwise. Safe from any thread, some ns.
Kernel kernel_in_use();
/// Uses another from now on, on all threads; it must be a supported one. For measuring and for tests: results are the
/// same.
void use_kernel(Kernel kernel);
/// The same by name, as the program does with the environment's TASSILO_KERNEL. Throws Error when there is no such
/// kernel or this machine does not run it, naming those it does.
void use_kernel(std::string_view name);

/// Of versions of one loop, each with a member `kernel`, the plain one first and the fastest last: the best one up to
/// the kernel in use.
template <class Version>
const Version& version_in_use(std::span<const Version> versions) {
  const Version* best = &versions.front();
  for (const Version& version : versions)
    if (version.kernel <= kernel_in_use() && is_supported(version.kernel)) best = &version;
  return *best;
}

}  // namespace tassilo
