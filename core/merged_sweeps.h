/// Several LiDARs as one: for each sweep of the first one a sweep of all, in the body's frame.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/measurements.h"
#include "core/recording.h"
#include "core/rig.h"

namespace tarmac::core {

/// Where a merged point comes from.
struct PointSource {
  std::uint16_t lidar = 0;  ///< index into Rig::lidars
  std::uint32_t sweep = 0;  ///< position in that LiDAR's stream
  std::uint32_t point = 0;  ///< in that sweep
};

/// A recording's LiDARs merged period by period. Merged sweep k has index and begin of the first LiDAR's k-th and holds
/// all its points; of the other LiDARs those that were fired from its begin until the first LiDAR's next sweep begins,
/// by the recording's stamps less the nominal clock offsets (`LidarSheet::clock_offset`; the first LiDAR's clock
/// counts). Where the first LiDAR has lost a sweep its period ends as if it had not, and what others saw in the gap is
/// left out, as is what they saw before its first sweep.
///
/// Points are in the body's frame by each LiDAR's nominal extrinsic. Each LiDAR's stay in their recorded order, and the
/// LiDARs' interleave by stamp, the first one's before the others' where stamps are equal. So where stamps never go
/// back, points are in order of firing time. Where they do (reversed, shuffled, jittered), a point waits for its
/// LiDAR's latest stamp so far: no LiDAR's firing order is lost, and `t_ns` then goes back as it does in that LiDAR's
/// own sweeps. Stamps that are wrong as a whole (an unknown offset, a wrong unit, none at all) interleave LiDARs
/// wrongly, and put points into the sweep that the stamps name; PointSource tells where they come from. `point_sensor`
/// tells whose they are, `ring` counts each LiDAR's own rings. `end` is the last firing of the first LiDAR's sweep, or
/// of the last point.
///
/// Any sweep may be asked for, from several threads. Keeps a reference to the recording.
class MergedSweeps {
 public:
  explicit MergedSweeps(const Recording& recording);

  std::size_t count() const;
  /// With `sources`: where each point comes from.
  LidarSweep sweep(std::size_t k, std::vector<PointSource>* sources = nullptr) const;
  /// One LiDAR whose frame is the body's; of the ranges the widest; IMUs as they are.
  const Rig& rig() const { return rig_; }
  /// Calls back as Recording::replay does, with merged sweeps.
  void replay(const std::function<void(std::size_t imu, const ImuSample&)>& on_imu,
              const std::function<void(const LidarSweep&)>& on_sweep) const;

 private:
  struct Gathered;
  Time period_end(std::size_t k, Time own_end) const;
  void gather(std::size_t lidar, std::size_t i, const LidarSweep& sweep, Time from, Time to, Gathered& into) const;

  std::shared_ptr<const LidarSweep> fetch(std::size_t lidar, std::size_t i) const;

  const Recording* recording_;
  Rig rig_;
  Duration period_;
  struct Kept;
  std::shared_ptr<Kept> kept_;  // the last few sweeps read: neighbours need the same ones
};

}  // namespace tarmac::core
