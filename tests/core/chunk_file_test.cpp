#include "core/chunk_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <thread>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using tests::message_of;

/// Columns of every width, values that need all their bits, and an empty one.
ChunkData example(std::uint64_t number, std::size_t n = 100) {
  const RandomStream stream(number, "test/chunk");
  std::vector<std::uint8_t> bytes(n);
  std::vector<std::uint16_t> shorts(n);
  std::vector<float> floats(n);
  std::vector<double> doubles(n);
  std::vector<std::int64_t> wide(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto bits = stream.bits(i);
    bytes[i] = static_cast<std::uint8_t>(bits[0]);
    shorts[i] = static_cast<std::uint16_t>(bits[1]);
    floats[i] = std::bit_cast<float>(bits[2]);  // NaNs and subnormals among them
    wide[i] = static_cast<std::int64_t>((static_cast<std::uint64_t>(bits[3]) << 32) | bits[0]);
    doubles[i] = std::bit_cast<double>(wide[i]);
  }
  ChunkData data;
  data.add<std::uint8_t>(bytes);
  data.add<std::uint16_t>(shorts);
  data.add<float>(floats);
  data.add<double>(doubles);
  data.add<std::int64_t>(wide);
  data.add<float>({});
  data.add_value(std::int32_t{-7});
  return data;
}

std::vector<char> all_bytes(const ChunkData& data) {
  std::vector<char> out;
  const auto put = [&](const auto& column) {
    const char* first = reinterpret_cast<const char*>(column.data());
    out.insert(out.end(), first, first + column.size() * sizeof(column[0]));
  };
  put(data.column<std::uint8_t>(0));
  put(data.column<std::uint16_t>(1));
  put(data.column<float>(2));
  put(data.column<double>(3));
  put(data.column<std::int64_t>(4));
  put(data.column<float>(5));
  put(data.column<std::int32_t>(6));
  return out;
}

std::uint64_t write_example(const std::filesystem::path& file, std::uint64_t chunks) {
  ChunkWriter writer(file);
  for (std::uint64_t k = 0; k < chunks; ++k)
    writer.append(time_from_ns(static_cast<std::int64_t>(1000 * k)), example(k));
  return writer.finish();
}

/// Changes one byte where it is: thousands of damaged files cost too much to write anew.
void put_byte(const std::filesystem::path& file, std::size_t at, char byte) {
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(static_cast<std::streamoff>(at));
  stream.put(byte);
}

/// Every position near both ends, where the header and the index are, and some of those between.
std::vector<std::size_t> positions(std::size_t size, std::size_t near, std::size_t step) {
  std::vector<std::size_t> out;
  for (std::size_t at = 0; at < size; at += at < near || at + near >= size ? 1 : step) out.push_back(at);
  return out;
}

/// Opens the file and reads all of it.
std::vector<char> read_whole(const std::filesystem::path& file) {
  const ChunkReader reader(file);
  std::vector<char> out;
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const std::int64_t t_ns = to_ns(reader.time(i));
    out.insert(out.end(), reinterpret_cast<const char*>(&t_ns), reinterpret_cast<const char*>(&t_ns + 1));
    const std::vector<char> bytes = all_bytes(reader.read(i));
    out.insert(out.end(), bytes.begin(), bytes.end());
  }
  return out;
}

TEST(ChunkFile, RoundTripsBitExactly) {
  const tests::TemporaryFolder folder;
  const std::uint64_t digest = write_example(folder / "a.chunks", 5);
  const ChunkReader reader(folder / "a.chunks");
  ASSERT_EQ(reader.size(), 5u);
  EXPECT_EQ(reader.digest(), digest);
  for (std::uint64_t k = 0; k < 5; ++k) {
    const ChunkData data = reader.read(k);
    EXPECT_EQ(to_ns(reader.time(k)), static_cast<std::int64_t>(1000 * k));
    EXPECT_EQ(data.column_count(), 7u);
    EXPECT_EQ(all_bytes(data), all_bytes(example(k)));
    EXPECT_EQ(data.value<std::int32_t>(6), -7);
  }
}

TEST(ChunkFile, RoundTripsWithNoChunkAndWithAnEmptyChunk) {
  const tests::TemporaryFolder folder;
  write_example(folder / "none.chunks", 0);
  EXPECT_EQ(ChunkReader(folder / "none.chunks").size(), 0u);
  {
    ChunkWriter writer(folder / "empty.chunks");
    writer.append(time_from_ns(1), ChunkData());
    writer.finish();
  }
  EXPECT_EQ(ChunkReader(folder / "empty.chunks").read(0).column_count(), 0u);
}

TEST(ChunkFile, ManyThreadsMayReadAtOnce) {
  const tests::TemporaryFolder folder;
  write_example(folder / "a.chunks", 8);
  const ChunkReader reader(folder / "a.chunks");
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::uint64_t k = 0; k < 40; ++k)
        wrong[t] += all_bytes(reader.read((k + t) % 8)) != all_bytes(example((k + t) % 8));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(wrong, ::testing::Each(0));
}

TEST(ChunkFile, AnUnfinishedFileIsRefusedAndToldSo) {
  const tests::TemporaryFolder folder;
  {
    ChunkWriter writer(folder / "a.chunks");
    writer.append(time_from_ns(0), example(0));
  }  // no finish(): as after a crash
  EXPECT_THAT(message_of<DamagedFile>([&] { ChunkReader(folder / "a.chunks"); }),
              ::testing::AllOf(::testing::HasSubstr("a.chunks"), ::testing::HasSubstr("footer")));
}

TEST(ChunkFile, TruncationAtAnyByteIsRefused) {
  const tests::TemporaryFolder folder;
  write_example(folder / "a.chunks", 3);
  const std::size_t whole = std::filesystem::file_size(folder / "a.chunks");
  ASSERT_GT(whole, 3000u);
  for (std::size_t size = whole - 1; size > 0; --size) {
    std::filesystem::resize_file(folder / "a.chunks", size);
    EXPECT_THROW(ChunkReader(folder / "a.chunks"), DamagedFile) << size << " of " << whole << " bytes";
  }
}

TEST(ChunkFile, BytesAppendedAreRefused) {
  const tests::TemporaryFolder folder;
  write_example(folder / "a.chunks", 2);
  write_file(folder / "a.chunks", read_file(folder / "a.chunks") + "x");
  EXPECT_THROW(ChunkReader(folder / "a.chunks"), DamagedFile);
}

TEST(ChunkFile, AFlippedByteIsRefusedWhereverItIs) {
  const tests::TemporaryFolder folder;
  write_example(folder / "a.chunks", 2);
  const std::string whole = read_file(folder / "a.chunks");
  for (const std::size_t at : positions(whole.size(), 130, 17)) {
    put_byte(folder / "a.chunks", at, static_cast<char>(~whole[at]));
    EXPECT_THROW(read_whole(folder / "a.chunks"), DamagedFile) << "byte " << at << " of " << whole.size();
    put_byte(folder / "a.chunks", at, whole[at]);
  }
  EXPECT_NO_THROW(read_whole(folder / "a.chunks"));
}

TEST(ChunkFile, AFlippedBitNeverReadsAsOtherValues) {
  const tests::TemporaryFolder folder;
  write_example(folder / "a.chunks", 1);
  const std::string whole = read_file(folder / "a.chunks");
  const std::vector<char> values = read_whole(folder / "a.chunks");
  int undetected = 0;
  for (const std::size_t bit : positions(8 * whole.size(), 300, 61)) {
    put_byte(folder / "a.chunks", bit / 8, static_cast<char>(whole[bit / 8] ^ (1 << (bit % 8))));
    try {
      // zstd has a bit in its frame header that no decoder looks at: such a flip may pass, the values may not change.
      EXPECT_EQ(read_whole(folder / "a.chunks"), values) << "bit " << bit;
      ++undetected;
    } catch (const DamagedFile&) {
    }
    put_byte(folder / "a.chunks", bit / 8, whole[bit / 8]);
  }
  EXPECT_LE(undetected, 7) << "one a column at most";
}

TEST(ChunkFile, FilesOfAnotherKindAreRefused) {
  const tests::TemporaryFolder folder;
  for (const std::string& content :
       {std::string(), std::string("short"), std::string(10000, '\0'), std::string(10000, '\xff')}) {
    write_file(folder / "other", content);
    EXPECT_THROW(ChunkReader(folder / "other"), DamagedFile) << content.size();
  }
  EXPECT_THAT(message_of<DamagedFile>([&] { ChunkReader(folder / "absent"); }), ::testing::HasSubstr("absent"));
  EXPECT_THROW(ChunkWriter(folder / "no" / "such" / "file"), InputError);
}

TEST(ChunkFile, ColumnsOfAnotherTypeOrNumberAreRefused) {
  const ChunkData data = example(0);
  EXPECT_THROW(data.column<float>(0), DamagedFile);
  EXPECT_THROW(data.column<float>(7), DamagedFile);
  EXPECT_NO_THROW(data.column<float>(2));
}

TEST(ChunkDigest, IsOverDecodedValuesAndShapeNotOverTheirPacking) {
  // Alike values pack to other sizes in other columns, and equal bytes in other shapes are other data.
  const std::vector<std::uint16_t> pair = {0x0102, 0x0304};
  const std::vector<std::uint8_t> same_bytes = {0x02, 0x01, 0x04, 0x03};
  ChunkData as_shorts, as_bytes, in_two;
  as_shorts.add<std::uint16_t>(pair);
  as_bytes.add<std::uint8_t>(same_bytes);
  in_two.add<std::uint16_t>({pair.data(), 1});
  in_two.add<std::uint16_t>({pair.data() + 1, 1});
  EXPECT_NE(ChunkWriter::digest(as_shorts), ChunkWriter::digest(as_bytes));
  EXPECT_NE(ChunkWriter::digest(as_shorts), ChunkWriter::digest(in_two));
  EXPECT_EQ(ChunkWriter::digest(example(3)), ChunkWriter::digest(example(3)));
}

TEST(ChunkDigest, OfAFileDoesNotSeeHowChunksWereCompressed) {
  const tests::TemporaryFolder folder;
  const ChunkData data = example(0);
  const auto digest_with = [&](const std::vector<std::byte>& packed) {
    ChunkWriter writer(folder / "a.chunks");
    writer.append(time_from_ns(5), ChunkWriter::digest(data), packed);
    return writer.finish();
  };
  const std::vector<std::byte> packed = ChunkWriter::pack(data);
  std::vector<std::byte> other(packed.size() + 100);  // another packing, whatever it be
  EXPECT_EQ(digest_with(packed), digest_with(other));
}

TEST(ChunkDigest, ChangesWithEveryValueTimeAndOrder) {
  const tests::TemporaryFolder folder;
  const auto digest_of = [&](std::vector<std::pair<std::int64_t, float>> chunks) {
    ChunkWriter writer(folder / "a.chunks");
    for (const auto& [t_ns, value] : chunks) {
      ChunkData data;
      data.add_value(value);
      writer.append(time_from_ns(t_ns), data);
    }
    return writer.finish();
  };
  const std::uint64_t original = digest_of({{1, 1.0f}, {2, 2.0f}});
  EXPECT_EQ(digest_of({{1, 1.0f}, {2, 2.0f}}), original);
  EXPECT_NE(digest_of({{1, std::nextafter(1.0f, 2.0f)}, {2, 2.0f}}), original);
  EXPECT_NE(digest_of({{1, 1.0f}, {3, 2.0f}}), original);
  EXPECT_NE(digest_of({{1, 2.0f}, {2, 1.0f}}), original);
  EXPECT_NE(digest_of({{1, 1.0f}}), original);
}

}  // namespace
}  // namespace tarmac::core
