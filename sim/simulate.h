/// Scene + motion + rig -> recording, with the truth beside it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/progress.h"
#include "core/trajectory.h"
#include "scenes/scene.h"
#include "sim/truth/body_box.h"

namespace tarmac::sim {

struct SimulationInput {
  std::string scenario_name;
  std::uint64_t seed = 1;
  core::Duration duration{0};
  std::shared_ptr<const scenes::Scene> scene;
  std::shared_ptr<const core::SmoothTrajectory> motion;
  core::ConfigNode rig;           ///< the scenario's `rig:` block: {lidar: {...}, imu: {...}, gravity_m_s2}
  std::string resolved_scenario;  ///< stored as truth/scenario.yaml
  truth::BodyBox body;            ///< of truth::body_box; collisions are looked for with it where `rig` gives no size
  std::string resolved_motion;    ///< of sim::truth::resolve_motion; stored as truth/motion.yaml
  core::ConfigNode faults;        ///< the scenario's `faults:` block; absent: nothing is wrong
  bool point_truth = false;       ///< store true range, normal and incidence of every point beside its label
};

struct SimulationSettings {
  int threads = 1;
  bool fast = false;  ///< lifts the pinned instruction set: faster, hashes then hold on one kind of CPU only
};

struct SimulationSummary {
  std::string recording_hash;
  std::size_t sweeps = 0;
  std::size_t rays = 0;
  std::size_t points = 0;
  std::size_t imu_samples = 0;
  double wall_s = 0;
  double cpu_s = 0;
  double trace_cpu_s = 0;       ///< of that inside the ray tracer
  double real_time_factor = 0;  ///< simulated seconds per wall second
  std::string isa;              ///< instruction set of the tracer: "avx2"
  int threads = 1;              ///< that were used: as asked for, at most the processors there are
};

/// How much a drive is, before it is simulated. `bytes`: what recording and truth about take on the disk where most
/// beams return something; open skies take less.
struct Workload {
  std::size_t sweeps = 0, rays = 0;
  double bytes = 0;
};
Workload workload_of(const core::ConfigNode& rig, core::Duration duration, bool point_truth = false);

/// Throws InputError when simulate() would refuse the input, and when something runs into something else
/// (collisions.h).
void check(const SimulationInput& input);

/// Writes `recording_folder` (finished last) and `truth_folder`. Same input, same bytes, at any number of threads.
/// Throws InputError for bad rig options; whatever `progress` throws leaves an incomplete recording that is refused.
SimulationSummary simulate(const SimulationInput& input, const SimulationSettings& settings,
                           const std::filesystem::path& recording_folder, const std::filesystem::path& truth_folder,
                           const core::Progress& progress);

/// The rig block with every option written out, indented by 2. Throws InputError for bad options.
std::string resolve_rig(const core::ConfigNode& rig);
/// The faults block likewise, checked against the rig; empty when the block is absent.
std::string resolve_faults(const core::ConfigNode& faults, const core::ConfigNode& rig);

/// What `tarmac list` and `tarmac describe` show.
struct CatalogueEntry {
  std::string name;
  std::string summary;
};
std::vector<CatalogueEntry> lidar_catalogue();
std::vector<CatalogueEntry> imu_catalogue();
/// A text of facts and the channel table; throws InputError with did-you-mean for an unknown name.
std::string describe_lidar(const std::string& name);
std::string describe_imu(const std::string& name);
std::vector<core::OptionDescription> describe_rig_options();
std::vector<core::OptionDescription> describe_fault_options();

}  // namespace tarmac::sim
