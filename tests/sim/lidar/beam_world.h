/// A sensor that stands still at the origin, and what it sees of a small world.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/lidar/sweep_simulator.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"

namespace tarmac::sim::lidar {

inline constexpr const char* kSensor = "ouster-os1-64-gen2";

inline NoiseOptions no_noise() {
  return {.range_scale = 0, .channel_bias_scale = 0, .quantisation = false, .dropout = false, .intensity = false};
}

/// With point truth, so that tests can ask.
inline Requests asking(const BeamOptions& beam) {
  Requests requests;
  requests.point_truth = true;
  requests.beam = beam;
  return requests;
}

inline SweepSimulator simulator_of(const std::string& sensor, const Mode& mode, scenes::Scene scene,
                                   const Requests& requests, const NoiseOptions& noise, std::uint64_t seed = 1,
                                   const tests::SteadyMotion& motion = {},
                                   const core::SE3& T_body_lidar = core::SE3::Identity()) {
  const auto shared_scene = std::make_shared<const scenes::Scene>(std::move(scene));
  const auto tracer = std::make_shared<const raycast::Tracer>(shared_scene, raycast::TracerSettings{});
  const Profile& p = profile(sensor);
  return SweepSimulator(p, mode_of(p, mode.columns, mode.rate_hz), {.sensor = 0, .T_body_lidar = T_body_lidar}, noise,
                        seed, tracer, shared_scene, std::make_shared<tests::SteadyMotion>(motion), requests);
}

/// A wall square on the x axis at `x_m`, seen from the origin, over y in [y0, y1] and z in [-h, h].
inline void add_wall(scenes::Scene& scene, double x_m, double y0, double y1, double h, std::uint16_t material = 0,
                     scenes::Label label = scenes::Label::building) {
  scenes::Mesh mesh{.name = "wall", .vertices = {}, .triangles = {}, .materials = {}};
  for (const auto& [y, z] : {std::pair{y0, -h}, {y1, -h}, {y1, h}, {y0, h}})
    mesh.vertices.push_back(Eigen::Vector3d(x_m, y, z).cast<float>());
  tests::add_quad(mesh, 0, 3, 2, 1);
  mesh.materials.assign(2, material);
  tests::add_instance(scene, mesh, core::SE3::Identity(), -1, label);
}

inline scenes::Material pane(double f0 = 0.2, double transmission = 0.3) {
  scenes::Material m;
  m.name = "pane";
  m.diffuse = 0.005;
  m.specular_f0 = f0;
  m.ggx_alpha = 0.002;
  m.transmission = transmission;
  return m;
}

}  // namespace tarmac::sim::lidar
