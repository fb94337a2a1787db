/// Child programs: started in a process group of their own, watched, held to limits, and ended with us.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tarmac::tools {

/// What a child may use; 0 = no limit. Wall time and memory (resident) hold for all that it starts together, CPU time
/// for each process.
struct ChildLimits {
  double wall_s = 0, cpu_s = 0, memory_mb = 0;
  double file_mb = 0;  ///< of each file that it writes
};

struct ChildRequest {
  std::vector<std::string> command;  ///< program (a path, or a name to look up) and its arguments
  std::filesystem::path working_folder;
  std::filesystem::path log_file;  ///< standard output and error
  ChildLimits limits;
  std::string progress_argument;  ///< when not empty: this and a descriptor's number are appended
  std::function<void(double fraction, const std::string& note)> on_progress;  ///< from lines "progress 0.42 note"
};

struct ChildResult {
  /// killed: by a SIGKILL that was not ours, so that it says nothing of the program.
  enum class End { exited, signalled, killed, timed_out, out_of_memory, not_started } end = End::exited;
  int code = 0;  ///< exit code or signal number
  std::string message;
  double wall_s = 0, cpu_s = 0, peak_memory_mb = 0;
  bool ok() const { return end == End::exited && code == 0; }
};

/// Throws Interrupted after Ctrl-C, with the child ended. Ends the child when this process (or the calling thread) ends
/// first. May be called from several threads.
ChildResult run_child(const ChildRequest& request);

/// A folder of its own under the system's place for temporary files; removed with everything in it on destruction.
class PrivateFolder {
 public:
  PrivateFolder();
  /// The same below another folder.
  explicit PrivateFolder(const std::filesystem::path& below);
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The same files under another folder: by hard link where the file system allows, by copy elsewhere. Flat.
void lend_files(const std::filesystem::path& from, const std::filesystem::path& to);
/// The folder of the running program.
std::filesystem::path program_folder();

}  // namespace tarmac::tools
