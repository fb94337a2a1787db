#include "io/sensor/sweep_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <system_error>

#include "core/error.h"
#include "core/files.h"

namespace tarmac::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the formats are little-endian and read without swapping");

bool is_numbered(const std::filesystem::path& file, std::string_view extension) {
  const std::string stem = file.stem().string();
  return file.extension() == extension && stem.size() >= 6 &&
         std::all_of(stem.begin(), stem.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::vector<std::filesystem::path> numbered_files(const std::filesystem::path& folder, std::string_view extension) {
  std::vector<std::filesystem::path> files;
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(folder, absent)) {
    if (is_numbered(entry.path(), extension)) files.push_back(entry.path());
  }
  return files;
}

template <class T>
std::vector<T> read_values(const std::filesystem::path& file, std::size_t values_per_record, const char* record) {
  const std::string bytes = core::read_file(file);
  const std::size_t record_size = sizeof(T) * values_per_record;
  if (bytes.size() % record_size != 0) {
    throw core::InputError(
        fmt::format("{}: {} bytes: expected a multiple of {} ({}); the file is cut short or of another "
                    "format",
                    file.string(), bytes.size(), record_size, record));
  }
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

}  // namespace

std::string numbered(std::size_t k, std::string_view extension) {
  return fmt::format("{:06}{}", k, extension);
}

std::size_t count_numbered(const std::filesystem::path& folder, std::string_view extension) {
  return numbered_files(folder, extension).size();
}

void remove_numbered(const std::filesystem::path& folder, std::string_view extension) {
  for (const auto& file : numbered_files(folder, extension)) std::filesystem::remove(file);
}

void check_count(const std::filesystem::path& folder, std::string_view extension, std::size_t stamps,
                 const std::filesystem::path& stamps_file) {
  for (std::size_t k = 0; k < stamps; ++k) {
    const std::filesystem::path file = folder / numbered(k, extension);
    if (std::filesystem::exists(file)) continue;
    throw core::InputError(
        fmt::format("{}: missing; {} has {} lines, one a sweep", file.string(), stamps_file.string(), stamps));
  }
  const std::size_t files = count_numbered(folder, extension);
  if (files == stamps) return;
  throw core::InputError(fmt::format("{}: {} lines, but {} holds {} files *{}: expected one line a sweep",
                                     stamps_file.string(), stamps, folder.string(), files, extension));
}

std::vector<float> read_float_records(const std::filesystem::path& file, std::size_t floats_per_record,
                                      const char* record) {
  return read_values<float>(file, floats_per_record, record);
}

std::vector<std::uint16_t> read_uint16(const std::filesystem::path& file) {
  return read_values<std::uint16_t>(file, 1, "ring as uint16");
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && std::filesystem::is_directory(folder)) return;
  throw core::InputError(fmt::format("{}: cannot be made a folder: {}", folder.string(),
                                     error ? error.message() : "a file of that name is in the way"));
}

double rate_hz(const std::vector<core::Time>& stamps, double otherwise) {
  std::vector<core::Duration> steps;
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    if (stamps[k] > stamps[k - 1]) steps.push_back(stamps[k] - stamps[k - 1]);
  }
  if (steps.empty()) return otherwise;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return 1 / core::to_s(*middle);
}

}  // namespace tarmac::io
