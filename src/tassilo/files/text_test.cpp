#include "tassilo/files/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <sstream>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/test_folder.h"

namespace tassilo {
namespace {

TEST(LineReader, GivesWhatGetlineGives) {
  const TestFolder folder;
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string text;
    const int lines = std::uniform_int_distribution(0, 6)(random);
    for (int i = 0; i < lines; ++i) {
      text.append(std::uniform_int_distribution<std::size_t>(0, 1 << 17)(random) % (seed % 2 ? 5 : 1 << 17), 'a');
      if (i + 1 < lines || seed % 3) text += '\n';
    }
    write_atomically(folder / "lines.txt", text);
    std::vector<std::string> expected, seen;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) expected.push_back(line);
    LineReader reader(folder / "lines.txt");
    while (const auto line = reader.next()) seen.emplace_back(*line);
    EXPECT_EQ(seen, expected);
    EXPECT_EQ(reader.line(), static_cast<int>(expected.size()));
    EXPECT_FALSE(reader.next());
  }
}

TEST(LineReader, DropsCarriageReturns) {
  const TestFolder folder;
  LineReader reader(folder.with("a.txt", "one\r\ntwo\r"));
  EXPECT_EQ(reader.next(), "one");
  EXPECT_EQ(reader.next(), "two");
  EXPECT_FALSE(reader.next());
}

TEST(LineReader, RefusesLongLinesNamingTheLine) {
  const TestFolder folder;
  const auto file = folder.with("long.txt", "ok\n" + std::string(200000, 'x'));
  LineReader reader(file, 100);
  EXPECT_EQ(reader.next(), "ok");
  EXPECT_THAT(
      [&] { reader.next(); },
      testing::ThrowsMessage<Error>(file.string() + ":2: has more than 100 bytes, which is the limit for a line"));
}

TEST(ReadText, NamesWhatCannotBeRead) {
  const TestFolder folder;
  const auto none = folder / "none.txt";
  EXPECT_THAT([&] { read_text(none, 10); },
              testing::ThrowsMessage<Error>(none.string() + ": cannot be opened: No such file or directory"));
  EXPECT_THAT([&] { LineReader reader(none); },
              testing::ThrowsMessage<Error>(none.string() + ": cannot be opened: No such file or directory"));
  EXPECT_THAT([&] { read_text(folder.path(), 10); },
              testing::ThrowsMessage<Error>(folder.path().string() + ": is a directory, must be a file"));
  const auto big = folder.with("big.txt", std::string(11, 'x'));
  EXPECT_THAT([&] { read_text(big, 10); },
              testing::ThrowsMessage<Error>(big.string() + ": has more than 10 bytes, which is the limit"));
  EXPECT_EQ(read_text(big, 11).size(), 11u);
}

}  // namespace
}  // namespace tassilo
