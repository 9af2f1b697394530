#include "tassilo/base/kernel.h"

#include <gtest/gtest.h>

#include <string>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

TEST(Kernel, ThePlainOneIsFirstAndTheFastestIsInUse) {
  ASSERT_FALSE(supported_kernels().empty());
  EXPECT_EQ(supported_kernels().front(), Kernel::plain);
  EXPECT_EQ(kernel_in_use(), supported_kernels().back());
}

TEST(Kernel, CanBeChosenByName) {
  const Kernel before = kernel_in_use();
  use_kernel("plain");
  EXPECT_EQ(kernel_in_use(), Kernel::plain);
  use_kernel(before);
  EXPECT_EQ(kernel_in_use(), before);
}

TEST(Kernel, AnUnknownNameIsAnErrorThatNamesTheKnownOnes) {
  try {
    use_kernel("mmx");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("TASSILO_KERNEL: is 'mmx'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("runs: plain"), std::string::npos);
  }
}

}  // namespace
}  // namespace tassilo
