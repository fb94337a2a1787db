// File layout (docs/formats.md): header | chunk payloads | index | trailer, all little-endian.
//   header   8 bytes  "TRMCHNK1"
//   payload  per column: u32 element size, u64 element bytes, u64 stored bytes, stored bytes (zstd of byte planes)
//   index    per chunk: i64 t_ns, u64 offset, u64 size, u64 digest
//   trailer  u64 chunk count, u64 index offset, u64 digest over the index's times and digests, 8 bytes "TRMFOOT1"
#include "core/chunk_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/error.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tarmac::core {
namespace {

static_assert(std::endian::native == std::endian::little, "chunk files are little-endian");

constexpr char kHeader[9] = "TRMCHNK1";
constexpr char kFooter[9] = "TRMFOOT1";
constexpr int kCompressionLevel = 1;

struct IndexEntry {
  std::int64_t t_ns;
  std::uint64_t offset, size, digest;
};
static_assert(sizeof(IndexEntry) == 32);

struct Trailer {
  std::uint64_t chunks, index_offset, digest;
  char magic[8];
};
static_assert(sizeof(Trailer) == 32);

template <class T>
void put(std::vector<std::byte>& out, const T& value) {
  const std::byte* bytes = reinterpret_cast<const std::byte*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof(T));
}

/// Element-wise bytes to byte planes: all first bytes, then all second bytes, ...; likewise back.
void to_planes(const std::byte* from, std::byte* to, std::size_t elements, std::size_t width) {
  for (std::size_t plane = 0; plane < width; ++plane) {
    for (std::size_t i = 0; i < elements; ++i) to[plane * elements + i] = from[i * width + plane];
  }
}
void from_planes(const std::byte* from, std::byte* to, std::size_t elements, std::size_t width) {
  if (elements == 0) return;  // a damaged width of an empty column would be counted through
  for (std::size_t plane = 0; plane < width; ++plane) {
    for (std::size_t i = 0; i < elements; ++i) to[i * width + plane] = from[plane * elements + i];
  }
}

std::uint64_t digest_of_index(const std::vector<IndexEntry>& index) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  for (const IndexEntry& entry : index) {
    XXH3_64bits_update(&state, &entry.t_ns, sizeof entry.t_ns);
    XXH3_64bits_update(&state, &entry.digest, sizeof entry.digest);
  }
  return XXH3_64bits_digest(&state);
}

}  // namespace

void ChunkData::add_bytes(std::size_t element_size, std::span<const std::byte> bytes) {
  columns_.push_back({static_cast<std::uint32_t>(element_size), {bytes.begin(), bytes.end()}});
}

std::span<const std::byte> ChunkData::column_bytes(std::size_t k, std::size_t element_size) const {
  if (k >= columns_.size())
    throw DamagedFile(fmt::format("a chunk has {} columns, column {} was wanted", columns_.size(), k));
  if (columns_[k].element_size != element_size) {
    throw DamagedFile(
        fmt::format("column {} has elements of {} bytes, {} were expected", k, columns_[k].element_size, element_size));
  }
  return columns_[k].bytes;
}

void ChunkData::copy_bytes(std::span<const std::byte> from, void* to) {
  if (!from.empty()) std::memcpy(to, from.data(), from.size());
}

struct ChunkWriter::State {
  std::filesystem::path path;
  std::FILE* file = nullptr;
  std::uint64_t offset = 0;
  std::vector<IndexEntry> index;

  void write(const void* bytes, std::size_t size) {
    if (std::fwrite(bytes, 1, size, file) != size) fail();
    offset += size;
  }
  [[noreturn]] void fail() const {
    throw std::runtime_error(
        fmt::format("{}: cannot be written: {}; check that the disk has room", path.string(), std::strerror(errno)));
  }
};

ChunkWriter::ChunkWriter(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  state_->path = path;
  state_->file = std::fopen(path.c_str(), "wb");
  if (!state_->file) {
    throw InputError(fmt::format("{}: cannot be created: {}; check that the folder exists and may be written to",
                                 path.string(), std::strerror(errno)));
  }
  state_->write(kHeader, 8);
}

ChunkWriter::~ChunkWriter() {
  if (state_->file) std::fclose(state_->file);
}

std::vector<std::byte> ChunkWriter::pack(const ChunkData& data) {
  std::vector<std::byte> out, planes;
  for (const ChunkData::Column& column : data.columns_) {
    planes.resize(column.bytes.size());
    to_planes(column.bytes.data(), planes.data(), column.bytes.size() / column.element_size, column.element_size);
    const std::size_t bound = ZSTD_compressBound(planes.size());
    put(out, column.element_size);
    put(out, static_cast<std::uint64_t>(column.bytes.size()));
    const std::size_t size_at = out.size();
    put(out, std::uint64_t{0});
    const std::size_t start = out.size();
    out.resize(start + bound);
    const std::size_t stored =
        ZSTD_compress(out.data() + start, bound, planes.data(), planes.size(), kCompressionLevel);
    if (ZSTD_isError(stored)) throw std::runtime_error(fmt::format("zstd: {}", ZSTD_getErrorName(stored)));
    out.resize(start + stored);
    const std::uint64_t stored_size = stored;
    std::memcpy(out.data() + size_at, &stored_size, sizeof stored_size);
  }
  return out;
}

std::uint64_t ChunkWriter::digest(const ChunkData& data) {
  XXH3_state_t state;
  XXH3_64bits_reset(&state);
  for (const ChunkData::Column& column : data.columns_) {
    const std::uint64_t shape[2] = {column.element_size, column.bytes.size()};
    XXH3_64bits_update(&state, shape, sizeof shape);
    XXH3_64bits_update(&state, column.bytes.data(), column.bytes.size());
  }
  return XXH3_64bits_digest(&state);
}

void ChunkWriter::append(Time t, std::uint64_t digest, std::span<const std::byte> packed) {
  const std::uint64_t offset = state_->offset;
  state_->write(packed.data(), packed.size());
  state_->index.push_back({to_ns(t), offset, packed.size(), digest});
}

std::uint64_t ChunkWriter::finish() {
  Trailer trailer{state_->index.size(), state_->offset, digest_of_index(state_->index), {}};
  std::memcpy(trailer.magic, kFooter, 8);
  if (!state_->index.empty()) state_->write(state_->index.data(), state_->index.size() * sizeof(IndexEntry));
  state_->write(&trailer, sizeof trailer);
  std::FILE* file = state_->file;
  state_->file = nullptr;
  const bool synced = std::fflush(file) == 0 && ::fsync(::fileno(file)) == 0;
  if (std::fclose(file) != 0 || !synced) state_->fail();
  return trailer.digest;
}

struct ChunkReader::State {
  std::filesystem::path path;
  int file = -1;
  std::vector<IndexEntry> index;
  std::uint64_t digest = 0;

  ~State() {
    if (file >= 0) ::close(file);
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw DamagedFile(fmt::format("{}: {}; the file was cut short or altered: make it again", path.string(), what));
  }
  void read_at(std::uint64_t offset, void* to, std::size_t size) const {
    std::size_t done = 0;
    while (done < size) {
      const ssize_t n = ::pread(file, static_cast<char*>(to) + done, size - done, static_cast<off_t>(offset + done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail(fmt::format("{} bytes at offset {} cannot be read", size, offset));
      done += static_cast<std::size_t>(n);
    }
  }
  void load_index() {
    struct stat info {};
    if (::fstat(file, &info) != 0) fail("its size cannot be read");
    const std::uint64_t size = static_cast<std::uint64_t>(info.st_size);
    char header[8];
    if (size < sizeof header + sizeof(Trailer)) fail(fmt::format("it has {} bytes, too few to be whole", size));
    read_at(0, header, sizeof header);
    if (std::memcmp(header, kHeader, 8) != 0) fail("it does not begin as a chunk file");
    Trailer trailer;
    read_at(size - sizeof trailer, &trailer, sizeof trailer);
    if (std::memcmp(trailer.magic, kFooter, 8) != 0) fail("its index footer is missing, so it was never finished");
    if (trailer.chunks > size / sizeof(IndexEntry) || trailer.index_offset > size ||
        trailer.index_offset + trailer.chunks * sizeof(IndexEntry) + sizeof trailer != size) {
      fail("its index does not fit its size");
    }
    index.resize(trailer.chunks);
    if (!index.empty()) read_at(trailer.index_offset, index.data(), index.size() * sizeof(IndexEntry));
    for (const IndexEntry& entry : index) {
      if (entry.offset > trailer.index_offset || entry.size > trailer.index_offset - entry.offset) {
        fail("a chunk lies outside the file");
      }
    }
    digest = digest_of_index(index);
    if (digest != trailer.digest) fail("its index does not match its digest");
  }
};

ChunkReader::ChunkReader(const std::filesystem::path& path) : state_(std::make_unique<State>()) {
  state_->path = path;
  state_->file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (state_->file < 0) {
    throw DamagedFile(fmt::format("{}: cannot be opened: {}; check that the file exists and may be read", path.string(),
                                  std::strerror(errno)));
  }
  state_->load_index();
}

ChunkReader::~ChunkReader() = default;

std::size_t ChunkReader::size() const {
  return state_->index.size();
}
Time ChunkReader::time(std::size_t i) const {
  return time_from_ns(state_->index.at(i).t_ns);
}
std::uint64_t ChunkReader::digest() const {
  return state_->digest;
}

ChunkData ChunkReader::read(std::size_t i) const {
  const IndexEntry& entry = state_->index.at(i);
  std::vector<std::byte> packed(entry.size), planes;
  if (!packed.empty()) state_->read_at(entry.offset, packed.data(), packed.size());
  ChunkData data;
  std::size_t at = 0;
  const auto take = [&](void* to, std::size_t size) {
    if (size > packed.size() - at) state_->fail(fmt::format("chunk {} ends inside a column", i));
    std::memcpy(to, packed.data() + at, size);
    at += size;
  };
  while (at < packed.size()) {
    ChunkData::Column column;
    std::uint64_t size = 0, stored = 0;
    take(&column.element_size, sizeof column.element_size);
    take(&size, sizeof size);
    take(&stored, sizeof stored);
    if (stored > packed.size() - at || column.element_size == 0 || size % column.element_size != 0 ||
        size != ZSTD_getFrameContentSize(packed.data() + at, stored)) {
      state_->fail(fmt::format("chunk {} has a column that does not fit", i));
    }
    planes.resize(size);
    const std::size_t got = ZSTD_decompress(planes.data(), planes.size(), packed.data() + at, stored);
    if (ZSTD_isError(got) || got != size) state_->fail(fmt::format("chunk {} cannot be decompressed", i));
    at += stored;
    column.bytes.resize(size);
    from_planes(planes.data(), column.bytes.data(), size / column.element_size, column.element_size);
    data.columns_.push_back(std::move(column));
  }
  if (ChunkWriter::digest(data) != entry.digest) state_->fail(fmt::format("chunk {} does not match its digest", i));
  return data;
}

}  // namespace tarmac::core
