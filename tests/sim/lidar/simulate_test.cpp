// The whole simulator: scene, motion and rig in, recording and truth out.
#include "sim/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/recording.h"
#include "sim/truth/ground_truth.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"

namespace tarmac::sim {
namespace {

namespace fs = std::filesystem;
using core::ConfigNode;

constexpr const char* secret = "zebra-stand";  // stands in the scenario, and nowhere in a recording

scenes::Scene yard() {
  scenes::Scene scene = tests::empty_scene();
  scene.name = secret;
  tests::add_instance(scene, tests::square(80), tests::pose({0, 0, 0}), -1, scenes::Label::pavement);
  tests::add_instance(scene, tests::box({5, 0.5, 4}), tests::pose({12, 9, 4}), -1, scenes::Label::building);
  tests::add_instance(scene, tests::sphere(3, 20, 40), tests::pose({-10, -6, 2}), -1, scenes::Label::aircraft);
  const auto drive = std::make_shared<tests::SteadyActor>();
  drive->p0_m = {14, -8, 1};
  drive->v_m_s = {0, 6, 0};
  tests::add_instance(scene, tests::box({2, 1, 1}), tests::pose({0, 0, 0}), tests::add_actor(scene, drive, 3),
                      scenes::Label::vehicle);
  return scene;
}

SimulationInput input_of(const std::string& rig, std::uint64_t seed = 1, double duration_s = 0.55) {
  SimulationInput input;
  input.scenario_name = secret;
  input.seed = seed;
  input.duration = core::duration_from_s(duration_s);
  input.scene = std::make_shared<scenes::Scene>(yard());
  auto motion = std::make_shared<tests::SteadyMotion>();
  motion->v_m_s = {5, 0, 0};
  motion->omega_world_rad_s = {0, 0, 0.4};
  motion->length_s = duration_s;
  input.motion = motion;
  input.rig = ConfigNode::parse(rig, "test.yaml");
  input.resolved_scenario =
      "name: " + std::string(secret) + "\nseed: 1\nduration_s: 1\nscene: {kind: stand}\nmotion: {kind: still}\n";
  input.resolved_motion = "  kind: still\n";
  return input;
}

constexpr const char* small_rig = "lidar: {model: ouster-os1-64-gen2, columns: 512}\nimu: {rate_hz: 200}\n";

class Simulate : public testing::Test {
 protected:
  fs::path folder = fs::path(testing::TempDir()) /
                    ("tarmac_simulate_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  fs::path recording() const { return folder / "recording"; }
  fs::path truth() const { return folder / "truth"; }

  SimulationSummary run(const SimulationInput& input, int threads = 1) const {
    return simulate(input, {.threads = threads, .fast = false}, recording(), truth(),
                    [](double, const std::string&) {});
  }
  std::string label_bytes() const { return core::read_file(truth() / "lidar0_labels.chunks"); }
  void TearDown() override { fs::remove_all(folder); }
};

TEST_F(Simulate, GivesTheSameRecordingAtAnyNumberOfThreadsAndEveryTime) {
  const std::string hash = run(input_of(small_rig)).recording_hash;
  const std::string labels = label_bytes();
  for (const int threads : {2, 1, 3}) {
    EXPECT_EQ(run(input_of(small_rig), threads).recording_hash, hash) << threads;
    EXPECT_EQ(label_bytes(), labels) << threads;
  }
}

// The outer rays, the panes, the own body, light beside its beam, second returns and noise, per-point truth and faults.
constexpr const char* everything_rig =
    "lidar: {model: ouster-os1-64-gen2, columns: 512, beam: {rays: 7, returns: dual, glass: true, halo: true, "
    "saturation: true, range_walk_m: 0.005, range_noise: snr, false_alarms_per_shot: 0.001}}\n"
    "body: {kind: box}\nimu: {rate_hz: 200}\n";

TEST_F(Simulate, GivesTheSameRecordingAndTruthAtAnyNumberOfThreadsWithEverythingOn) {
  const auto input = [&] {
    SimulationInput result = input_of(everything_rig);
    scenes::Scene scene = yard();
    scenes::Material pane;
    pane.name = "pane";
    pane.diffuse = 0.005;
    pane.specular_f0 = 0.2;
    pane.ggx_alpha = 0.002;
    pane.transmission = 0.3;
    scene.materials.push_back(pane);
    scenes::Mesh mesh = tests::box({0.01, 4, 3});
    std::fill(mesh.materials.begin(), mesh.materials.end(), std::uint16_t{1});
    tests::add_instance(scene, mesh, tests::pose({8, 0, 3}), -1, scenes::Label::glass);
    result.scene = std::make_shared<scenes::Scene>(std::move(scene));
    result.point_truth = true;
    result.faults = ConfigNode::parse("lidar: {lost_packets: 0.05, clock_offset_ms: 2}\n", "test.yaml");
    return result;
  };
  const std::string hash = run(input()).recording_hash, labels = label_bytes();
  for (const int threads : {2, 3}) {
    EXPECT_EQ(run(input(), threads).recording_hash, hash) << threads;
    EXPECT_EQ(label_bytes(), labels) << threads;
  }
  const core::Recording read = core::Recording::open(recording());
  const core::ChunkReader chunks(truth() / "lidar0_labels.chunks");
  std::set<truth::ReturnKind> kinds;
  for (std::size_t k = 0; k < chunks.size(); ++k) {
    const truth::PointLabels points = truth::labels_from_chunk(chunks.read(k));
    EXPECT_TRUE(points.has_point_truth());
    EXPECT_EQ(points.label.size(), read.sweep(k).size());
    for (std::size_t i = 0; i < points.label.size(); ++i) {
      kinds.insert(points.kind[i]);
      if (points.kind[i] == truth::ReturnKind::self) {
        EXPECT_EQ(points.label[i], scenes::Label::own_body);
      }
      if (points.kind[i] == truth::ReturnKind::noise) {
        EXPECT_EQ(points.label[i], scenes::Label::none);
        EXPECT_EQ(std::hypot(points.normal_x[i], points.normal_y[i], points.normal_z[i]), 0);
      }
      EXPECT_EQ(std::isnan(points.cos_incidence[i]), points.kind[i] == truth::ReturnKind::noise);
    }
  }
  for (const auto kind : {truth::ReturnKind::self, truth::ReturnKind::noise, truth::ReturnKind::transmitted,
                          truth::ReturnKind::ghost, truth::ReturnKind::mixed})
    EXPECT_TRUE(kinds.contains(kind)) << truth::name_of(kind);
}

TEST_F(Simulate, StoresPointTruthOnRequestOnlyAndRecordsTheSame) {
  SimulationInput input = input_of(small_rig);
  const std::string plain = run(input).recording_hash;
  EXPECT_FALSE(truth::labels_from_chunk(core::ChunkReader(truth() / "lidar0_labels.chunks").read(0)).has_point_truth());
  input.point_truth = true;
  EXPECT_EQ(run(input).recording_hash, plain);
  const core::LidarSweep sweep = core::Recording::open(recording()).sweep(0);
  const truth::PointLabels points =
      truth::labels_from_chunk(core::ChunkReader(truth() / "lidar0_labels.chunks").read(0));
  ASSERT_EQ(points.true_range_m.size(), sweep.size());
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    EXPECT_NEAR(points.true_range_m[i], sweep.point(i).norm(), 0.35);  // noise of at most 5 cm, seven of its sigmas
    const Eigen::Vector3f n(points.normal_x[i], points.normal_y[i], points.normal_z[i]);
    EXPECT_NEAR(n.norm(), 1, 1e-5);
    EXPECT_GT(points.cos_incidence[i], 0);
    if (points.label[i] == scenes::Label::pavement) {
      EXPECT_NEAR(n.z(), 1, 1e-5);
    }
  }
}

TEST_F(Simulate, GivesAnotherRecordingForAnotherSeed) {
  EXPECT_NE(run(input_of(small_rig, 1)).recording_hash, run(input_of(small_rig, 2)).recording_hash);
}

TEST_F(Simulate, RecordsWholeSweepsAndImuSamplesOfTheWholeDuration) {
  const SimulationSummary summary = run(input_of(small_rig));
  const core::Recording read = core::Recording::open(recording());
  EXPECT_EQ(read.hash(), summary.recording_hash);
  ASSERT_EQ(read.sweep_count(), 5u);  // the sixth would end at 0.6 s
  EXPECT_EQ(summary.rays, 5u * 512 * 64);
  std::size_t points = 0;
  for (std::size_t k = 0; k < read.sweep_count(); ++k) {
    const core::LidarSweep sweep = read.sweep(k);
    EXPECT_EQ(core::to_ns(sweep.begin), static_cast<std::int64_t>(k) * 100'000'000);
    EXPECT_TRUE(std::is_sorted(sweep.t_ns.begin(), sweep.t_ns.end()));
    points += sweep.size();
  }
  EXPECT_EQ(points, summary.points);
  EXPECT_GT(points, summary.rays / 4);
  EXPECT_EQ(read.imu().size(), 110u);
  EXPECT_EQ(summary.isa, "avx2");
  EXPECT_GT(summary.trace_cpu_s, 0);
}

TEST_F(Simulate, RunsWithoutAnImu) {
  const SimulationSummary summary = run(input_of("lidar: {model: vlp-16}\n"));
  EXPECT_EQ(summary.imu_samples, 0u);
  const core::Recording read = core::Recording::open(recording());
  EXPECT_TRUE(read.rig().imus.empty());
  EXPECT_EQ(read.rig().lidars.at(0).model, "vlp-16");
}

TEST_F(Simulate, LabelsSayWhatEachPointHit) {
  run(input_of("lidar: {model: ouster-os1-64-gen2, columns: 512, noise: {range_scale: 0, channel_bias_scale: 0}}\n"));
  const SimulationInput input = input_of(small_rig);
  const core::Recording read = core::Recording::open(recording());
  const core::ChunkReader labels(truth() / "lidar0_labels.chunks");
  ASSERT_EQ(labels.size(), read.sweep_count());
  core::SE3 T_body_lidar = core::SE3::Identity();
  T_body_lidar.translation().z() = 1.9;
  std::size_t moving = 0;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const core::LidarSweep sweep = read.sweep(k);
    const truth::PointLabels label = truth::labels_from_chunk(labels.read(k));
    ASSERT_EQ(label.label.size(), sweep.size());
    EXPECT_EQ(label.begin, sweep.begin);
    EXPECT_EQ(label.end, sweep.end);
    EXPECT_EQ(label.t_ns, sweep.t_ns);
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      ASSERT_EQ(label.label[i], input.scene->instances.at(label.instance[i]).label);
      const bool on_ground = std::abs((input.motion->pose(sweep.time(i)) * T_body_lidar * sweep.point(i)).z()) < 2e-3;
      EXPECT_TRUE(on_ground || label.label[i] != scenes::Label::pavement);
      EXPECT_EQ(label.moving[i] == 1, label.label[i] == scenes::Label::vehicle);
      moving += label.moving[i];
    }
  }
  EXPECT_GT(moving, 20u);
}

TEST_F(Simulate, RecordingHoldsNothingOfTheTruth) {
  run(input_of(small_rig, 905172638));
  for (const auto& entry : fs::recursive_directory_iterator(recording())) {
    const std::string bytes = core::read_file(entry.path());
    for (const char* word : {secret, "905172638", "seed", "label", "instance", "truth", "scenario", "noise_scale"})
      EXPECT_EQ(bytes.find(word), std::string::npos) << entry.path() << " holds " << word;
  }
}

TEST_F(Simulate, InterruptedRunLeavesNoRecordingThatCouldBeTakenForWhole) {
  struct Interrupted {};
  const auto stop_half_way = [](double fraction, const std::string&) {
    if (fraction > 0.5) throw Interrupted{};
  };
  EXPECT_THROW(simulate(input_of(small_rig), {.threads = 2, .fast = false}, recording(), truth(), stop_half_way),
               Interrupted);
  EXPECT_THROW(core::Recording::open(recording()), core::InputError);
}

TEST_F(Simulate, ReportsProgressWithRaysAndRealTimeFactor) {
  std::vector<double> fractions;
  std::string last;
  simulate(input_of(small_rig), {.threads = 2, .fast = false}, recording(), truth(),
           [&](double fraction, const std::string& note) {
             fractions.push_back(fraction);
             last = note;
           });
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_DOUBLE_EQ(fractions.back(), 1);
  EXPECT_NE(last.find("Mrays/s"), std::string::npos) << last;
  EXPECT_NE(last.find("x real time"), std::string::npos) << last;
}

TEST_F(Simulate, DurationBelowOneSweepIsRefused) {
  EXPECT_THROW(run(input_of(small_rig, 1, 0.05)), core::InputError);
}

std::string complaint_about(const std::string& rig) {
  try {
    resolve_rig(ConfigNode::parse(rig, "test.yaml"));
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Rig, MistakesAreNamedWithLineFieldAndWhatIsAllowed) {
  const std::string typo = complaint_about("lidar:\n  model: ouster-os1-64-gen1\n");
  EXPECT_NE(typo.find("test.yaml:2"), std::string::npos) << typo;
  EXPECT_NE(typo.find("did you mean 'ouster-os1-64-gen2'?"), std::string::npos) << typo;
  const std::string mode = complaint_about("lidar: {columns: 1000}\n");
  EXPECT_NE(mode.find("test.yaml:1"), std::string::npos) << mode;
  EXPECT_NE(mode.find("1024x10"), std::string::npos) << mode;
  EXPECT_NE(complaint_about("lidar: {modell: vlp-16}\n").find("model"), std::string::npos);
  EXPECT_NE(complaint_about("lidar: {noise: {range_scale: -1}}\n").find("at least 0"), std::string::npos);
  EXPECT_NE(complaint_about("imu: {rate_hz: 1000000}\n").find("at most"), std::string::npos);
}

TEST(Rig, MistakesInBeamsAndBodiesAreNamed) {
  const std::string rays = complaint_about("lidar:\n  beam:\n    rays: 5\n");
  EXPECT_NE(rays.find("test.yaml:3"), std::string::npos) << rays;
  EXPECT_NE(rays.find("1, 3 or 7"), std::string::npos) << rays;
  const std::string returns = complaint_about("lidar: {beam: {returns: both}}\n");
  EXPECT_NE(returns.find("dual"), std::string::npos) << returns;
  const std::string inside = complaint_about("lidar: {}\nbody: {kind: box, height_m: 2.5}\n");
  EXPECT_NE(inside.find("inside"), std::string::npos) << inside;
  const std::string width = complaint_about(
      "lidar:\n  model: mine\n  beam: {rays: 7}\n  profile: {timing: clock, cycle_us: 50, max_range_m: 100, "
      "range_step_m: 0.01, range_10_percent_m: 50, range_80_percent_m: 90, threshold_snr: 5, sigma_from_m: [0], "
      "sigma_m: [0.01], elevation_deg: [0], azimuth_offset_cw_deg: [0]}\n");
  EXPECT_NE(width.find("divergence_mrad"), std::string::npos) << width;
}

// What is read and then ignored would be believed in: each of these is an error at its own line.
TEST(Rig, OptionsWithoutEffectAreRefused) {
  const auto refused = [](const std::string& lidar, const std::string& option) {
    const std::string error = complaint_about("lidar:\n" + lidar);
    EXPECT_NE(error.find(option + ": has no effect here"), std::string::npos) << lidar << error;
    EXPECT_NE(error.find("test.yaml:" + std::to_string(1 + std::count(lidar.begin(), lidar.end(), '\n'))),
              std::string::npos)
        << error;
  };
  const std::string prism = "  model: livox-mid-40\n";
  refused(prism + "  beam: {halo: true}\n", "halo");
  refused(prism + "  beam: {rays: 7, footprint: adaptive}\n", "footprint");
  refused("  beam: {footprint: full}\n", "footprint");
  for (const char* returns : {"first", "last", "dual"})
    refused("  beam: {returns: " + std::string(returns) + "}\n", "returns");
  refused("  beam: {pulse_length_ns: 8}\n", "pulse_length_ns");
  refused("  beam: {false_alarms_per_shot: 0.001, pulse_length_ns: 8}\n", "pulse_length_ns");
  refused("  beam: {rays: 7, ghosts: false}\n", "ghosts");
  refused("  beam: {rays: 7, pane_flatness_deg: 0.1}\n", "pane_flatness_deg");
  refused("  beam: {saturation_signal: 30}\n", "saturation_signal");
  refused("  beam: {saturation_bias_m: 0.1}\n", "saturation_bias_m");
  refused("  beam: {rays: 7, spot_smear: 0.2}\n", "spot_smear");
  refused("  noise: {range_scale: 0}\n  beam: {rays: 7, range_noise: snr}\n", "range_noise");
  refused("  spin: {correlation_s: 2}\n", "correlation_s");
  EXPECT_NE(complaint_about("imu: {low_pass_hz: 80}\n").find("low_pass_hz: has no effect here"), std::string::npos);
}

TEST(Rig, OptionsWithAnEffectAreNot) {
  for (const char* beam :
       {"returns: dual, glass: true", "returns: dual, halo: true", "returns: dual, false_alarms_per_shot: 0.01",
        "rays: 3, returns: last, footprint: full, pulse_length_ns: 9", "glass: true, pulse_length_ns: 9, ghosts: false",
        "saturation: true, saturation_signal: 30", "rays: 3, range_noise: snr, spot_smear: 0.2"})
    EXPECT_EQ(complaint_about("lidar: {beam: {" + std::string(beam) + "}}\n"), "") << beam;
  // Behind prisms every ray is traced, and what is resolved says so.
  const std::string rig =
      resolve_rig(ConfigNode::parse("lidar: {model: livox-mid-40, beam: {rays: 3}}\n", "test.yaml"));
  EXPECT_NE(rig.find("footprint: full"), std::string::npos) << rig;
  EXPECT_EQ(complaint_about(rig), "");
}

TEST(Rig, ResolvedBlockReadsBackAsItself) {
  for (const char* rig : {"lidar: {model: vlp-16}\n", small_rig, "gravity_m_s2: 9.81\n", everything_rig}) {
    const std::string resolved = resolve_rig(ConfigNode::parse(rig, "test.yaml"));
    EXPECT_EQ(resolve_rig(ConfigNode::parse(resolved, "resolved.yaml")), resolved);
    EXPECT_EQ(resolved.find("imu:") != std::string::npos, std::string(rig).find("imu:") != std::string::npos);
  }
}

TEST(Catalogue, DescribesEverySensorAndRefusesOthers) {
  for (const CatalogueEntry& entry : lidar_catalogue()) {
    EXPECT_FALSE(entry.summary.empty());
    EXPECT_NE(describe_lidar(entry.name).find("elevation_deg"), std::string::npos);
  }
  EXPECT_THROW(describe_lidar("ouster"), core::InputError);
  EXPECT_EQ(lidar_catalogue().size(), 11u);
}

}  // namespace
}  // namespace tarmac::sim
