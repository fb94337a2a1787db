// Beams as footprints: what an edge makes of them, and which rays may be left untraced.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/lidar/beam_field.h"
#include "tests/sim/lidar/beam_world.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;
using truth::ReturnKind;

const Mode kFootprintMode{2048, 10};
constexpr double near_m = 10, edge_y_m = 0.5;
constexpr float dark = 0.3f, bright = 0.6f;

/// A wall at 10 m left of y = 0.5, and one `gap_m` behind it everywhere.
scenes::Scene step(double gap_m) {
  scenes::Scene scene = tests::empty_scene();
  scene.materials = {tests::grey(0.3), tests::grey(0.6)};
  add_wall(scene, near_m, edge_y_m, 8, 3, 0);
  add_wall(scene, near_m + gap_m, -8, 20, 6, 1, scenes::Label::vehicle);
  return scene;
}

/// What a beam's rays meet in closed form: the rays of the footprint as its definition has them, by hand.
struct Expected {
  double near_signal = 0, near_moment = 0, far_signal = 0, far_moment = 0;
  double total() const { return near_signal + far_signal; }
};

Expected expected_of(const FiringTable& firing, const Cycle& cycle, std::size_t channel, double gap_m) {
  const Vector3d o = firing.origin(cycle), d = firing.direction(cycle, channel);
  const Vector3d left = Vector3d(-d.y(), d.x(), 0).normalized(), up = d.cross(left);
  const double half_rad = 0.5 * 3.14e-3, outer = std::exp(-std::log(2.0) * 0.36), sum = 1 + 6 * outer;
  Expected e;
  for (int k = -1; k < 6; ++k) {
    const double angle = k * M_PI / 3, a = k < 0 ? 0 : 0.6 * half_rad;
    const Vector3d ray = (d + a * std::cos(angle) * left + a * std::sin(angle) * up).normalized();
    const double w = (k < 0 ? 1 : outer) / sum, t_near = (near_m - o.x()) / ray.x();
    if (o.y() + t_near * ray.y() > edge_y_m) {
      e.near_signal += w * dark * ray.x();
      e.near_moment += w * dark * ray.x() * t_near;
    } else {
      const double t_far = (near_m + gap_m - o.x()) / ray.x();
      e.far_signal += w * bright * ray.x();
      e.far_moment += w * bright * ray.x() * t_far;
    }
  }
  return e;
}

struct Beam {
  Expected expected;
  std::vector<std::size_t> points;
};

/// Beams of sweep 0 that look at the walls, with their points in the sweep's order; firings are told by time and ring.
std::vector<Beam> beams_of(const SweepSimulator& simulator, const SimulatedSweep& s, double gap_m) {
  std::map<std::pair<std::int32_t, int>, std::vector<std::size_t>> points;
  for (std::size_t i = 0; i < s.sweep.size(); ++i) points[{s.sweep.t_ns[i], s.sweep.ring[i]}].push_back(i);
  const FiringTable& firing = simulator.firing();
  const SweepSpan span = firing.sweep(0);
  std::vector<Beam> beams;
  for (std::int64_t k = 0; k < span.cycles; ++k) {
    const Cycle cycle = firing.cycle(span, k);
    const auto t_ns = static_cast<std::int32_t>((cycle.t - span.begin).count());
    for (std::size_t c = 0; c < firing.channels(); ++c) {
      const Vector3d d = firing.direction(cycle, c);
      const double y = near_m * d.y() / d.x();
      if (d.x() < 0.9 || std::abs(d.z() / d.x() * near_m) > 2.5 || std::abs(y - edge_y_m) > 2) continue;
      beams.push_back({expected_of(firing, cycle, c, gap_m), points[{t_ns, firing.ring(c)}]});
    }
  }
  return beams;
}

double range_of(const SimulatedSweep& s, std::size_t i) {
  return s.true_range_m[i] - profile(kSensor).range_offset_m;
}

float intensity_of(double signal) {
  return std::floor(static_cast<float>(100 * signal) + 0.5f);
}

BeamOptions seven(const std::string& returns) {
  BeamOptions beam;
  beam.rays = 7;
  beam.returns = returns;
  return beam;
}

TEST(Footprint, WallsThirtyCentimetresApartMakeOneMixedPointThatLeansToTheStronger) {
  constexpr double gap_m = 0.3;
  const SweepSimulator simulator =
      simulator_of(kSensor, kFootprintMode, step(gap_m), asking(seven("strongest")), no_noise());
  const SimulatedSweep s = simulator.sweep(0);
  std::size_t mixed = 0;
  for (const Beam& beam : beams_of(simulator, s, gap_m)) {
    ASSERT_EQ(beam.points.size(), 1u);
    const std::size_t i = beam.points[0];
    const Expected& e = beam.expected;
    EXPECT_NEAR(range_of(s, i), (e.near_moment + e.far_moment) / e.total(), 1e-6);
    EXPECT_NEAR(s.sweep.intensity[i], intensity_of(e.total()), 1);
    const bool both = e.near_signal > 0 && e.far_signal > 0;
    EXPECT_EQ(s.kind[i], both ? ReturnKind::mixed : ReturnKind::surface);
    EXPECT_EQ(s.instance[i], e.near_signal > e.far_signal ? 0u : 1u);
    mixed += both;
  }
  // 0.94 mrad on either side of the edge in beams 3.07 mrad apart: three in five rows have one.
  EXPECT_GT(mixed, 20u);
}

TEST(Footprint, WallsThreeMetresApartAreTwoEchoesEachWithItsShare) {
  constexpr double gap_m = 3;
  for (const std::string returns : {"first", "last", "strongest"}) {
    const SweepSimulator simulator =
        simulator_of(kSensor, kFootprintMode, step(gap_m), asking(seven(returns)), no_noise());
    const SimulatedSweep s = simulator.sweep(0);
    std::size_t edges = 0, at_near = 0;
    const Detection detection(profile(kSensor), 1, "test");
    for (const Beam& beam : beams_of(simulator, s, gap_m)) {
      ASSERT_EQ(beam.points.size(), 1u);
      const std::size_t i = beam.points[0];
      const Expected& e = beam.expected;
      const bool both = e.near_signal > 0 && e.far_signal > 0;
      const double t_near = e.near_moment / e.near_signal, t_far = e.far_moment / e.far_signal;
      bool is_near = e.far_signal == 0;
      if (both && returns == "first") is_near = true;
      if (both && returns == "last") is_near = false;
      if (both && returns == "strongest")
        is_near = detection.snr(e.near_signal, t_near) > detection.snr(e.far_signal, t_far);
      EXPECT_NEAR(range_of(s, i), is_near ? t_near : t_far, 1e-6) << returns;
      EXPECT_NEAR(s.sweep.intensity[i], intensity_of(is_near ? e.near_signal : e.far_signal), 1) << returns;
      EXPECT_EQ(s.kind[i], both ? ReturnKind::edge : ReturnKind::surface);
      edges += both;
      at_near += both && is_near;
    }
    EXPECT_GT(edges, 20u);
    if (returns == "strongest") {
      EXPECT_GT(at_near, 0u);
      EXPECT_LT(at_near, edges);
    }
  }
}

TEST(Footprint, DualReturnsAreTwoPointsOfOneFiringStrongestFirst) {
  constexpr double gap_m = 3;
  const SweepSimulator simulator =
      simulator_of(kSensor, kFootprintMode, step(gap_m), asking(seven("dual")), no_noise());
  const SimulatedSweep s = simulator.sweep(0);
  const Detection detection(profile(kSensor), 1, "test");
  std::size_t pairs = 0;
  for (const Beam& beam : beams_of(simulator, s, gap_m)) {
    const Expected& e = beam.expected;
    if (e.near_signal == 0 || e.far_signal == 0) {
      EXPECT_EQ(beam.points.size(), 1u);
      continue;
    }
    ++pairs;
    ASSERT_EQ(beam.points.size(), 2u);  // told apart by time and ring alone: both are the same
    EXPECT_EQ(beam.points[1], beam.points[0] + 1);
    const double t_near = e.near_moment / e.near_signal, t_far = e.far_moment / e.far_signal;
    const bool near_first = detection.snr(e.near_signal, t_near) > detection.snr(e.far_signal, t_far);
    EXPECT_NEAR(range_of(s, beam.points[0]), near_first ? t_near : t_far, 1e-6);
    EXPECT_NEAR(range_of(s, beam.points[1]), near_first ? t_far : t_near, 1e-6);
  }
  EXPECT_GT(pairs, 20u);
  EXPECT_TRUE(std::is_sorted(s.sweep.t_ns.begin(), s.sweep.t_ns.end()));
}

/// Ground with texture, boxes, a sphere, thin posts and a moving box.
scenes::Scene yard() {
  scenes::Scene scene = tests::empty_scene();
  scene.materials = {tests::grey(0.35), tests::grey(0.5), tests::grey(0.6)};
  scene.materials[0].has_relief = true;
  scene.relief = std::make_shared<tests::SineRelief>();
  tests::add_instance(scene, tests::square(80), tests::pose({0, 0, 0}), -1, scenes::Label::pavement);
  const auto with_material = [](scenes::Mesh mesh, std::uint16_t material) {
    std::fill(mesh.materials.begin(), mesh.materials.end(), material);
    return mesh;
  };
  tests::add_instance(scene, with_material(tests::box({5, 0.5, 4}), 1), tests::pose({12, 9, 4}, {0, 0, 0.3}));
  tests::add_instance(scene, with_material(tests::sphere(3, 40, 80), 2), tests::pose({-10, -6, 2}));
  for (int k = 0; k < 12; ++k)
    tests::add_instance(scene, with_material(tests::box({0.05, 0.05, 2}), 1),
                        tests::pose({20 * std::cos(k), 20 * std::sin(k), 2}));
  const auto drive = std::make_shared<tests::SteadyActor>();
  drive->p0_m = {14, -8, 1};
  drive->v_m_s = {0, 6, 0};
  tests::add_instance(scene, with_material(tests::box({2, 1, 1}), 2), tests::pose({0, 0, 0}),
                      tests::add_actor(scene, drive, 3), scenes::Label::vehicle);
  return scene;
}

tests::SteadyMotion driving() {
  tests::SteadyMotion motion;
  motion.v_m_s = {5, 0, 0};
  motion.omega_world_rad_s = {0, 0, 0.4};
  motion.p0_m = {0, 0, 2};
  return motion;
}

class Sensors : public testing::TestWithParam<std::string> {};

TEST_P(Sensors, LinesWithOneEchoAreBitForBitWhatTheyAreWithoutAnyOfThis) {
  BeamOptions last;
  last.returns = "last";
  const SweepSimulator plain = simulator_of(GetParam(), {}, yard(), asking({}), {}, 3, driving());
  const SweepSimulator beams = simulator_of(GetParam(), {}, yard(), asking(last), {}, 3, driving());
  const SimulatedSweep a = plain.sweep(1), b = beams.sweep(1);
  ASSERT_GT(a.sweep.size(), 1000u);
  EXPECT_EQ(a.sweep.x_m, b.sweep.x_m);
  EXPECT_EQ(a.sweep.y_m, b.sweep.y_m);
  EXPECT_EQ(a.sweep.z_m, b.sweep.z_m);
  EXPECT_EQ(a.sweep.t_ns, b.sweep.t_ns);
  EXPECT_EQ(a.sweep.ring, b.sweep.ring);
  EXPECT_EQ(a.sweep.intensity, b.sweep.intensity);
  EXPECT_EQ(a.instance, b.instance);
  EXPECT_EQ(a.true_range_m, b.true_range_m);
  EXPECT_EQ(a.cos_incidence, b.cos_incidence);
}

INSTANTIATE_TEST_SUITE_P(Profiles, Sensors,
                         testing::Values("vlp-16", "hdl-64e-s2", "xt-32", "ouster-os1-64-gen2", "livox-mid-40"),
                         [](const auto& sensor_case) {
                           std::string name = sensor_case.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// Three rows of which the lowest looks one cycle ahead of the others, into nothing: open is what has no neighbour.
TEST(Neighbours, SidesOnWhichTheSweepEndsAreOpen) {
  Neighbours neighbours;
  neighbours.set({{.cycles = 1, .channel = 1}, {.cycles = 0, .channel = 2}, {}});
  CentreField field;
  field.resize(12);
  std::vector<std::uint8_t> open;
  neighbours.look(field, {0}, open);
  const std::vector<std::uint8_t> want{side::left | side::below,
                                       side::left | side::below,
                                       side::left | side::above,  // the middle's lower one is before
                                       side::below,
                                       0,
                                       side::above,
                                       side::below,
                                       0,
                                       side::above,
                                       side::right | side::below | side::above,
                                       side::right,
                                       side::right | side::above};
  EXPECT_EQ(open, want);
}

TEST(Footprint, AdaptiveRaysGiveTheFullFootprintsPoints) {
  BeamOptions adaptive = seven("strongest"), full = adaptive;
  full.footprint = "full";
  const SimulatedSweep a =
      simulator_of(kSensor, kFootprintMode, yard(), asking(adaptive), no_noise(), 1, driving()).sweep(0);
  const SimulatedSweep f =
      simulator_of(kSensor, kFootprintMode, yard(), asking(full), no_noise(), 1, driving()).sweep(0);
  EXPECT_LT(a.split_beams, f.split_beams / 3);
  std::map<std::pair<std::int32_t, int>, double> ranges;
  for (std::size_t i = 0; i < f.sweep.size(); ++i) ranges[{f.sweep.t_ns[i], f.sweep.ring[i]}] = f.true_range_m[i];
  std::size_t differing = f.sweep.size() - std::min(f.sweep.size(), a.sweep.size());
  for (std::size_t i = 0; i < a.sweep.size(); ++i) {
    const auto at = ranges.find({a.sweep.t_ns[i], a.sweep.ring[i]});
    differing += at == ranges.end() || std::abs(at->second - a.true_range_m[i]) > 1e-3;
  }
  const double share = static_cast<double>(differing) / static_cast<double>(f.sweep.size());
  RecordProperty("differing_share", std::to_string(share));
  std::printf("split %zu of %zu beams; %.3f %% differ by more than 1 mm\n", a.split_beams, f.split_beams, 100 * share);
  EXPECT_LT(share, 0.005);
}

}  // namespace
}  // namespace tarmac::sim::lidar
