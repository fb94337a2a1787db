/// Where beams leave from and point to while the head turns and its vehicle drives.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/lidar/firing.h"
#include "sim/lidar/sweep_motion.h"
#include "sim/raycast/tracer.h"

namespace tarmac::sim::lidar {

/// Directions as unit vectors of the sensor frame with the head at azimuth 0: one a channel, or one a firing.
struct BeamTable {
  std::vector<double> x, y, z;
  std::size_t size() const { return x.size(); }
  void push_back(const Eigen::Vector3d& beam);
  void clear();
};

/// The beams of one firing cycle: o = origin + dt rate, d = (R + dt S) b, for beams b of the head's frame.
struct CycleRays {
  Eigen::Matrix3d R, S;
  Eigen::Vector3d origin, rate;

  /// The sensor around the cycle's time: T(t + dt) = (p + v dt, R (I + hat(w) dt)), p relative to `base`.
  CycleRays(const BodyState& body, const core::SE3& T_body_lidar, const Eigen::Vector3d& base, const Cycle& cycle,
            const Eigen::Vector3d& origin_sensor);
  /// How far a beam's own origin, in the head's frame, moves the ray.
  Eigen::Vector3d shift(const Eigen::Vector3d& offset, double dt_s) const { return (R + dt_s * S) * offset; }
};

/// Cycles in a row, and the matrices that aim their beams.
struct AimedCycles {
  std::vector<Cycle> cycles;
  std::vector<CycleRays> rays;
  std::vector<std::int32_t> t_ns;  ///< of each cycle, from the sweep's begin
  BeamTable own;                   ///< one a firing, where beams differ from cycle to cycle; else empty
  void clear();
};

/// One cycle's beams.
struct BeamArrays {
  const double *x, *y, *z;
};

/// Turns the sensor's beams by -azimuth about z: azimuths are clockwise.
Eigen::Matrix3d turned_by(const Cycle& cycle);

/// The firing table as arrays over channels.
class Aim {
 public:
  Aim(const FiringTable& firing, const core::SE3& T_body_lidar);

  std::size_t channels() const { return beams_.size(); }
  const BeamTable& beams() const { return beams_; }  ///< one a channel
  BeamArrays beams(const AimedCycles& cycles, std::size_t k) const {
    return of_cycle(cycles.own.size() > 0 ? cycles.own : beams_, k);
  }
  const std::vector<Eigen::Vector3d>& origin_offset() const { return origin_offset_; }

  /// Cycles first, first + 1, ... of the sweep, seen from `base` [world].
  void cycles(const FiringTable& firing, const SweepSpan& span, const SweepMotion& motion, std::int64_t first,
              std::size_t count, const Eigen::Vector3d& base, AimedCycles& out) const;
  /// The same in the frame of the body, where nothing moves but the head.
  void body_cycles(const FiringTable& firing, const SweepSpan& span, std::int64_t first, std::size_t count,
                   AimedCycles& out) const;
  /// The rays of all channels, cycle after cycle.
  void rays(const FiringTable& firing, const AimedCycles& cycles, raycast::Rays& out) const;
  /// Directions of other beams that leave when and where the channels do (one a channel, or one a firing of these
  /// cycles); arrays of cycles x channels.
  void directions(const AimedCycles& cycles, const BeamTable& beams, double* dx, double* dy, double* dz) const;

 private:
  BeamArrays of_cycle(const BeamTable& table, std::size_t k) const {
    const std::size_t i = table.size() > channels() ? k * channels() : 0;
    return {&table.x[i], &table.y[i], &table.z[i]};
  }
  void add_cycle(const FiringTable& firing, const Cycle& cycle, const BodyState& body, const Eigen::Vector3d& base,
                 std::int32_t t_ns, AimedCycles& out) const;

  core::SE3 T_body_lidar_;
  BeamTable beams_;
  std::vector<double> offset_s_;
  std::vector<std::int32_t> offset_ns_;
  std::vector<Eigen::Vector3d> origin_offset_;  // of the beam from the cycle's origin, at azimuth 0 [m]
};

}  // namespace tarmac::sim::lidar
