/// One spinning LiDAR on a moving body: firing times to rays to echoes to points.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/measurements.h"
#include "core/trajectory.h"
#include "scenes/scene.h"
#include "sim/lidar/effects/echoes.h"
#include "sim/lidar/firing.h"
#include "sim/lidar/profile.h"
#include "sim/raycast/tracer.h"

namespace tarmac::sim::lidar {

struct NoiseOptions {
  double range_scale = 1;
  double channel_bias_scale = 1;
  bool quantisation = true;
  bool dropout = true;
  bool intensity = true;
  void visit(core::OptionVisitor& v);
};

struct Mounting {
  std::uint16_t sensor = 0;                        ///< index into Rig::lidars; part of the names of random draws
  core::SE3 T_body_lidar = core::SE3::Identity();  ///< true
};

/// A sweep and, per point of it, what was hit.
struct SimulatedSweep {
  core::LidarSweep sweep;
  std::vector<std::uint32_t> instance;  ///< index into Scene::instances
  std::size_t rays = 0;
  double trace_cpu_s = 0;  ///< processor time inside the tracer
};

/// Simulates sweeps in any order, on any number of threads at once: each is a function of its index alone.
///
/// A beam leaves from the exact pose of the body at its cycle's time; where channels fire one after the other, the
/// body's velocity and rate carry the pose over the rest of the cycle (first order; over 35 microseconds the neglected
/// second order is below a micrometre at 100 m), while the spin of the head is in the beam table exactly.
class SweepSimulator {
 public:
  SweepSimulator(const Profile& profile, const Mode& mode, const Mounting& mounting, const NoiseOptions& noise,
                 std::uint64_t seed, std::shared_ptr<const raycast::Tracer> tracer,
                 std::shared_ptr<const scenes::Scene> scene, std::shared_ptr<const core::SmoothTrajectory> motion);
  /// The same with a head that turns unevenly or fires at recorded times.
  SweepSimulator(const Profile& profile, FiringTable firing, const Mounting& mounting, const NoiseOptions& noise,
                 std::uint64_t seed, std::shared_ptr<const raycast::Tracer> tracer,
                 std::shared_ptr<const scenes::Scene> scene, std::shared_ptr<const core::SmoothTrajectory> motion);

  const FiringTable& firing() const { return firing_; }
  /// Throws OutOfSpan when the motion does not cover the sweep.
  SimulatedSweep sweep(std::int64_t index) const;

 private:
  struct Workspace {
    raycast::Rays rays;
    raycast::Hits hits;
    Echoes echoes;
    std::vector<Cycle> cycles;
  };
  void aim(const SweepSpan& span, std::int64_t first, std::size_t cycles, const Eigen::Vector3d& base,
           Workspace& w) const;
  void measure(const SweepSpan& span, std::int64_t first, Workspace& w) const;
  void report(const SweepSpan& span, const Workspace& w, SimulatedSweep& out) const;

  Profile profile_;
  FiringTable firing_;
  Mounting mounting_;
  NoiseOptions options_;
  std::shared_ptr<const raycast::Tracer> tracer_;
  std::shared_ptr<const scenes::Scene> scene_;
  std::shared_ptr<const core::SmoothTrajectory> motion_;
  Reflectance reflectance_;
  Detection detection_;
  RangeNoise range_noise_;
  ChannelBias channel_bias_;
  Intensity intensity_;
  std::size_t batch_cycles_;
  std::vector<std::uint32_t> batch_tiles_;
};

}  // namespace tarmac::sim::lidar
