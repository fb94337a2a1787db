/// Recordings by what made them: simulated once, shared by all estimators, all sweeps and all processes that name the
/// same folder, and removed, those unused for longest first, when they take more room than allowed.
///
///   ROOT/<key>/{recording/, truth/, world.json}    world.json is written last: without it there is no entry
///   ROOT/<key>.lock                                held exclusively while an entry is made or removed, shared in use
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace tarmac::tools {

/// An entry in use: while this lives, nobody removes it. Copies share it.
struct CachedRecording {
  std::filesystem::path folder;
  std::string recording_hash;
  bool made = false;  ///< it was not there before
  std::shared_ptr<void> in_use;

  std::filesystem::path recording() const { return folder / "recording"; }
  std::filesystem::path truth() const { return folder / "truth"; }
};

class RecordingCache {
 public:
  /// Makes the folder; removes what processes that are gone have left half made. `limit_gb`: 0 = no limit.
  RecordingCache(std::filesystem::path root, double limit_gb);

  /// The entry of that key. Where there is none, `make` fills a folder with recording/ and truth/ and returns the
  /// recording's hash; what it throws goes through, and leaves nothing. Another process that makes the same entry is
  /// waited for. Throws Interrupted after Ctrl-C.
  CachedRecording obtain(const std::string& key, const std::function<std::string(const std::filesystem::path&)>& make);

  /// Removes entries that nobody uses, longest unused first, until the limit holds; returns the bytes that are left.
  std::uintmax_t trim() const;

  const std::filesystem::path& root() const { return root_; }

 private:
  std::filesystem::path root_;
  double limit_gb_;
};

}  // namespace tarmac::tools
