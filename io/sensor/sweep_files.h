/// What the plain format and KITTI's layout share: a folder of numbered binary files, one a sweep, and a text of
/// stamps.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/measurements.h"

namespace tarmac::io {

/// "000007.bin"; more digits from the millionth on.
std::string numbered(std::size_t k, std::string_view extension);
/// Files of that folder named by six or more digits and the extension; 0 when there is no such folder.
std::size_t count_numbered(const std::filesystem::path& folder, std::string_view extension);
/// Removes them: a sweep of an earlier, longer export must not be taken for one of this.
void remove_numbered(const std::filesystem::path& folder, std::string_view extension);
/// Throws core::InputError unless the folder's numbered files are as many as the stamps in `stamps_file`.
void check_count(const std::filesystem::path& folder, std::string_view extension, std::size_t stamps,
                 const std::filesystem::path& stamps_file);

/// Little-endian values; throws core::InputError when the size is no multiple of a record.
/// `record` says what one is: "x, y, z, intensity, t as float32".
std::vector<float> read_float_records(const std::filesystem::path& file, std::size_t floats_per_record,
                                      const char* record);
std::vector<std::uint16_t> read_uint16(const std::filesystem::path& file);
template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Creates the folder and those above it; throws core::InputError when that cannot be.
void make_folder(const std::filesystem::path& folder);

/// What the rate of ordered stamps is by the median of their steps [Hz]; `otherwise` when fewer than two steps forward.
double rate_hz(const std::vector<core::Time>& stamps, double otherwise);

}  // namespace tarmac::io
