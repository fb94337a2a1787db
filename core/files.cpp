#include "core/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/error.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace tarmac::core {

void write_file_in_parts(const std::filesystem::path& file, const std::function<void(const WritePart&)>& parts) {
  const std::filesystem::path part =
      file.parent_path() / fmt::format(".{}.part-{}", file.filename().string(), ::getpid());
  const auto fail = [&](const char* what) {
    const std::string why = std::strerror(errno);
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw InputError(fmt::format("{}: {}: {}; check that the folder exists, may be written to and has room",
                                 file.string(), what, why));
  };
  std::FILE* out = std::fopen(part.c_str(), "wb");
  if (!out) fail("cannot be created");
  bool written = true;
  try {
    parts([&](std::string_view content) {
      written = written && std::fwrite(content.data(), 1, content.size(), out) == content.size();
    });
  } catch (...) {
    std::fclose(out);
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
  written = written && std::fflush(out) == 0 && ::fsync(::fileno(out)) == 0;
  const bool closed = std::fclose(out) == 0;
  if (!written || !closed) fail("cannot be written");
  if (std::rename(part.c_str(), file.c_str()) != 0) fail("cannot be put in place");
}

void write_file(const std::filesystem::path& file, std::string_view content) {
  write_file_in_parts(file, [&](const WritePart& write) { write(content); });
}

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream content;
  if (!in || std::filesystem::is_directory(file) || !(in.peek() == EOF || content << in.rdbuf())) {
    throw InputError(fmt::format("{}: cannot be read; check that the file exists and may be read", file.string()));
  }
  return content.str();
}

std::string hex16(std::uint64_t value) {
  return fmt::format("{:016x}", value);
}

std::string hash_hex(std::string_view bytes) {
  return hex16(XXH3_64bits(bytes.data(), bytes.size()));
}

}  // namespace tarmac::core
