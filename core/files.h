/// Files that are whole or absent.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace tarmac::core {

/// Writes beside the target and renames: a reader sees the old content or the new, never half of it.
void write_file(const std::filesystem::path& file, std::string_view content);
/// The same of a text too long to be held: `parts` hands it over piece by piece.
using WritePart = std::function<void(std::string_view)>;
void write_file_in_parts(const std::filesystem::path& file, const std::function<void(const WritePart&)>& parts);
/// Throws InputError naming the file when it cannot be read.
std::string read_file(const std::filesystem::path& file);
/// xxh3-64 of bytes as 16 hex digits.
std::string hash_hex(std::string_view bytes);
std::string hex16(std::uint64_t value);

}  // namespace tarmac::core
