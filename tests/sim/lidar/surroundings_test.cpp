// What is near a beam: bright targets beside it, the own vehicle under it; and that batches leave no trace.
#include <gtest/gtest.h>

#include <cmath>

#include "core/config.h"
#include "core/error.h"
#include "tests/sim/lidar/beam_world.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;
using truth::ReturnKind;

const Mode kSurroundingsMode{2048, 10};

scenes::Scene with_retro(double x_m) {
  scenes::Scene scene = tests::empty_scene();
  scenes::Material tape = tests::grey(0.5);
  tape.retro = 5000;
  scene.materials = {tests::grey(0.05), tape};
  add_wall(scene, x_m, -0.5, 0.5, 0.4, 1);
  add_wall(scene, x_m + 8, -20, 20, 10, 0);
  return scene;
}

std::size_t halos(const SimulatedSweep& s, double x_m) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < s.sweep.size(); ++i) {
    if (s.kind[i] != ReturnKind::retro_halo) continue;
    ++count;
    const Vector3d p = s.sweep.point(i);
    EXPECT_NEAR(p.norm(), x_m, 0.05);  // at the bright target's range
    EXPECT_EQ(s.instance[i], 0u);
    // Off it, but by no more than 1.5 widths of a beam.
    const bool on_it = std::abs(p.y()) < 0.5 && std::abs(p.z()) < 0.4;
    EXPECT_FALSE(on_it);
    EXPECT_LT(std::abs(p.y()), 0.5 + 1.6 * 3.14e-3 * x_m);
    EXPECT_LT(std::abs(p.z()), 0.4 + 1.6 * 3.14e-3 * x_m);
  }
  return count;
}

TEST(Halo, BrightTargetsWithinThirtyMetresShowInTheBeamsBeside) {
  BeamOptions beam;
  beam.halo = true;
  EXPECT_GT(halos(simulator_of(kSensor, kSurroundingsMode, with_retro(12), asking(beam), no_noise()).sweep(0), 12), 5u);
  EXPECT_EQ(halos(simulator_of(kSensor, kSurroundingsMode, with_retro(31), asking(beam), no_noise()).sweep(0), 31), 0u);
  BeamOptions off;
  off.returns = "last";
  EXPECT_EQ(halos(simulator_of(kSensor, kSurroundingsMode, with_retro(12), asking(off), no_noise()).sweep(0), 12), 0u);
}

TEST(Halo, LeavesTheBeamsOwnEchoForTheLastReturn) {
  BeamOptions dual;
  dual.halo = true;
  dual.returns = "dual";
  const SimulatedSweep s = simulator_of(kSensor, kSurroundingsMode, with_retro(12), asking(dual), no_noise()).sweep(0);
  std::size_t pairs = 0;
  for (std::size_t i = 0; i + 1 < s.sweep.size(); ++i) {
    if (s.kind[i] != ReturnKind::retro_halo) continue;
    ++pairs;
    EXPECT_EQ(s.kind[i + 1], ReturnKind::surface);
    EXPECT_EQ(s.sweep.t_ns[i], s.sweep.t_ns[i + 1]);
    EXPECT_NEAR(s.sweep.point(i + 1).x(), 20, 1e-3);
  }
  EXPECT_GT(pairs, 5u);
}

scenes::Scene field() {
  scenes::Scene scene = tests::empty_scene();
  tests::add_instance(scene, tests::square(80), tests::pose({0, 0, 0}), -1, scenes::Label::pavement);
  return scene;
}

TEST(OwnBody, HidesWhatIsBelowItAndShowsItsRoof) {
  Requests requests = asking({});
  requests.body.kind = "box";
  requests.body.length_m = 4;
  requests.body.width_m = 2;
  requests.body.height_m = 1.5;
  requests.body.rear_overhang_m = 1;
  const core::SE3 T_body_lidar = tests::pose({1, 0, 2});
  tests::SteadyMotion motion;
  motion.v_m_s = {3, 1, 0};
  motion.omega_world_rad_s = {0, 0, 0.5};
  const SweepSimulator simulator =
      simulator_of(kSensor, kSurroundingsMode, field(), requests, no_noise(), 1, motion, T_body_lidar);
  const SimulatedSweep s = simulator.sweep(0);
  std::size_t self = 0;
  for (std::size_t i = 0; i < s.sweep.size(); ++i) {
    const Vector3d p = T_body_lidar * s.sweep.point(i), o = T_body_lidar * Vector3d(0, 0, 0.03618);
    // Where the beam passes the roof's height; the origin's circle of 16 mm moves that by a few centimetres.
    const Vector3d at_roof = o + (1.5 - o.z()) / (p.z() - o.z()) * (p - o);
    const double inside = std::min({at_roof.x() + 1, 3 - at_roof.x(), 1 - std::abs(at_roof.y())});
    if (s.kind[i] == ReturnKind::self) {
      ++self;
      EXPECT_EQ(s.instance[i], raycast::Hits::nothing);
      EXPECT_NEAR(p.z(), 1.5, 1e-4);
      EXPECT_GT(inside, -0.1);
    } else {
      EXPECT_LT(inside, 0.1);
      EXPECT_EQ(s.kind[i], ReturnKind::surface);
    }
  }
  EXPECT_GT(self, 1000u);
}

TEST(OwnBody, EquipmentStandsWithItsRearAtTheOverhang) {
  BodyOptions options;
  options.kind = "baggage-tractor";
  options.rear_overhang_m = 0.7;
  const scenes::Mesh mesh = body_mesh(options);
  float rear = 1e9f;
  for (const Eigen::Vector3f& v : mesh.vertices) rear = std::min(rear, v.x());
  EXPECT_NEAR(rear, -0.7, 1e-5);
  EXPECT_GT(mesh.triangles.size(), 100u);
}

TEST(OwnBody, UnknownKindsAndSensorsInsideAreRefused) {
  const core::ConfigNode node = core::ConfigNode::parse("body:\n  kind: bocks\n", "rig.yaml").child("body");
  BodyOptions options;
  node.read(options);
  try {
    check_body(node, options, core::SE3::Identity());
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rig.yaml:2"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("box"), std::string::npos) << error.what();
  }
  options.kind = "box";
  EXPECT_THROW(check_body(node, options, tests::pose({0, 0, 1})), core::InputError);
  EXPECT_NO_THROW(check_body(node, options, tests::pose({0, 0, 2})));
}

TEST(OwnBody, ASensorInsideASolidPartOfEquipmentIsRefusedWithTheBodysLine) {
  const core::ConfigNode node = core::ConfigNode::parse("body:\n  kind: ground-power-unit\n", "rig.yaml").child("body");
  BodyOptions options;
  node.read(options);
  try {
    check_body(node, options, tests::pose({0.6, 0, 1}));
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rig.yaml:1: body: "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("inside a solid part of ground-power-unit"), std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(check_body(node, options, tests::pose({0.6, 0, 2.5})));
}

TEST(OwnBody, SizesBesideEquipmentAreRefused) {
  const core::ConfigNode node =
      core::ConfigNode::parse("body:\n  kind: baggage-tractor\n  width_m: 3\n", "rig.yaml").child("body");
  try {
    gives_size(node);
    FAIL();
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rig.yaml:3: body.width_m: baggage-tractor"), std::string::npos)
        << error.what();
  }
}

/// Everything that there is, at once.
Requests everything() {
  Requests requests = asking({});
  requests.beam.rays = 7;
  requests.beam.returns = "dual";
  requests.beam.glass = requests.beam.halo = requests.beam.saturation = true;
  requests.beam.range_walk_m = 0.005;
  requests.beam.range_noise = "snr";
  requests.beam.false_alarms_per_shot = 1e-3;
  requests.body.kind = "box";
  return requests;
}

scenes::Scene everything_scene() {
  scenes::Scene scene = field();
  scenes::Material tape = tests::grey(0.5);
  tape.retro = 500;
  scene.materials = {tests::grey(0.3), pane(), tape};
  scene.materials[0].has_relief = true;
  scene.relief = std::make_shared<tests::SineRelief>();
  add_wall(scene, 10, -6, 6, 5, 1, scenes::Label::glass);
  add_wall(scene, 14, -20, 20, 5, 0);
  add_wall(scene, 9, 3, 3.4, 2, 2);
  tests::add_instance(scene, tests::sphere(3, 20, 40), tests::pose({-10, -6, 2}));
  const auto drive = std::make_shared<tests::SteadyActor>();
  drive->p0_m = {-8, 8, 1};
  drive->v_m_s = {6, 0, 0};
  tests::add_instance(scene, tests::box({2, 1, 1}), tests::pose({0, 0, 0}), tests::add_actor(scene, drive, 3),
                      scenes::Label::vehicle);
  return scene;
}

void expect_same(const SimulatedSweep& a, const SimulatedSweep& b) {
  EXPECT_EQ(a.sweep.x_m, b.sweep.x_m);
  EXPECT_EQ(a.sweep.z_m, b.sweep.z_m);
  EXPECT_EQ(a.sweep.t_ns, b.sweep.t_ns);
  EXPECT_EQ(a.sweep.ring, b.sweep.ring);
  EXPECT_EQ(a.sweep.intensity, b.sweep.intensity);
  EXPECT_EQ(a.instance, b.instance);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.true_range_m, b.true_range_m);
  EXPECT_EQ(a.normal_z, b.normal_z);
}

TEST(Everything, IsTheSameHoweverBatchesAreCutAndInWhateverOrderSweepsAreMade) {
  tests::SteadyMotion motion;
  motion.v_m_s = {5, 0, 0};
  motion.p0_m = {0, 0, 0};
  const core::SE3 T_body_lidar = tests::pose({1.2, 0, 2.0});
  const auto make = [&](const std::string& name, std::size_t batch_rays) {
    Requests requests = everything();
    requests.batch_rays = batch_rays;
    return simulator_of(name, {}, everything_scene(), requests, {}, 5, motion, T_body_lidar);
  };
  for (const std::string name : {"ouster-os1-64-gen2", "vlp-16", "livox-mid-40"}) {
    const SweepSimulator whole = make(name, 1024);
    Workspace workspace;
    SimulatedSweep second, first;
    whole.sweep(1, workspace, second);
    whole.sweep(0, workspace, first);
    ASSERT_GT(first.sweep.size(), 1000u);
    expect_same(first, whole.sweep(0));
    expect_same(second, whole.sweep(1));
    for (const std::size_t rays : {256u, 5000u}) expect_same(second, make(name, rays).sweep(1));
  }
}

TEST(Everything, ShowsEveryKindOfReturn) {
  const SweepSimulator simulator =
      simulator_of(kSensor, kSurroundingsMode, everything_scene(), everything(), {}, 5, {}, tests::pose({1.2, 0, 2.0}));
  const SimulatedSweep s = simulator.sweep(0);
  for (const ReturnKind kind : {ReturnKind::surface, ReturnKind::mixed, ReturnKind::edge, ReturnKind::dirt,
                                ReturnKind::transmitted, ReturnKind::ghost, ReturnKind::glint, ReturnKind::retro_halo,
                                ReturnKind::self, ReturnKind::saturated, ReturnKind::noise})
    EXPECT_GT(std::count(s.kind.begin(), s.kind.end(), kind), 0) << truth::name_of(kind);
}

}  // namespace
}  // namespace tarmac::sim::lidar
