/// The exact motion of the rig, and what else only the simulator knows. Never linked into an estimator.
///
/// On disk, `truth/`: scenario.yaml (resolved: scene, motion, rig), motion.yaml (the motion block alone, with the class
/// of functions that it is made of), truth.tum (T_world_body at 1 kHz), rig.json (true extrinsics), faults.json, and
/// lidar<k>_labels.chunks: per sweep one chunk whose columns are per point of the recording: label (uint8), instance
/// (uint32, index into Scene::instances), moving (uint8, 1 = belongs to a moving actor), true firing time (int32 ns
/// from the true begin of the sweep; differs from the recording's only when a clock fault was injected); and two single
/// values: true begin and true end [int64 ns].
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/chunk_file.h"
#include "core/config.h"
#include "core/rig.h"
#include "core/trajectory.h"
#include "scenes/scene.h"

namespace tarmac::sim::truth {

/// Per point of one recorded sweep, in the recording's order.
struct PointLabels {
  core::Time begin, end;  ///< true times of the sweep's first and last firing
  std::vector<scenes::Label> label;
  std::vector<std::uint32_t> instance;
  std::vector<std::uint8_t> moving;
  std::vector<std::int32_t> t_ns;  ///< true firing time from `begin`
  core::Time time(std::size_t i) const { return begin + core::Duration(t_ns[i]); }
};
core::ChunkData to_chunk(const PointLabels& labels);
PointLabels labels_from_chunk(const core::ChunkData& chunk);

/// One injected fault as the log has it.
struct Fault {
  std::string kind;    ///< kebab-case; sim/faults/README.md lists them
  std::string sensor;  ///< "lidar0", "imu0"
  std::string detail;
  std::map<std::string, double> parameters = {};  ///< names carry their units: {"offset_ms", 5}
};

struct GroundTruth {
  std::shared_ptr<const core::SmoothTrajectory> motion;  ///< T_world_body(t), exact
  core::Rig rig;                                         ///< with true extrinsics
  std::vector<Fault> faults;
  std::string scenario;  ///< name
  std::uint64_t seed = 0;
  core::ConfigNode config;       ///< truth/scenario.yaml
  std::filesystem::path folder;  ///< empty when it was not loaded from disk

  /// Labels of every sweep of one LiDAR; throws InputError when they were not stored.
  std::vector<PointLabels> labels(std::size_t lidar = 0) const;
};

/// Rebuilds the motion from truth/scenario.yaml and its seed. Throws InputError when the folder is no truth.
GroundTruth load_ground_truth(const std::filesystem::path& truth_folder);

}  // namespace tarmac::sim::truth
