// Several LiDARs on one rig: from the scenario's block to recording, estimate and score.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "core/files.h"
#include "core/merged_sweeps.h"
#include "estimators/registry.h"
#include "estimators/run.h"
#include "metrics/controls.h"
#include "metrics/evaluate.h"
#include "sim/rig_options.h"
#include "sim/simulate.h"
#include "sim/truth/ground_truth.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"

namespace tarmac::sim {
namespace {

using core::ConfigNode;
using core::LidarSweep;
using core::Recording;
using core::SE3;
using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* quiet_noise =
    "noise: {range_scale: 0, channel_bias_scale: 0, quantisation: false, dropout: false, intensity: false}";

/// Walls and boxes all around, one of them moving.
std::shared_ptr<const scenes::Scene> yard() {
  scenes::Scene scene = tests::empty_scene();
  scene.name = "yard";
  tests::add_instance(scene, tests::square(80), tests::pose({0, 0, 0}), -1, scenes::Label::pavement);
  for (int k = 0; k < 9; ++k) {
    const double angle = 0.7 * k, r = 9 + 2.5 * (k % 4);
    tests::add_instance(scene, tests::box({2 + 0.4 * k, 1, 3}),
                        tests::pose({r * std::cos(angle), r * std::sin(angle) * 1.3, 2}, {0, 0, angle + 1.1}), -1,
                        scenes::Label::building);
  }
  const auto drive = std::make_shared<tests::SteadyActor>();
  drive->p0_m = {6, -6, 1};
  drive->v_m_s = {0, 3, 0};
  tests::add_instance(scene, tests::box({1, 0.5, 1}), tests::pose({0, 0, 0}), tests::add_actor(scene, drive, 3),
                      scenes::Label::vehicle);
  return std::make_shared<const scenes::Scene>(std::move(scene));
}

class MultiLidar : public testing::Test {
 protected:
  MultiLidar() { fs::create_directories(folder); }
  ~MultiLidar() override { fs::remove_all(folder); }

  SimulationInput input_of(const std::string& rig, double duration_s = 0.65, const std::string& faults = "") const {
    SimulationInput input;
    input.scenario_name = "yard";
    input.duration = core::duration_from_s(duration_s);
    input.scene = yard();
    auto motion = std::make_shared<tests::SteadyMotion>();
    motion->v_m_s = {2, 0.5, 0};
    motion->omega_world_rad_s = {0, 0, 0.4};
    motion->length_s = duration_s;
    input.motion = motion;
    const ConfigNode node = ConfigNode::parse("rig:\n" + rig + (faults.empty() ? "" : "faults: " + faults + "\n"),
                                              (folder / "test.yaml").string());
    input.rig = node.child("rig");
    if (!faults.empty()) input.faults = node.child("faults");
    input.resolved_scenario = "name: yard\nseed: 1\nduration_s: 1\nscene: {kind: stand}\nmotion: {kind: still}\n";
    input.resolved_motion = "  kind: still\n";
    return input;
  }
  Recording run(const SimulationInput& input, const std::string& name = "run", int threads = 2) const {
    simulate(input, {.threads = threads, .fast = false}, folder / name / "recording", folder / name / "truth",
             [](double, const std::string&) {});
    return Recording::open(folder / name / "recording");
  }
  truth::GroundTruth truth_of(const SimulationInput& input, const std::string& name = "run") const {
    truth::GroundTruth truth;
    truth.motion = input.motion;
    truth.rig = core::rig_from_json(core::read_file(folder / name / "truth" / "rig.json"), "rig.json");
    truth.folder = folder / name / "truth";
    return truth;
  }
  std::string refused(const std::string& rig, const std::string& faults = "") const {
    try {
      check(input_of(rig, 0.65, faults));
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "";
  }
  /// A sensor with some of a bundled one's channels.
  void write_part(const std::string& name, const std::string& of, std::size_t first, std::size_t last) const {
    lidar::Profile part = lidar::profile(of);
    for (const lidar::ChannelColumn& column : lidar::channel_columns()) {
      std::vector<double>& values = part.*column.values;
      if (!values.empty())
        values = {values.begin() + static_cast<std::ptrdiff_t>(first),
                  values.begin() + static_cast<std::ptrdiff_t>(last)};
    }
    std::ofstream(folder / (name + ".yaml")) << core::write_options(part);
  }

  fs::path folder = fs::path(testing::TempDir()) /
                    ("tarmac_multi_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(MultiLidar, TwoHalvesOfASensorMergeToThatSensorsSweep) {
  for (const char* sensor : {"ouster-os1-64-gen2", "vlp-16"}) {
    const std::size_t n = lidar::profile(sensor).channels();
    write_part("early", sensor, 0, n / 2);
    write_part("late", sensor, n / 2, n);
    const std::string at =
        std::string(", T_body_lidar: {xyz_m: [1.2, -0.3, 1.9], rpy_deg: [2, -3, 40]}, ") + quiet_noise + "}";
    const Recording whole = run(input_of("  lidar: {model: " + std::string(sensor) + at + "\n"), "whole");
    const Recording halves =
        run(input_of("  lidars: [{model: ./early.yaml" + at + ", {model: ./late.yaml" + at + "]\n"), "halves");
    const core::MergedSweeps merged(halves);
    ASSERT_EQ(merged.count(), whole.sweep_count());
    ASSERT_EQ(whole.sweep_count(), 6u);
    const SE3 T_body_lidar = whole.rig().lidars[0].T_body_lidar;
    for (std::size_t k = 0; k < merged.count(); ++k) {
      const LidarSweep a = whole.sweep(k), b = merged.sweep(k);
      ASSERT_GT(a.size(), 3000u);
      EXPECT_EQ(a.index, b.index);
      EXPECT_EQ(a.begin, b.begin);
      EXPECT_EQ(a.ring, b.ring) << sensor;
      EXPECT_EQ(a.t_ns, b.t_ns) << sensor;
      EXPECT_EQ(a.intensity, b.intensity) << sensor;
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_EQ((T_body_lidar * a.point(i)).cast<float>(), b.point(i).cast<float>()) << sensor << " " << i;
    }
  }
}

TEST_F(MultiLidar, AListOfOneGivesTheRecordingOfTheBlock) {
  const std::string block = "{model: vlp-16, T_body_lidar: {xyz_m: [1, 0, 1.9]}}";
  const std::string imu = "  imu: {rate_hz: 200}\n";
  EXPECT_EQ(run(input_of("  lidar: " + block + "\n" + imu), "a").hash(),
            run(input_of("  lidars: [" + block + "]\n" + imu), "b").hash());
}

TEST_F(MultiLidar, EachHasItsOwnStreamNoisePhaseAndTruth) {
  const std::string rig =
      "  lidars:\n"
      "    - {model: vlp-16, T_body_lidar: {xyz_m: [1, 0, 1.9]}}\n"
      "    - {model: vlp-16, T_body_lidar: {xyz_m: [1, 0, 1.9]}, start_offset_ms: 30}\n"
      "    - {model: livox-mid-40, sweep_rate_hz: 20, T_body_lidar: {xyz_m: [2, 0, 1]}}\n";
  const SimulationInput input = input_of(rig);
  const Recording recording = run(input);
  ASSERT_EQ(recording.rig().lidars.size(), 3u);
  EXPECT_EQ(recording.sweep_count(0), 6u);
  EXPECT_EQ(recording.sweep_count(1), 6u);
  EXPECT_EQ(recording.sweep_count(2), 13u);
  EXPECT_EQ(recording.sweep(2, 1).begin - recording.sweep(2, 0).begin, core::Duration(30'000'000));
  EXPECT_EQ(recording.sweep(3, 2).sensor, 2);
  const truth::GroundTruth truth = truth_of(input);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<truth::PointLabels> labels = truth.labels(k);
    ASSERT_EQ(labels.size(), recording.sweep_count(k));
    for (std::size_t i = 0; i < labels.size(); ++i) EXPECT_EQ(labels[i].t_ns, recording.sweep(i, k).t_ns);
  }
  EXPECT_EQ(resolve_rig(ConfigNode::parse(resolve_rig(input.rig), "resolved.yaml")), resolve_rig(input.rig));
  // Two sensors of one model do not draw the same noise.
  EXPECT_NE(recording.sweep(0, 0).x_m,
            run(input_of("  lidars: [{model: hdl-32e}, {model: vlp-16, T_body_lidar: {xyz_m: [1, 0, 1.9]}}]\n"), "b")
                .sweep(0, 1)
                .x_m);
  EXPECT_EQ(run(input, "again", 1).hash(), recording.hash());  // at any number of threads
}

TEST_F(MultiLidar, FaultsAreEachLidarsOwn) {
  const std::string rig = "  lidars: [{model: vlp-16}, {model: vlp-16, start_offset_ms: 40}]\n";
  const Recording clean = run(input_of(rig), "clean");
  const Recording second =
      run(input_of(rig, 0.65, "{lidars: [{}, {clock_offset_ms: 5, extrinsic_error: {xyz_m: [0.1, 0, 0]}}]}"), "second");
  const Recording first = run(input_of(rig, 0.65, "{lidar: {clock_offset_ms: 5}}"), "first");
  EXPECT_EQ(second.sweep(1, 0).begin, clean.sweep(1, 0).begin);
  EXPECT_EQ(second.sweep(1, 0).x_m, clean.sweep(1, 0).x_m);
  EXPECT_EQ(second.sweep(1, 1).begin - clean.sweep(1, 1).begin, core::Duration(5'000'000));
  EXPECT_EQ(first.sweep(1, 0).begin - clean.sweep(1, 0).begin, core::Duration(5'000'000));
  EXPECT_EQ(first.sweep(1, 1).begin, clean.sweep(1, 1).begin);
  const core::Rig truth = truth_of(input_of(rig), "second").rig;
  EXPECT_NEAR((truth.lidars[1].T_body_lidar.translation() - clean.rig().lidars[1].T_body_lidar.translation()).x(), 0.1,
              1e-12);
  EXPECT_EQ(truth.lidars[0].T_body_lidar.matrix(), clean.rig().lidars[0].T_body_lidar.matrix());
  EXPECT_THAT(core::read_file(folder / "second" / "truth" / "faults.json"), HasSubstr("lidar1"));
}

TEST_F(MultiLidar, ImpossibleRigsAreRefusedWithTheirLine) {
  EXPECT_THAT(refused("  lidars: []\n"), AllOf(HasSubstr("test.yaml:2"), HasSubstr("at least one LiDAR")));
  EXPECT_THAT(refused("  lidar: {model: vlp-16}\n  lidars: [{model: vlp-16}]\n"),
              AllOf(HasSubstr("test.yaml:3"), HasSubstr("beside lidar")));
  EXPECT_THAT(refused("  lidars:\n    - {model: vlp-16}\n    - {model: vlp-17}\n"),
              AllOf(HasSubstr("test.yaml:4"), HasSubstr("vlp-17"), HasSubstr("vlp-16")));
  EXPECT_THAT(refused("  lidars:\n    - {model: vlp-16}\n    - {model: vlp-16, sweep_rate_hz: 200}\n"),
              AllOf(HasSubstr("test.yaml:4"), HasSubstr("200")));
  EXPECT_THAT(refused("  lidars: [{model: vlp-16, start_offset_ms: -1}]\n"), HasSubstr("start_offset_ms"));
  EXPECT_THAT(refused("  lidars: [{model: livox-mid-40, spin: {rate_jitter: 0.01}}]\n"),
              AllOf(HasSubstr("test.yaml:2"), HasSubstr("no head that turns")));
  EXPECT_THAT(refused("  lidars: [{model: vlp-16}]\n", "{lidars: [{}, {clock_offset_ms: 5}]}"),
              AllOf(HasSubstr("test.yaml:3"), HasSubstr("1 LiDAR;")));
  EXPECT_THAT(refused("  lidar: {model: vlp-16}\n", "{lidar: {}, lidars: [{}]}"), HasSubstr("beside lidar"));
  EXPECT_THAT(refused("  lidar: {model: livox-mid-40}\n", "{lidar: {lost_sectors: [{from_deg: 0, to_deg: 90}]}}"),
              AllOf(HasSubstr("test.yaml:3"), HasSubstr("lost_sectors")));
}

double value_of(const metrics::Evaluation& evaluation, const std::string& metric) {
  for (const metrics::Row& row : evaluation.rows)
    if (row.metric == metric && row.value) return *row.value;
  ADD_FAILURE() << metric << " has no value";
  return std::nan("");
}

constexpr const char* two_sensors =
    "  lidars:\n"
    "    - {model: vlp-16, T_body_lidar: {xyz_m: [1, 0.6, 1.9], rpy_deg: [0, 5, 30]}}\n"
    "    - {model: vlp-16, T_body_lidar: {xyz_m: [-1, -0.6, 1.7], rpy_deg: [5, 0, -90]}, start_offset_ms: 50}\n";

TEST_F(MultiLidar, TruthReplayScoresZeroWithTrueExtrinsicsAndTheirErrorWithWrongOnes) {
  const SimulationInput clean = input_of(two_sensors);
  const Recording recording = run(clean);
  const truth::GroundTruth truth = truth_of(clean);
  const core::Estimate replay = metrics::make_control(truth, recording);
  EXPECT_LT(value_of(metrics::evaluate(replay, recording, &truth, nullptr, {.threads = 2}), "point_error_rms_m"), 1e-5);

  // The second sensor stands 0.2 m off: all its points are misplaced by that, in any alignment that trusts the poses.
  const SimulationInput wrong = input_of(two_sensors, 0.65, "{lidars: [{}, {extrinsic_error: {xyz_m: [0, 0, 0.2]}}]}");
  const Recording off = run(wrong, "off");
  const truth::GroundTruth off_truth = truth_of(wrong, "off");
  const core::MergedSweeps merged(off);
  const std::vector<truth::PointLabels> labels = metrics::labels_of(off, off_truth);
  std::size_t static_points = 0, of_second = 0;
  for (std::size_t k = 0; k < merged.count(); ++k) {
    const LidarSweep sweep = merged.sweep(k);
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      if (labels[k].moving[i]) continue;
      ++static_points;
      of_second += sweep.sensor_of(i) == 1;
    }
  }
  const double expected = 0.2 * std::sqrt(static_cast<double>(of_second) / static_cast<double>(static_points));
  const core::Estimate off_replay = metrics::make_control(off_truth, off);
  EXPECT_NEAR(value_of(metrics::evaluate(off_replay, off, &off_truth, nullptr, {.threads = 2}), "point_error_rms_m"),
              expected, 1e-4);
  EXPECT_GT(expected, 0.05);
}

TEST_F(MultiLidar, CtIcpFollowsTheMergedSweeps) {
  const SimulationInput input = input_of(two_sensors, 2.05);
  const Recording recording = run(input);
  const truth::GroundTruth truth = truth_of(input);
  const estimators::RunResult result = estimators::run_estimator(
      recording, *estimators::find_estimator("ct-icp"), ConfigNode(), {.rig = recording.rig(), .threads = 1}, {});
  ASSERT_EQ(result.estimate.status, core::RunStatus::ok) << result.estimate.message;
  const metrics::Evaluation evaluation = metrics::evaluate(result.estimate, recording, &truth, nullptr, {.threads = 2});
  EXPECT_LT(value_of(evaluation, "ate_se3_rmse_m"), 0.1);  // of four metres
}

// How well it does is no question here: in this yard, begun in motion, its ground rings hold it back with one sensor too.
TEST_F(MultiLidar, KissIcpSolvesWithThePointsOfBothSensors) {
  const SimulationInput input = input_of(two_sensors, 2.05);
  const Recording recording = run(input);
  const auto* kiss = estimators::find_estimator("kiss-icp");
  const estimators::EstimatorContext context{
      .rig = recording.rig(), .threads = 1, .diagnostics = core::DiagnosticsLevel::full};
  const estimators::RunResult result = estimators::run_estimator(recording, *kiss, ConfigNode(), context, {});
  ASSERT_EQ(result.estimate.status, core::RunStatus::ok) << result.estimate.message;
  ASSERT_EQ(result.estimate.sweeps.size(), 20u);
  for (const core::SweepResult& sweep : result.estimate.sweeps) EXPECT_EQ(sweep.status, core::SweepStatus::ok);
  EXPECT_THAT(result.log, testing::Contains(HasSubstr("2 LiDARs")));
  bool first = false, second = false;
  for (const core::SweepDiagnostics& sweep : result.diagnostics)
    for (const core::ResidualRow& row : sweep.rows) {
      first = first || row.sensor == 0;
      second = second || row.sensor == 1;
    }
  EXPECT_TRUE(first && second);
}

/// Notes what it is given.
class Listener : public estimators::Estimator {
 public:
  explicit Listener(std::vector<std::pair<std::uint16_t, std::int64_t>>& heard) : heard_(heard) {}
  using Estimator::add;
  estimators::SweepOutcome add(const LidarSweep& sweep) override {
    heard_.emplace_back(sweep.sensor, sweep.index);
    EXPECT_TRUE(sweep.point_sensor.empty());
    return estimators::initialising_outcome(sweep);
  }

 private:
  std::vector<std::pair<std::uint16_t, std::int64_t>>& heard_;
};
std::vector<std::pair<std::uint16_t, std::int64_t>> heard;

TEST_F(MultiLidar, AMethodMayAskForThemRaw) {
  const Recording recording = run(input_of(two_sensors));
  const estimators::EstimatorEntry raw{
      .name = "listener",
      .summary = "",
      .source = "",
      .needs = estimators::Needs::lidar,
      .make = [](const ConfigNode&,
                 const estimators::EstimatorContext& context) -> std::unique_ptr<estimators::Estimator> {
        EXPECT_EQ(context.rig.lidars.size(), 2u);
        return std::make_unique<Listener>(heard);
      },
      .describe = nullptr,
      .resolve = nullptr,
      .raw_lidars = true};
  heard.clear();
  const estimators::RunResult result =
      estimators::run_estimator(recording, raw, ConfigNode(), {.rig = recording.rig()}, {});
  EXPECT_EQ(result.estimate.sweeps.size(), 6u);  // the first LiDAR's
  std::vector<std::pair<std::uint16_t, std::int64_t>> expected;
  for (std::int64_t k = 0; k < 6; ++k) {
    expected.emplace_back(0, k);
    expected.emplace_back(1, k);
  }
  EXPECT_EQ(heard, expected);
}

}  // namespace
}  // namespace tarmac::sim
