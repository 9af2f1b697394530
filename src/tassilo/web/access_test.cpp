#include "tassilo/web/access.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace tassilo {
namespace {

namespace fs = std::filesystem;

TEST(Token, IsLongAndNew) {
  std::set<std::string> tokens;
  for (int k = 0; k < 100; ++k) tokens.insert(new_token());
  EXPECT_EQ(tokens.size(), 100u);
  EXPECT_EQ(tokens.begin()->size(), 32u);
}

TEST(SameSecret, IsEquality) {
  EXPECT_TRUE(same_secret("abc", "abc"));
  EXPECT_TRUE(same_secret("", ""));
  for (const char* other : {"", "ab", "abd", "abcd", "Abc"}) EXPECT_FALSE(same_secret("abc", other));
}

AccessRequest from(std::string_view host, std::string_view origin = "") { return {host, origin, "", "", ""}; }

TEST(Access, OnLoopbackTheHostMustBeThisMachine) {
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080"})
    EXPECT_EQ(access_of(from(host), "127.0.0.1", 8080, ""), Access::granted) << host;
  for (const char* host : {"", "evil.example:8080", "localhost", "localhost:80", "127.0.0.1:8080.evil.example"})
    EXPECT_EQ(access_of(from(host), "127.0.0.1", 8080, ""), Access::wrong_host) << host;
}

TEST(Access, TheUsualPortIsNotNamed) {
  EXPECT_EQ(access_of(from("localhost", "http://localhost"), "127.0.0.1", 80, ""), Access::granted);
  EXPECT_EQ(access_of(from("localhost:80"), "127.0.0.1", 80, ""), Access::granted);
  EXPECT_EQ(access_of(from("evil.example"), "127.0.0.1", 80, ""), Access::wrong_host);
}

TEST(Access, PagesOfOthersMayNotAsk) {
  EXPECT_EQ(access_of(from("localhost:8080", "http://localhost:8080"), "127.0.0.1", 8080, ""), Access::granted);
  for (const char* origin : {"http://evil.example", "null", "https://localhost:8080", "http://localhost:8081"})
    EXPECT_EQ(access_of(from("localhost:8080", origin), "127.0.0.1", 8080, ""), Access::wrong_origin) << origin;
  AccessRequest image = from("localhost:8080");
  image.fetch_site = "cross-site";
  EXPECT_EQ(access_of(image, "127.0.0.1", 8080, ""), Access::wrong_origin);
}

TEST(Access, TheTokenComesAsCookieOrBearer) {
  AccessRequest request = from("robot.local:8080");
  const auto access = [&] { return access_of(request, "0.0.0.0", 8080, "secret"); };
  EXPECT_EQ(access(), Access::no_token);
  request.cookie = "a=b; tassilo_token=secret; c=d";
  EXPECT_EQ(access(), Access::granted);
  request.cookie = "tassilo_token=Secret";
  EXPECT_EQ(access(), Access::no_token);
  request.cookie = "xtassilo_token=secret";
  EXPECT_EQ(access(), Access::no_token);
  request.authorization = "Bearer secret";
  EXPECT_EQ(access(), Access::granted);
  request.authorization = "Basic secret";
  EXPECT_EQ(access(), Access::no_token);
}

class ServedFile : public testing::Test {
 protected:
  ServedFile() {
    fs::create_directories(folder / "pages/sub");
    for (const char* name : {"pages/index.html", "pages/a.js", "pages/sub/index.html", "pages/.hidden", "secret"})
      std::ofstream(folder / name) << name;
    fs::create_symlink(folder / "secret", folder / "pages/link");
  }
  ~ServedFile() override { fs::remove_all(folder); }
  fs::path folder = fs::path(testing::TempDir()) / ("tassilo_pages_" + new_token());
};

TEST_F(ServedFile, LiesInTheFolder) {
  const fs::path pages = folder / "pages";
  EXPECT_EQ(served_file(pages, "/"), fs::canonical(pages / "index.html"));
  EXPECT_EQ(served_file(pages, "/a.js"), fs::canonical(pages / "a.js"));
  EXPECT_EQ(served_file(pages, "/sub"), fs::canonical(pages / "sub/index.html"));
  EXPECT_EQ(served_file(pages, "/sub/../a.js"), std::nullopt) << "nobody writes that by mistake";
}

TEST_F(ServedFile, NeverElsewhere) {
  const fs::path pages = folder / "pages";
  for (const char* path : {"/../secret", "/..", "/link", "/.hidden", "//../secret", "/sub/../../secret",
                           "/sub\\..\\a.js", "a.js", "", "/nothing", "//etc/passwd", "/sub/./../../secret"})
    EXPECT_EQ(served_file(pages, path), std::nullopt) << path;
  EXPECT_EQ(served_file("", "/a.js"), std::nullopt);
  EXPECT_EQ(served_file(folder / "nothing", "/"), std::nullopt);
}

}  // namespace
}  // namespace tassilo
