#include "scenarios/writer_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/error.h"

namespace tarmac::scenarios {
namespace {
namespace fs = std::filesystem;

fs::path lock_file(const fs::path& work, const std::string& name) {
  return work / (name + ".lock");
}

/// Whether the path still names the open file: another process may have removed it between open() and flock().
bool same_file(int descriptor, const fs::path& file) {
  struct stat open_file {
  }, named{};
  return ::fstat(descriptor, &open_file) == 0 && ::stat(file.c_str(), &named) == 0 &&
         open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

/// The locked file, or -1 when another process holds it or has just removed it.
int lock(const fs::path& file, int flags) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC | flags, 0666);
  if (descriptor < 0) return -1;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && same_file(descriptor, file)) return descriptor;
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return -1;
}

void clear(const fs::path& path) {
  std::error_code ignored;  // what cannot be removed now (a child still writes there) is tried again by the next start
  fs::remove_all(path, ignored);
}

}  // namespace

WriterLock::WriterLock(const fs::path& work) : work_(work) {
  static std::atomic<int> count = 0;
  const ProcessIdentity process = this_process();
  std::error_code error;
  fs::create_directories(work_, error);
  for (int attempt = 0; !error && descriptor_ < 0; ++attempt) {
    // Of no other run of this store, ever: runs that are gone are looked up by their names too.
    name_ = fmt::format("run-{}-{}-{}-{}", process.boot.substr(0, 8), process.started_ticks, process.pid, count++);
    descriptor_ = lock(lock_file(work_, name_), O_CREAT);
    if (descriptor_ < 0 && (attempt > 1000 || (errno != EWOULDBLOCK && errno != ENOENT)))
      error = std::error_code(errno, std::generic_category());
  }
  if (!error) {
    fs::create_directory(folder(), error);
  }
  if (!error) return;
  if (descriptor_ >= 0) ::close(descriptor_);
  throw core::InputError(
      fmt::format("{}: nothing can be written there ({}); check that it may be written to and has room", work_.string(),
                  error.message()));
}

WriterLock::~WriterLock() {
  clear(folder());
  ::unlink(lock_file(work_, name_).c_str());
  ::close(descriptor_);
}

bool WriterLock::alive(const fs::path& work, const std::string& name) {
  const fs::path file = lock_file(work, name);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  // Shared, so that two that look at the same time do not take each other for the owner.
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0;
  ::close(descriptor);
  return held;
}

void WriterLock::remove_dead(const fs::path& work) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(work, ignored)) {
    const bool is_lock = entry.path().extension() == ".lock";
    const std::string name = is_lock ? entry.path().stem().string() : entry.path().filename().string();
    const fs::path file = lock_file(work, name);
    if (!fs::exists(file, ignored)) {
      if (!is_lock) clear(entry.path());
      continue;
    }
    const int descriptor = lock(file, 0);
    if (descriptor < 0) continue;
    clear(work / name);
    ::unlink(file.c_str());
    ::close(descriptor);
  }
}

ProcessIdentity this_process() {
  ProcessIdentity process;
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  process.host = host.data();
  process.pid = ::getpid();
  std::ifstream("/proc/sys/kernel/random/boot_id") >> process.boot;
  std::string stat;
  std::getline(std::ifstream("/proc/self/stat"), stat);
  // The name in brackets may hold spaces; the start is the twentieth field after it.
  std::istringstream fields(stat.substr(stat.rfind(')') + 1));
  std::string field;
  for (int i = 0; i < 20; ++i) fields >> field;
  process.started_ticks = std::strtoll(field.c_str(), nullptr, 10);
  return process;
}

}  // namespace tarmac::scenarios
