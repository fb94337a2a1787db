#include "tools/sweeps/recording_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "tools/tarmac/interrupt.h"

namespace tarmac::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kMark = "world.json";
constexpr double kBytesPerGb = 1e9;

/// A lock on a file; it goes with the process, however that ends.
class FileLock {
 public:
  explicit FileLock(const fs::path& file) : fd_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (fd_ < 0) {
      throw core::InputError(
          fmt::format("{}: cannot be opened: {}; check that the folder may be written to and has room", file.string(),
                      std::strerror(errno)));
    }
  }
  ~FileLock() { ::close(fd_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  bool try_exclusive() { return ::flock(fd_, LOCK_EX | LOCK_NB) == 0; }
  bool try_shared() { return ::flock(fd_, LOCK_SH | LOCK_NB) == 0; }

 private:
  int fd_;
};

std::uintmax_t bytes_below(const fs::path& folder) {
  std::uintmax_t sum = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) sum += entry.file_size();
  }
  return sum;
}

/// The recording's hash of a whole entry; empty when there is none.
std::optional<std::string> read_entry(const fs::path& folder, std::uintmax_t* bytes = nullptr) {
  const fs::path mark = folder / kMark;
  if (!fs::is_regular_file(mark)) return std::nullopt;
  try {
    const Json json = Json::parse(core::read_file(mark));
    if (bytes) *bytes = json.at("bytes").get<std::uintmax_t>();
    return json.at("recording_hash").get<std::string>();
  } catch (const nlohmann::json::exception& error) {
    throw core::DamagedFile(
        fmt::format("{}: cannot be read: {}; remove {}", mark.string(), error.what(), folder.string()));
  }
}

/// The entry's mark goes first: what is removed by half is no entry.
void remove_entry(const fs::path& folder) {
  fs::remove(folder / kMark);
  fs::remove_all(folder);
}

}  // namespace

RecordingCache::RecordingCache(fs::path root, double limit_gb) : root_(fs::absolute(root)), limit_gb_(limit_gb) {
  fs::create_directories(root_);
  std::vector<fs::path> halves;
  for (const auto& entry : fs::directory_iterator(root_)) {
    if (!entry.is_directory()) continue;
    if (entry.path().extension() == ".part" || !fs::exists(entry.path() / kMark)) halves.push_back(entry.path());
  }
  for (const fs::path& half : halves) {
    FileLock lock(root_ / (half.stem().string() + ".lock"));
    if (!lock.try_exclusive()) continue;  // somebody is at it
    if (half.extension() == ".part" || !fs::exists(half / kMark)) fs::remove_all(half);
  }
}

CachedRecording RecordingCache::obtain(const std::string& key,
                                       const std::function<std::string(const fs::path&)>& make) {
  const auto lock = std::make_shared<FileLock>(root_ / (key + ".lock"));
  const fs::path folder = root_ / key, part = root_ / (key + ".part");
  bool made = false;
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
    throw_if_interrupted();
    if (fs::exists(folder / kMark)) {
      if (!lock->try_shared()) continue;
      if (const auto hash = read_entry(folder)) {
        std::error_code not_ours;  // another user's entry can be read, but is not made younger
        fs::last_write_time(folder / kMark, fs::file_time_type::clock::now(), not_ours);
        return {folder, *hash, made, lock};
      }
      continue;  // it was removed before the lock was ours
    }
    if (!lock->try_exclusive()) continue;
    if (fs::exists(folder / kMark)) continue;
    fs::remove_all(folder);
    fs::remove_all(part);
    fs::create_directory(part);
    try {
      const std::string hash = make(part);
      const Json mark = {{"recording_hash", hash}, {"bytes", bytes_below(part)}};
      core::write_file(part / kMark, mark.dump() + "\n");
      fs::rename(part, folder);
      made = true;
    } catch (...) {
      std::error_code ignored;
      fs::remove_all(part, ignored);
      throw;
    }
  }
}

std::uintmax_t RecordingCache::trim() const {
  struct Entry {
    fs::file_time_type used;
    std::uintmax_t bytes;
    fs::path folder;
  };
  std::vector<Entry> entries;
  std::uintmax_t sum = 0;
  for (const auto& entry : fs::directory_iterator(root_)) {
    std::error_code error;
    const fs::file_time_type used = fs::last_write_time(entry.path() / kMark, error);
    std::uintmax_t bytes = 0;
    try {
      if (error || !read_entry(entry.path(), &bytes)) continue;
    } catch (const core::InputError&) {
      continue;  // another process is removing it
    }
    entries.push_back({used, bytes, entry.path()});
    sum += bytes;
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (limit_gb_ <= 0 || static_cast<double>(sum) <= limit_gb_ * kBytesPerGb) break;
    FileLock lock(root_ / (entry.folder.filename().string() + ".lock"));
    if (!lock.try_exclusive()) continue;
    remove_entry(entry.folder);
    sum -= entry.bytes;
  }
  return sum;
}

}  // namespace tarmac::tools
