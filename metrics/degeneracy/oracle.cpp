#include "metrics/degeneracy/oracle.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "metrics/firing_poses.h"

namespace tarmac::metrics {

using namespace core;
using Eigen::Vector3d;
using sim::raycast::Hits;
using sim::raycast::Rays;
using sim::raycast::SweepTracer;
using sim::truth::GroundTruth;
using sim::truth::PointLabels;

namespace {

/// Static returns that are asked for a normal: indices into the sweep.
std::vector<std::size_t> choose(const LidarSweep& sweep, const PointLabels& labels, std::size_t most,
                                OracleSweep& result) {
  std::vector<std::size_t> all;
  double range_sum_m = 0;
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const double range_m = sweep.point(i).norm();
    if (labels.moving[i] || !std::isfinite(range_m) || !(range_m > 0)) continue;
    if (!sim::truth::on_a_surface(labels.kind_of(i))) continue;
    range_sum_m += range_m;
    all.push_back(i);
  }
  result.static_returns = all.size();
  if (!all.empty()) result.mean_range_m = range_sum_m / static_cast<double>(all.size());
  std::size_t step = (all.size() + most - 1) / std::max<std::size_t>(most, 1);
  if (step % 2 == 0) ++step;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < all.size(); k += step) chosen.push_back(all[k]);
  return chosen;
}

/// Where the sensors of a sweep truly are: of one LiDAR its pose on the body; of merged ones also what carries their
/// points, in the nominal body frame, to where they saw them.
struct Mountings {
  std::vector<SE3> T_body_lidar, T_body_true;

  Mountings(const SweepSource& sweeps, const Rig& truth) : T_body_true(sweeps.true_mountings(truth)) {
    if (!sweeps.merged()) T_body_lidar = {truth.lidars[sweeps.lidar].T_body_lidar};
    for (std::size_t k = 0; k < T_body_true.size(); ++k) T_body_lidar.push_back(truth.lidars.at(k).T_body_lidar);
  }
  bool merged() const { return !T_body_true.empty(); }
  /// Where beams are thought to leave from: the LiDAR, or of several the body's origin.
  Vector3d centre() const { return merged() ? Vector3d(0, 0, 0) : Vector3d(T_body_lidar[0].translation()); }
};

/// Beams from the LiDAR's origin to the measured points: where they end they coincide with the true beams, which leave
/// a few centimetres beside it.
Rays beams_to(const LidarSweep& sweep, const PointLabels& labels, std::span<const std::size_t> chosen,
              const SmoothTrajectory& motion, const Mountings& mountings, const Vector3d& base) {
  Rays rays;
  rays.resize(chosen.size());
  TruthPoses poses(motion, chosen.size());
  SE3 T_world_lidar;
  std::size_t last = 0;  // whose pose that is
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const std::size_t i = chosen[k], sensor = mountings.merged() ? sweep.sensor_of(i) : 0;
    const SE3& T_body_lidar = mountings.T_body_lidar.at(sensor);
    if (k == 0 || labels.t_ns[i] != rays.t_ns[k - 1] || sensor != last)
      T_world_lidar = poses.pose(labels.time(i)) * T_body_lidar;
    last = sensor;
    Vector3d p_lidar = sweep.point(i);
    if (mountings.merged()) p_lidar = T_body_lidar.inverse() * (mountings.T_body_true[sensor] * p_lidar);
    const Vector3d o = T_world_lidar.translation() - base;
    const Vector3d d = (T_world_lidar.linear() * p_lidar).normalized();
    rays.ox[k] = o.x();
    rays.oy[k] = o.y();
    rays.oz[k] = o.z();
    rays.dx[k] = d.x();
    rays.dy[k] = d.y();
    rays.dz[k] = d.z();
    rays.t_ns[k] = labels.t_ns[i];
  }
  return rays;
}

std::vector<std::uint32_t> tiles_of(std::size_t n) {
  std::vector<std::uint32_t> order((n + SweepTracer::tile - 1) / SweepTracer::tile * SweepTracer::tile,
                                   SweepTracer::no_ray);
  for (std::size_t k = 0; k < n; ++k) order[k] = static_cast<std::uint32_t>(k);
  return order;
}

OracleSweep oracle_sweep(const LidarSweep& sweep, const GroundTruth& truth, const Mountings& mountings,
                         double max_range_m, const PointLabels& labels, const sim::raycast::Tracer& tracer,
                         std::size_t most) {
  OracleSweep result;
  result.index = sweep.index;
  result.begin = labels.begin;
  result.end = labels.end;
  if (labels.t_ns.size() != sweep.size())
    throw InputError(
        fmt::format("sweep {} has {} points, and the truth labels of {}: they do not belong together; evaluate each "
                    "recording with the truth that was written beside it",
                    sweep.index, sweep.size(), labels.t_ns.size()));
  const std::vector<std::size_t> chosen = choose(sweep, labels, most, result);
  if (chosen.empty() || !truth.motion->covers(labels.begin) || !truth.motion->covers(labels.end)) return result;

  const Time middle = labels.begin + (labels.end - labels.begin) / 2;
  const SE3 T_world_body = truth.motion->pose(middle);
  result.p_world_body = T_world_body.translation();
  result.T_world_c = T_world_body * Eigen::Translation3d(mountings.centre());
  const double reach_m = 1.5 * max_range_m + 10;
  const SweepTracer traced = tracer.sweep(labels.begin, labels.end, result.T_world_c.translation(), reach_m);
  const Rays rays = beams_to(sweep, labels, chosen, *truth.motion, mountings, traced.base());
  Hits hits;
  traced.trace(rays, tiles_of(chosen.size()), hits);

  std::vector<SurfacePoint> points;
  result.points = chosen.size();
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const std::size_t i = chosen[k];
    if (hits.instance[k] == Hits::nothing || hits.instance[k] != labels.instance[i]) {
      ++result.disagreeing;
      continue;
    }
    const Vector3d o(rays.ox[k], rays.oy[k], rays.oz[k]), d(rays.dx[k], rays.dy[k], rays.dz[k]);
    points.push_back({traced.base() + o + hits.t_m[k] * d, Vector3d(hits.nx[k], hits.ny[k], hits.nz[k]),
                      ratio(labels.time(i), labels.begin, labels.end)});
  }
  result.blocks = analyse(exact_information(points, result.T_world_c), result.mean_range_m);
  return result;
}

}  // namespace

SweepInformation exact_information(std::span<const SurfacePoint> points, const SE3& T_world_c) {
  const SE3 T_c_world = T_world_c.inverse();
  SweepInformation information;
  for (const SurfacePoint& point : points) {
    const Vector3d p = T_c_world * point.p_world, n = T_c_world.linear() * point.n_world;
    Row6 J;
    J << n.transpose(), p.cross(n).transpose();
    information.add(J, 1, point.phase);
  }
  return information;
}

std::optional<double> OracleSweep::lambda_pose() const {
  return blocks ? std::optional(blocks->pose.min()) : std::nullopt;
}

std::optional<double> OracleSweep::lambda_difference() const {
  return blocks && blocks->difference ? std::optional(blocks->difference->min()) : std::nullopt;
}

Oracle make_oracle(const SweepSource& sweeps, const GroundTruth& truth, const std::vector<PointLabels>& labels,
                   const sim::raycast::Tracer& tracer, const OracleSettings& settings) {
  if (labels.size() != sweeps.count)
    throw InputError(
        fmt::format("the recording has {} sweeps and the truth labels of {}: they do not belong together; evaluate "
                    "each recording with the truth that was written beside it",
                    sweeps.count, labels.size()));
  const Mountings mountings(sweeps, truth.rig);
  double max_range_m = truth.rig.lidars.at(sweeps.lidar).max_range_m;
  if (sweeps.merged())
    for (const LidarSheet& lidar : truth.rig.lidars) max_range_m = std::max(max_range_m, lidar.max_range_m);
  Oracle oracle;
  oracle.sweeps.resize(sweeps.count);
  const int threads = std::max(1, settings.threads);
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, sweeps.count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i)
            oracle.sweeps[i] = oracle_sweep(sweeps.sweep(i), truth, mountings, max_range_m, labels[i], tracer,
                                            settings.points_per_sweep);
        },
        tbb::simple_partitioner());
  });
  return oracle;
}

}  // namespace tarmac::metrics
