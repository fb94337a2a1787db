/// What became of one estimator's run: recorded whether it went well or not.
#pragma once

#include <filesystem>
#include <string>

namespace tarmac::tools {

struct Outcome {
  std::string estimator;
  /// ok | not_initialised | failed | crashed | killed | timed_out | out_of_memory | no_output | bad_output
  std::string status = "ok";
  std::string message;
  double wall_s = 0, cpu_s = 0, peak_memory_mb = 0;
  int threads = 1;
  std::string recording_hash;  ///< of the recording that it ran on
  /// Failed runs give exit code 3; a method that says that it cannot start is an answer, not a failure.
  bool failed() const { return status != "ok" && status != "not_initialised"; }
};

/// outcome.json, written last into an estimator's folder: without it the folder holds no finished run.
void save_outcome(const std::filesystem::path& estimator_folder, const Outcome& outcome);
Outcome load_outcome(const std::filesystem::path& estimator_folder);
bool has_outcome(const std::filesystem::path& estimator_folder);

}  // namespace tarmac::tools
