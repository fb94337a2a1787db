/// One scanning LiDAR on a moving body: firing times to rays to echoes to points.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/measurements.h"
#include "core/trajectory.h"
#include "scenes/scene.h"
#include "sim/lidar/aim.h"
#include "sim/lidar/beam_model.h"
#include "sim/lidar/beam_options.h"
#include "sim/lidar/effects/echoes.h"
#include "sim/lidar/firing.h"
#include "sim/lidar/own_body.h"
#include "sim/lidar/profile.h"
#include "sim/lidar/receiver.h"
#include "sim/lidar/sweep_motion.h"
#include "sim/raycast/tracer.h"
#include "sim/truth/return_kind.h"

namespace tarmac::sim::lidar {

struct Mounting {
  std::uint16_t sensor = 0;                        ///< index into Rig::lidars; part of the names of random draws
  core::SE3 T_body_lidar = core::SE3::Identity();  ///< true
};

/// What is made beyond a plain sweep.
struct Requests {
  bool point_truth = false;  ///< true range, normal and incidence of every point
  BeamOptions beam;
  BodyOptions body;
  std::size_t batch_rays =
      1024;  ///< that are worked on at once: small enough for the second-level cache with all arrays
};

/// A sweep and, per point of it, what was hit.
struct SimulatedSweep {
  core::LidarSweep sweep;
  std::vector<std::uint32_t> instance;  ///< index into Scene::instances, or raycast::Hits::nothing
  std::vector<truth::ReturnKind> kind;
  /// As in truth::PointLabels; empty unless they were asked for.
  std::vector<double> true_range_m;
  std::vector<float> normal_x, normal_y, normal_z, cos_incidence;
  std::size_t rays = 0;         ///< beams that were fired
  std::size_t traced_rays = 0;  ///< rays of their footprints and beyond panes, where beams are more than lines
  std::size_t split_beams = 0;  ///< beams whose outer rays were traced
  double trace_cpu_s = 0;       ///< processor time inside the tracer
};

/// Arrays that a sweep is made in; keep one a thread and hand it from sweep to sweep.
struct Workspace {
  raycast::Rays rays;
  raycast::Hits hits;
  Echoes echoes;
  AimedCycles aimed;
  std::vector<float> x_m, y_m, z_m;  ///< points of all firings, in the sensor's frame
  std::vector<double> true_range_m;  ///< of all firings, before noise
  BeamWorkspace beams;
  Receiver::Scratch receiver;
  Returns firsts, seconds;
};

/// The rays of a whole sweep and the tiles they are traced in.
struct AimedSweep {
  raycast::SweepTracer tracer;
  raycast::Rays rays;
  std::vector<std::uint32_t> tiles;
};

/// Simulates sweeps in any order, on any number of threads at once: each is a function of its index alone.
///
/// A beam leaves from the pose of the body at its cycle's time (SweepMotion: within a micrometre of it); where channels
/// fire one after the other, the body's velocity and rate carry the pose over the rest of the cycle (first order; over
/// 35 microseconds the neglected second order is below a micrometre at 100 m), while the spin of the head is in the
/// beam table exactly.
class SweepSimulator {
 public:
  SweepSimulator(const Profile& profile, const Mode& mode, const Mounting& mounting, const NoiseOptions& noise,
                 std::uint64_t seed, std::shared_ptr<const raycast::Tracer> tracer,
                 std::shared_ptr<const scenes::Scene> scene, std::shared_ptr<const core::SmoothTrajectory> motion,
                 const Requests& requests = {});
  /// The same with a head that turns unevenly or fires at recorded times.
  SweepSimulator(const Profile& profile, FiringTable firing, const Mounting& mounting, const NoiseOptions& noise,
                 std::uint64_t seed, std::shared_ptr<const raycast::Tracer> tracer,
                 std::shared_ptr<const scenes::Scene> scene, std::shared_ptr<const core::SmoothTrajectory> motion,
                 const Requests& requests = {});

  const FiringTable& firing() const { return firing_; }
  /// Throws OutOfSpan when the motion does not cover the sweep.
  SimulatedSweep sweep(std::int64_t index) const;
  /// The same into arrays that exist already; what `out` held is gone.
  void sweep(std::int64_t index, Workspace& workspace, SimulatedSweep& out) const;
  /// A sweep's rays without tracing them.
  AimedSweep aimed(std::int64_t index) const;

 private:
  raycast::SweepTracer tracer_for(const SweepSpan& span) const;
  SweepMotion motion_of(const SweepSpan& span) const;
  void sweep_lines(const SweepSpan& span, Workspace& w, SimulatedSweep& out) const;
  void sweep_beams(const SweepSpan& span, Workspace& w, SimulatedSweep& out) const;
  void measure(const SweepSpan& span, std::int64_t first, Workspace& w) const;
  void place(const std::vector<double>& range_m, Workspace& w) const;
  std::size_t report(Workspace& w, std::size_t points, SimulatedSweep& out) const;
  bool reported(double range_m) const { return range_m >= profile_.min_range_m && range_m <= profile_.max_range_m; }
  void report_truth(const Workspace& w, std::size_t points, SimulatedSweep& out) const;
  std::size_t report_beams(Workspace& w, core::Time begin, std::size_t points, SimulatedSweep& out) const;
  void report_return(const Returns& returns, std::size_t i, std::size_t at, SimulatedSweep& out) const;
  Eigen::Vector3f point_of(const Workspace& w, std::size_t firing, double range_m) const;

  Profile profile_;
  FiringTable firing_;
  Mounting mounting_;
  NoiseOptions options_;
  Requests requests_;
  std::shared_ptr<const raycast::Tracer> tracer_;
  std::shared_ptr<const scenes::Scene> scene_;
  std::shared_ptr<const core::SmoothTrajectory> motion_;
  Reflectance reflectance_;
  Detection detection_;
  RangeNoise range_noise_;
  ChannelBias channel_bias_;
  Intensity intensity_;
  Aim aim_;
  std::vector<std::int32_t> offset_ns_;
  std::vector<std::uint16_t> ring_;
  Batches batches_;
  /// Where beams are more than lines.
  struct Beyond {
    BeamModel model;
    Receiver receiver;
  };
  std::shared_ptr<const Beyond> beyond_;
};

}  // namespace tarmac::sim::lidar
