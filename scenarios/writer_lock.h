/// A process that writes to a store shows that it is alive by a file that it keeps locked. The kernel lifts the lock
/// with the process, however that ends; a process number would be used again, and means nothing in another container.
///
///   DIR/work/<name>.lock   locked while the process lives
///   DIR/work/<name>/       its files that are not whole yet
#pragma once

#include <filesystem>
#include <string>

namespace tarmac::scenarios {

class WriterLock {
 public:
  /// Makes both. Throws InputError when the folder cannot be written.
  explicit WriterLock(const std::filesystem::path& work);
  /// Removes both.
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

  const std::string& name() const { return name_; }
  std::filesystem::path folder() const { return work_ / name_; }

  /// Whether the process of that name lives.
  static bool alive(const std::filesystem::path& work, const std::string& name);
  /// Removes what processes that are gone have left below `work`.
  static void remove_dead(const std::filesystem::path& work);

 private:
  std::filesystem::path work_;
  std::string name_;
  int descriptor_ = -1;
};

/// Of this process, for the list of writers.
struct ProcessIdentity {
  std::string host;
  std::int64_t pid = 0;
  std::int64_t started_ticks = 0;  ///< since the machine's start, /proc/self/stat
  std::string boot;                ///< of the machine, /proc/sys/kernel/random/boot_id
};
ProcessIdentity this_process();

}  // namespace tarmac::scenarios
