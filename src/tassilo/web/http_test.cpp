#include "tassilo/web/http.h"

#include <gtest/gtest.h>

#include <random>

namespace tassilo {
namespace {

TEST(PercentDecoded, UndoesEscapesAndRefusesBrokenOnes) {
  EXPECT_EQ(percent_decoded("/a%20b%2Fc"), "/a b/c");
  EXPECT_EQ(percent_decoded(""), "");
  for (const char* broken : {"%", "%2", "%zz", "a%0", "%00", "%0d%0a", "a\nb", "%-1", "%7f"})
    EXPECT_FALSE(percent_decoded(broken)) << broken;
}

TEST(PercentDecoded, SurvivesAnything) {
  std::mt19937 random(1);
  for (int k = 0; k < 2000; ++k) {
    std::string text(random() % 12, ' ');
    for (char& c : text) c = random() % 2 == 0 ? '%' : static_cast<char>(random());
    if (const auto decoded = percent_decoded(text)) {
      EXPECT_LE(decoded->size(), text.size());
    }
  }
}

TEST(QueryValue, IsTheFirstOfItsKey) {
  EXPECT_EQ(query_value("a=1&b=2&a=3", "a"), "1");
  EXPECT_EQ(query_value("a=1&b=%20", "b"), " ");
  EXPECT_EQ(query_value("ab=1&b", "b"), "");
  EXPECT_FALSE(query_value("ab=1", "a"));
  EXPECT_FALSE(query_value("a=%", "a"));
  EXPECT_FALSE(query_value("", "a"));
  EXPECT_EQ(query_value("&&a=1", "a"), "1");
}

TEST(ContentType, IsTakenFromTheEnding) {
  EXPECT_EQ(content_type_of("x/index.html"), "text/html; charset=utf-8");
  EXPECT_EQ(content_type_of("x.unknown"), "application/octet-stream");
}

}  // namespace
}  // namespace tassilo
