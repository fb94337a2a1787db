/// An append-only file of chunks with its index as a footer, written last: a file without its footer is incomplete and
/// is refused. Chunks hold named columns, stored as zstd-compressed byte planes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/time.h"

namespace tarmac::core {

/// One chunk's content: columns of fixed-width elements, in the order in which they were added.
class ChunkData {
 public:
  template <class T>
  void add(std::span<const T> column) {
    add_bytes(sizeof(T), std::as_bytes(column));
  }
  template <class T>
  void add_value(const T& value) {
    add(std::span<const T>(&value, 1));
  }
  /// Column k as a vector of T; throws DamagedFile when there is none or its element size differs.
  template <class T>
  std::vector<T> column(std::size_t k) const {
    const std::span<const std::byte> bytes = column_bytes(k, sizeof(T));
    std::vector<T> values(bytes.size() / sizeof(T));
    copy_bytes(bytes, values.data());
    return values;
  }
  template <class T>
  T value(std::size_t k) const {
    return column<T>(k).at(0);
  }
  std::size_t column_count() const { return columns_.size(); }

 private:
  friend class ChunkWriter;
  friend class ChunkReader;
  struct Column {
    std::uint32_t element_size = 1;
    std::vector<std::byte> bytes;
  };
  void add_bytes(std::size_t element_size, std::span<const std::byte> bytes);
  std::span<const std::byte> column_bytes(std::size_t k, std::size_t element_size) const;
  static void copy_bytes(std::span<const std::byte> from, void* to);
  std::vector<Column> columns_;
};

class ChunkWriter {
 public:
  /// Creates or truncates the file. Throws InputError when it cannot be created.
  explicit ChunkWriter(const std::filesystem::path& path);
  ~ChunkWriter();  ///< without finish() the file stays incomplete, and readers refuse it
  ChunkWriter(const ChunkWriter&) = delete;
  ChunkWriter& operator=(const ChunkWriter&) = delete;

  /// Packed bytes of a chunk: pure, so that threads may pack while one writes.
  static std::vector<std::byte> pack(const ChunkData& data);
  /// Digest over the chunk's decoded values (not its compressed bytes).
  static std::uint64_t digest(const ChunkData& data);
  /// Appends; throws std::runtime_error naming the file when the disk is full. `t` is the chunk's time, for the index.
  void append(Time t, std::uint64_t digest, std::span<const std::byte> packed);
  void append(Time t, const ChunkData& data) { append(t, digest(data), pack(data)); }
  /// Writes the index footer and syncs. Returns the digest over all chunks' digests and times.
  std::uint64_t finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class ChunkReader {
 public:
  /// Throws DamagedFile (file, what is missing, what to do) when the footer is absent or wrong.
  explicit ChunkReader(const std::filesystem::path& path);
  ~ChunkReader();
  ChunkReader(const ChunkReader&) = delete;
  ChunkReader& operator=(const ChunkReader&) = delete;

  std::size_t size() const;
  Time time(std::size_t i) const;
  /// Throws DamagedFile when the stored bytes do not decode to the stored digest. May be called from several threads.
  ChunkData read(std::size_t i) const;
  std::uint64_t digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarmac::core
