/// provenance.json: what made these results, and the command that makes them again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tarmac::tools {

struct Provenance {
  std::string scenario;  ///< name; empty for a foreign recording
  std::uint64_t seed = 0;
  std::string scenario_hash;  ///< of the resolved scenario
  std::string recording_hash;
  std::string recording;  ///< folder, relative to the run's folder where it lies inside it
  std::string truth;      ///< likewise; empty = none
  std::string command;    ///< reproduces the run
  std::string isa;        ///< the ray tracer's instruction set; empty when nothing was simulated
  std::string options;    ///< estimator options as YAML
  int threads = 1;
  double simulate_wall_s = 0, simulate_real_time_factor = 0, simulate_mrays_per_s = 0;
};

/// Adds build and machine, and writes it, last of a run's files.
void save_provenance(const std::filesystem::path& file, const Provenance& provenance);
Provenance load_provenance(const std::filesystem::path& file);

/// Quotes words for a shell where they need it.
std::string shell_command(const std::vector<std::string>& words);

}  // namespace tarmac::tools
