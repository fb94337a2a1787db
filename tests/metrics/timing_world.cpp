#include "tests/metrics/timing_world.h"

#include "core/random.h"
#include "metrics/residuals.h"
#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {

using namespace core;
using Eigen::Vector3d;

namespace {

constexpr int kColumns = 199, kRowsAColumn = 2;
constexpr double kColumn = TimingWorld::kSpan / (kColumns - 1);

std::int32_t ns(double s) {
  return static_cast<std::int32_t>(std::llround(1e9 * s));
}

/// A direction with more weight on the vertical, as on an apron: half of all surfaces are ground.
Vector3d some_normal(const RandomStream& random, std::uint64_t draw) {
  Vector3d n(random.normal(draw, 0), random.normal(draw, 1), 0.3 * random.normal(draw, 2));
  if (random.uniform(draw, 3) < 0.5) n << 0.03 * n.x(), 0.03 * n.y(), 1;
  return n.normalized();
}

Segment segment_of(const Method& method, int sweep, Time begin, const SE3& A) {
  using Shape = Method::Shape;
  const Time end = begin + duration_from_s(TimingWorld::kSpan);
  const auto pose = [&](double stamp_s) -> SE3 { return A * method.placed_by(sweep, stamp_s); };
  if (method.shape == Shape::held) return Segment::hold(begin, end, pose(0));
  if (method.shape == Shape::screw)
    return Segment::two_pose(SegmentModel::two_pose_screw, begin, pose(0), end, pose(TimingWorld::kSpan));
  std::vector<Time> times;
  std::vector<SE3> poses;
  for (int k = 0; k <= 20; ++k) {
    times.push_back(begin + duration_from_s(TimingWorld::kSpan) * k / 20);
    poses.push_back(pose(to_s(times.back() - begin)));
  }
  return Segment::sampled(SegmentModel::sampled_slerp, std::move(times), std::move(poses));
}

}  // namespace

TimingWorld::TimingWorld(std::uint64_t a_seed, int a_sweeps)
    : seed(a_seed), sweeps(a_sweeps), motion_(std::make_shared<Wobbly>(Time{}, time_from_s(1000))) {}

SE3 TimingWorld::truth(double t_s) const {
  return motion_->pose(time_from_s(t_s));
}

Evidence TimingWorld::examine(const Method& method, double noise_m) const {
  RowSet rows("causal");
  std::vector<Series> series;
  return examine(method, noise_m, rows, series);
}

Evidence TimingWorld::examine(const Method& method, double noise_m, RowSet& rows, std::vector<Series>& series) const {
  const RandomStream random(seed, "test/timing_world");
  Estimate estimate;
  std::vector<SweepDiagnostics> diagnostics;
  std::vector<LidarSweep> recorded;
  std::uint64_t draw = 0;
  for (int k = 0; k < sweeps; ++k) {
    const Time begin = time_from_s(begin_s(k)), end = begin + duration_from_s(kSpan);
    LidarSweep sweep;
    sweep.index = k;
    sweep.begin = begin;
    sweep.end = end;
    SweepDiagnostics record;
    record.index = k;
    // The registration puts the sweep's middle where it belongs.
    const SE3 A = truth(begin_s(k) + kSpan / 2) * method.placed_by(k, method.stamp_s(kSpan / 2)).inverse();
    for (int c = 0; c < kColumns; ++c) {
      const double t_s = c * kColumn, stamp_s = method.stamp_s(t_s);
      const SE3 T_true = truth(begin_s(k) + t_s), T = A * method.placed_by(k, 1e-9 * ns(stamp_s));
      for (int i = 0; i < kRowsAColumn; ++i, ++draw) {
        const double azimuth = -6.283 * t_s / kPeriod + 0.05 * random.normal(draw, 4);
        const double range = 4 + 26 * random.uniform(draw, 5);
        const Vector3d p(range * std::cos(azimuth), range * std::sin(azimuth), 2 * random.normal(draw, 6));
        const Vector3d n_map = T_true.linear() * some_normal(random, draw), n = T.linear().transpose() * n_map;
        ResidualRow row{.t_ns = ns(stamp_s), .weight = 1, .point = static_cast<std::uint32_t>(sweep.size())};
        row.value = static_cast<float>(n_map.dot(T * p - T_true * p) + noise_m * random.normal(draw, 7));
        Eigen::Map<Eigen::Matrix<float, 1, 6>>(row.jacobian) << n.cast<float>().transpose(),
            p.cross(n).cast<float>().transpose();
        record.surface.push_back(row);
        sweep.push_back(p.cast<float>(), ns(stamp_s), static_cast<std::uint16_t>(i), 1);
      }
    }
    SweepResult result{.index = k, .begin = begin, .end = end, .reference = end};
    result.T_map_body = A * method.placed_by(k, kSpan);
    // A method's reference pose does not show a wrong time inside the sweep.
    if (method.shape != Method::Shape::sampled) result.T_map_body = truth(begin_s(k) + kSpan);
    estimate.sweeps.push_back(result);
    estimate.causal.append(segment_of(method, k, begin, A));
    diagnostics.push_back(std::move(record));
    recorded.push_back(std::move(sweep));
  }
  const DiagnosticsSource source = diagnostics_of(diagnostics);
  const SweepSource sweep_source{recorded.size(), [&](std::size_t i) { return recorded[i]; }, {}, 0};
  return examine_residuals({.estimate = estimate, .sweeps = sweep_source, .diagnostics = &source}, {}, rows, series);
}

}  // namespace tarmac::metrics::tests
