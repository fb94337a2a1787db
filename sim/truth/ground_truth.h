/// The exact motion of the rig, and what else only the simulator knows. Never linked into an estimator.
///
/// On disk, `truth/`: scenario.yaml (resolved: scene, motion, rig), motion.yaml (the motion block alone, with the class
/// of functions that it is made of), truth.tum (T_world_body at 1 kHz), rig.json (true extrinsics), faults.json, and
/// lidar<k>_labels.chunks: per sweep one chunk whose columns are per point of the recording: label (uint8), instance
/// (uint32, index into Scene::instances), moving (uint8, 1 = belongs to a moving actor), true firing time (int32 ns
/// from the true begin of the sweep; differs from the recording's only when a clock fault was injected); then two
/// single values: true begin and true end [int64 ns]; then per point the kind of return (uint8; files of before it
/// existed have none, and all their points are of kind surface); then, only where they were asked for (`truth:
/// {per_point: true}`), true range (double, m), x, y, z of the surface's normal and cosine of incidence (float each).
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
#include "sim/truth/return_kind.h"

namespace tarmac::sim::truth {

/// Per point of one recorded sweep, in the recording's order.
struct PointLabels {
  /// The instance of points that are no return of the scene: the own vehicle, noise.
  static constexpr std::uint32_t no_instance = 0xffffffff;

  core::Time begin, end;  ///< true times of the sweep's first and last firing
  std::vector<scenes::Label> label;
  std::vector<std::uint32_t> instance;  ///< into Scene::instances, or no_instance
  std::vector<std::uint8_t> moving;
  std::vector<std::int32_t> t_ns;  ///< true firing time from `begin`
  std::vector<ReturnKind> kind;    ///< empty: all are of kind surface
  /// On request, otherwise empty. The range that the sensor would have told without noise, bias and rounding (counted
  /// as its raw ranges are; of a mixed point the mean that it lies at) [m]; unit normal of the surface, in the world,
  /// turned towards the sensor; cosine of incidence, relief included. Noise comes off no surface: its range is the
  /// drawn one, its normal 0, its incidence NaN.
  std::vector<double> true_range_m;
  std::vector<float> normal_x, normal_y, normal_z, cos_incidence;

  core::Time time(std::size_t i) const { return begin + core::Duration(t_ns[i]); }
  ReturnKind kind_of(std::size_t i) const { return kind.empty() ? ReturnKind::surface : kind[i]; }
  bool has_point_truth() const { return !true_range_m.empty(); }
  /// Keeps the points `kept` (ascending) of every column that there is.
  void keep_only(const std::vector<std::size_t>& kept);
};
core::ChunkData to_chunk(const PointLabels& labels);
/// What of a point's truth is read: the columns on request are twice as large as all the others together.
enum class Columns { labels, labels_and_point_truth };
PointLabels labels_from_chunk(const core::ChunkData& chunk, Columns columns = Columns::labels_and_point_truth);

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

  /// Labels of every sweep of one LiDAR; throws InputError when they were not stored. Without being asked for the
  /// columns on request stay on the disk.
  std::vector<PointLabels> labels(std::size_t lidar = 0, Columns columns = Columns::labels) const;
};

/// Rebuilds the motion from truth/scenario.yaml and its seed. Throws InputError when the folder is no truth.
GroundTruth load_ground_truth(const std::filesystem::path& truth_folder);

}  // namespace tarmac::sim::truth
