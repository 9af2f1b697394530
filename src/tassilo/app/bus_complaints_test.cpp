#include "tassilo/app/bus_complaints.h"

#include <gtest/gtest.h>

namespace tassilo {
namespace {

TEST(ComplaintKind, IsTheSameForPacketsThatDifferInBytesAndNumbersOnly) {
  const std::string one =
      "malformed packet received from vendor 1.16 state header <52545053 02010110> smid 0x52 flags 0x54";
  const std::string two = "malformed packet received from vendor 1.17 state header <00ab1001 fe10b367> smid 0x15";
  EXPECT_EQ(complaint_kind(one), complaint_kind(two));
  EXPECT_EQ(complaint_kind("reader 01105f3a:2bc1:fa is full"), complaint_kind("reader 9915:ab:4 is full"));
}

TEST(ComplaintKind, DiffersWithTheWords) {
  EXPECT_NE(complaint_kind("malformed packet received"), complaint_kind("malformed topic received"));
  EXPECT_NE(complaint_kind("no room for 3 readers"), complaint_kind("no room for 3 writers"));
  EXPECT_EQ(complaint_kind(""), "");
}

}  // namespace
}  // namespace tassilo
