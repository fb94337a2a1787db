/// Files that are whole or absent.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tarmac::core {

/// Writes beside the target and renames: a reader sees the old content or the new, never half of it.
void write_file(const std::filesystem::path& file, std::string_view content);
/// Throws InputError naming the file when it cannot be read.
std::string read_file(const std::filesystem::path& file);
/// xxh3-64 of bytes as 16 hex digits.
std::string hash_hex(std::string_view bytes);
std::string hex16(std::uint64_t value);

}  // namespace tarmac::core
