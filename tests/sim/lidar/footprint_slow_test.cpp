// On the aircraft stand, with a sensor of 128 channels: what leaving rays untraced costs, and what it changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/config.h"
#include "scenes/registry.h"
#include "sim/lidar/sweep_simulator.h"
#include "sim/truth/motion.h"

namespace tarmac::sim::lidar {
namespace {

struct Difference {
  std::size_t beams = 0, missing = 0, over_1_mm = 0, over_range_step = 0, intensity = 0;
  double share(std::size_t count) const { return static_cast<double>(count) / static_cast<double>(beams); }
};

Difference difference_of(const SimulatedSweep& a, const SimulatedSweep& full) {
  std::map<std::pair<std::int32_t, int>, std::size_t> at;
  for (std::size_t i = 0; i < full.sweep.size(); ++i) at[{full.sweep.t_ns[i], full.sweep.ring[i]}] = i;
  Difference d;
  d.beams = full.rays;
  std::size_t matched = 0;
  for (std::size_t i = 0; i < a.sweep.size(); ++i) {
    const auto found = at.find({a.sweep.t_ns[i], a.sweep.ring[i]});
    if (found == at.end()) {
      ++d.missing;
      continue;
    }
    ++matched;
    const double off_m = std::abs(full.true_range_m[found->second] - a.true_range_m[i]);
    d.over_1_mm += off_m > 1e-3;
    d.over_range_step += off_m > 0.01;
    d.intensity += std::abs(full.sweep.intensity[found->second] - a.sweep.intensity[i]) > 1;
  }
  d.missing += full.sweep.size() - matched;
  return d;
}

TEST(AdaptiveFootprint, GivesTheFullOnesSweepsOfTheStandButForAFewBeamsInAThousand) {
  const core::ConfigNode node = core::ConfigNode::parse(
      "scene: {kind: stand}\nmotion: {kind: drive, rest_s: 0, start: {x_m: 20, y_m: 38, heading_deg: 180}, path: "
      "[{straight_m: 40}], speed: [{to_m_s: 6, peak_m_s2: 3}], stop_peak_m_s2: 3}\n",
      "test.yaml");
  const auto scene = std::make_shared<const scenes::Scene>(scenes::make_scene(node.child("scene"), 1));
  const std::shared_ptr<const core::SmoothTrajectory> motion =
      truth::make_motion(node.child("motion"), core::duration_from_s(6), scene->ground, 1);
  const auto tracer = std::make_shared<const raycast::Tracer>(scene, raycast::TracerSettings{});
  const Profile& p = profile("ouster-os1-128-rev7");
  const NoiseOptions quiet{
      .range_scale = 0, .channel_bias_scale = 0, .quantisation = false, .dropout = false, .intensity = false};
  core::SE3 T_body_lidar = core::SE3::Identity();
  T_body_lidar.translation() = Eigen::Vector3d(1.2, 0, 2);
  const auto simulator = [&](const char* footprint) {
    Requests requests;
    requests.point_truth = true;
    requests.beam.rays = 7;
    requests.beam.footprint = footprint;
    return SweepSimulator(p, mode_of(p, 2048, 10), {.sensor = 0, .T_body_lidar = T_body_lidar}, quiet, 1, tracer, scene,
                          motion, requests);
  };
  const SweepSimulator adaptive = simulator("adaptive"), full = simulator("full");
  for (const std::int64_t index : {5, 35}) {
    const SimulatedSweep a = adaptive.sweep(index), f = full.sweep(index);
    const Difference d = difference_of(a, f);
    std::printf(
        "sweep %d: %.1f %% of beams split, %.2f rays traced a beam; of all beams %.3f %% there in one only, %.3f %% "
        "off "
        "by more than 1 mm, %.3f %% by more than 1 cm, %.3f %% by more than a count of intensity\n",
        static_cast<int>(index), 100 * d.share(a.split_beams),
        static_cast<double>(a.traced_rays) / static_cast<double>(a.rays), 100 * d.share(d.missing),
        100 * d.share(d.over_1_mm), 100 * d.share(d.over_range_step), 100 * d.share(d.intensity));
    EXPECT_LT(a.traced_rays, f.traced_rays / 2);
    EXPECT_LT(d.share(d.missing), 0.002);
    EXPECT_LT(d.share(d.over_range_step), 0.005);
    EXPECT_LT(d.share(d.intensity), 0.01);
  }
}

}  // namespace
}  // namespace tarmac::sim::lidar
