#include "core/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using tests::message_of;

std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(Files, RoundTripAnyBytes) {
  const tests::TemporaryFolder folder;
  for (const std::string& content :
       {std::string(), std::string("text\n"), std::string("\0\r\n\xff", 4), std::string(1 << 20, 'x')}) {
    write_file(folder / "file", content);
    EXPECT_EQ(read_file(folder / "file"), content);
  }
  EXPECT_EQ(entries(folder.path()), 1u) << "no part is left beside the file";
}

TEST(Files, AReaderNeverSeesHalfAFile) {
  const tests::TemporaryFolder folder;
  const std::string a(200000, 'a'), b(300000, 'b');
  write_file(folder / "file", a);
  std::atomic<bool> stop = false;
  std::atomic<int> reads = 0, torn = 0;
  std::thread reader([&] {
    while (!stop) {
      const std::string seen = read_file(folder / "file");
      torn += seen != a && seen != b;
      ++reads;
    }
  });
  for (int k = 0; k < 40 || reads < 40; ++k) write_file(folder / "file", k % 2 ? a : b);
  stop = true;
  reader.join();
  EXPECT_EQ(torn, 0);
}

TEST(Files, AFailedWriteKeepsTheOldContentAndLeavesNothingBeside) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "target" / "inside");  // a folder that is not empty cannot be replaced
  EXPECT_THAT(message_of<InputError>([&] { write_file(folder / "target", "new"); }),
              ::testing::HasSubstr((folder / "target").string()));
  EXPECT_TRUE(std::filesystem::is_directory(folder / "target" / "inside"));
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(Files, WhatCannotBeReadOrWrittenIsNamed) {
  const tests::TemporaryFolder folder;
  EXPECT_THAT(message_of<InputError>([&] { read_file(folder / "absent"); }), ::testing::HasSubstr("absent"));
  EXPECT_THAT(message_of<InputError>([&] { read_file(folder.path()); }), ::testing::HasSubstr(folder.path().string()));
  EXPECT_THAT(message_of<InputError>([&] { write_file(folder / "no" / "file", "x"); }),
              ::testing::HasSubstr("no/file"));
}

TEST(Files, HashesAreSixteenHexDigitsThatTellContentsApart) {
  EXPECT_EQ(hex16(0x1a), "000000000000001a");
  EXPECT_THAT(hash_hex("a"), ::testing::MatchesRegex("[0-9a-f]{16}"));
  EXPECT_EQ(hash_hex("same"), hash_hex("same"));
  EXPECT_NE(hash_hex("a"), hash_hex("b"));
  EXPECT_NE(hash_hex(""), hash_hex(std::string_view("\0", 1)));
}

}  // namespace
}  // namespace tarmac::core
