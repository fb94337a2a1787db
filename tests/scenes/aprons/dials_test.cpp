/// The open apron's dials on a small scale: 64 beams of 90 m from three places on the lane, three seeds. The full
/// experiment, with a simulated sensor, is scenarios/sweeps/open-apron-dials.yaml.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <numeric>

#include "metrics/degeneracy/oracle.h"
#include "tests/scenes/laws.h"

namespace tarmac::metrics {
namespace {

using Eigen::Vector3d;

sim::raycast::Rays fan_of_beams() {
  constexpr int channels = 64, columns = 256;
  constexpr double field_deg = 45;
  sim::raycast::Rays rays;
  rays.resize(static_cast<std::size_t>(channels) * columns);
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < channels; ++j) {
      const auto k = static_cast<std::size_t>(i * channels + j);
      const double azimuth = 2 * std::numbers::pi * i / columns;
      const double elevation = (field_deg * j / (channels - 1) - field_deg / 2) * std::numbers::pi / 180;
      rays.ox[k] = rays.oy[k] = rays.oz[k] = 0;
      rays.dx[k] = std::cos(elevation) * std::cos(azimuth);
      rays.dy[k] = std::cos(elevation) * std::sin(azimuth);
      rays.dz[k] = std::sin(elevation);
      rays.t_ns[k] = 0;
    }
  }
  return rays;
}

/// Smallest eigenvalue of exact point-to-plane residuals, as the oracle scales it.
double lambda_min(const scenes::Scene& scene, const sim::raycast::Tracer& tracer, double x_m) {
  constexpr double range_m = 90, sensor_m = 2;
  core::SE3 T_world_c = core::SE3::Identity();
  T_world_c.translation() = Vector3d(x_m, 0, scene.ground->height_m(x_m, 0) + sensor_m);
  const core::Time t = core::time_from_s(0);
  const auto traced = tracer.sweep(t, t + core::Duration(1'000'000), T_world_c.translation(), range_m);
  sim::raycast::Rays rays = fan_of_beams();
  const Vector3d from_base = T_world_c.translation() - traced.base();
  for (std::size_t k = 0; k < rays.size(); ++k) {
    rays.ox[k] = from_base.x();
    rays.oy[k] = from_base.y();
    rays.oz[k] = from_base.z();
  }
  std::vector<std::uint32_t> order(rays.size());
  std::iota(order.begin(), order.end(), 0U);
  sim::raycast::Hits hits;
  traced.trace(rays, order, hits);
  std::vector<SurfacePoint> points;
  double range_sum = 0;
  for (std::size_t k = 0; k < rays.size(); ++k) {
    if (hits.instance[k] == sim::raycast::Hits::nothing || hits.t_m[k] > range_m) continue;
    const Vector3d d(rays.dx[k], rays.dy[k], rays.dz[k]);
    points.push_back({T_world_c.translation() + hits.t_m[k] * d, Vector3d(hits.nx[k], hits.ny[k], hits.nz[k]), 0});
    range_sum += hits.t_m[k];
  }
  const auto blocks = analyse(exact_information(points, T_world_c), range_sum / static_cast<double>(points.size()));
  return blocks->pose.min();
}

/// Median over seeds of the median over three places.
double level(const std::string& options) {
  std::vector<double> seeds;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const auto scene = std::make_shared<const scenes::Scene>(
        scenes::make_scene(tests::laws::node_of("open-apron", "with_markings: false\n" + options), seed));
    const sim::raycast::Tracer tracer(scene, {});
    std::vector<double> places;
    for (const double x : {-45.0, -25.0, -5.0}) places.push_back(lambda_min(*scene, tracer, x));
    std::ranges::sort(places);
    seeds.push_back(places[1]);
  }
  std::ranges::sort(seeds);
  std::cout << options << ": " << seeds[2] << "\n";
  return seeds[2];
}

TEST(OpenApronDials, SmallestEigenvalueFallsAsClutterThinsOut) {
  double before = 1;
  for (const std::string per_ha : {"16", "4", "1", "0"}) {
    const double now = level("facade_distance_m: 0\nclutter_per_ha: " + per_ha + "\n");
    EXPECT_LT(now, before) << per_ha << " objects a hectare";
    before = now;
  }
}

TEST(OpenApronDials, SmallestEigenvalueFallsAsTheFacadeRecedes) {
  double before = 1;
  for (const std::string distance : {"15", "40", "70", "0"}) {  // 0: none
    const double now = level("clutter_per_ha: 0\nfacade_distance_m: " + distance + "\n");
    EXPECT_LT(now, before) << distance << " m";
    before = now;
  }
}

}  // namespace
}  // namespace tarmac::metrics
