/// CT-ICP in the body's frame: sweep in, motion from the sweep's begin to its end out.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/measurements.h"
#include "estimators/blocks/elastic_sampler.h"
#include "estimators/blocks/voxel_map.h"
#include "estimators/ct_icp/effort.h"
#include "estimators/ct_icp/options.h"
#include "estimators/ct_icp/registration.h"
#include "estimators/ct_icp/sweep_span.h"

namespace tarmac::estimators {

/// The whole method: thin out, predict, register (several times where robust), judge, insert.
///
/// The two poses are the body's, and what is interpolated between them is the body's pose: the method's two poses are
/// the sensor's. The map is the body's frame at the first sweep that had enough points.
/// Source: Dellenbach et al., CT-ICP, ICRA 2022; upstream tags icra_2022 and d467813.
class CtOdometry {
 public:
  CtOdometry(const CtIcpOptions& options, const core::SE3& T_body_lidar);

  struct Step {
    core::Segment motion;  ///< two poses; one, held, for the first two sweeps and where stamps tell nothing
    core::Segment predicted;
    SweepSpan span;
    ElasticResult registration;
    int attempts = 0, level = 0;
    bool lost = false;  ///< motion is the prediction, nothing was added to the map
    bool regularised = false;
    bool inserted = false;
    Regularisers regularisers;  ///< that the registration had, where `regularised`
    ElasticSettings settings;   ///< of the last attempt
    MotionSize size;
    std::vector<std::pair<std::string, double>> stages_ms;
  };
  /// Parallel inside the calling task arena.
  Step add(const core::LidarSweep& sweep);

  const VoxelMap& map() const { return map_; }
  /// Of the last sweep's last attempt: what it was registered by. Associations are empty where there was no iteration.
  const std::vector<Keypoint>& keypoints() const { return keypoints_; }
  const std::vector<Association>& associations() const { return registration_.associations(); }
  const ElasticSampler& sampler() const { return sampler_; }

 private:
  struct Poses {
    core::SE3 begin = core::SE3::Identity(), end = core::SE3::Identity();
  };

  bool startup() const { return sweeps_ < options_.startup_sweeps; }
  Poses predict() const;
  core::Segment segment(const SweepSpan& span, const Poses& poses) const;
  Regularisers regularisers() const;
  void collect_keypoints(const core::LidarSweep& sweep, const SweepSpan& span);
  void register_sweep(const core::LidarSweep& sweep, Step& step);
  Verdict attempt(const core::LidarSweep& sweep, const Effort& effort, Step& step);
  void place_sample(const core::LidarSweep& sweep, const SweepSpan& span, const core::Segment& motion);
  void update_map(const core::LidarSweep& sweep, Step& step);
  void remember(const core::Segment& motion);

  CtIcpOptions options_;
  core::SE3 T_body_lidar_;
  ElasticSampler sampler_;
  ElasticRegistration registration_;
  VoxelMap map_;
  Caution caution_;
  int sweeps_ = 0;       ///< so far, from the one that started the map
  Poses last_, before_;  ///< of the two sweeps before
  std::vector<Keypoint> keypoints_;
  std::vector<Eigen::Vector3d> placed_map_m_;
};

}  // namespace tarmac::estimators
