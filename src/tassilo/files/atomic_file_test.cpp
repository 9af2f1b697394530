#include "tassilo/files/atomic_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>

#include "tassilo/base/error.h"
#include "tassilo/files/test_folder.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

std::size_t file_count(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(WriteAtomically, ReplacesContentAndLeavesNothingBeside) {
  const TestFolder folder;
  const auto file = folder / "a.bin";
  for (const std::string& bytes :
       {std::string("first"), std::string("\0\xff", 2), std::string(), std::string(100000, 'x')}) {
    write_atomically(file, bytes);
    EXPECT_EQ(read_text(file, 1 << 20), bytes);
    EXPECT_EQ(file_count(folder.path()), 1u);
  }
}

TEST(WriteAtomically, KeepsPermissionsAndLinks) {
  const TestFolder folder;
  const auto file = folder.with("real", "old");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real", folder / "link");
  write_atomically(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(file, 100), "new");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(WriteAtomically, WritesIntoWhatIsNoFile) {
  const TestFolder folder;
  const auto pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  fs::create_symlink("pipe", folder / "link");
  for (const char* name : {"pipe", "link"}) {
    SCOPED_TRACE(name);
    write_atomically(folder / name, "bytes");
    std::array<char, 16> got{};
    EXPECT_EQ(read(reader, got.data(), got.size()), 5);
    EXPECT_STREQ(got.data(), "bytes");
  }
  close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(file_count(folder.path()), 2u);
}

TEST(WriteAtomically, LeavesTheOldContentWhenItFails) {
  const TestFolder folder;
  const auto lost = folder / "none/a.txt";
  EXPECT_THAT([&] { write_atomically(lost, "x"); },
              testing::ThrowsMessage<Error>(lost.string() + ": cannot be created: No such file or directory"));
  fs::create_directory(folder / "folder");
  EXPECT_THAT([&] { write_atomically(folder / "folder", "x"); },
              testing::ThrowsMessage<Error>((folder / "folder").string() + ": cannot be written: Is a directory"));
  EXPECT_EQ(file_count(folder.path()), 1u);
}

}  // namespace
}  // namespace tassilo
