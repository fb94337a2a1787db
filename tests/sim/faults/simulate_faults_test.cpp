// Faults through the whole simulator: the recording is the clean one with the fault in it, and the truth is unmoved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "core/recording.h"
#include "sim/simulate.h"
#include "sim/truth/ground_truth.h"
#include "tests/sim/support/motions.h"
#include "tests/sim/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::sim {
namespace {

namespace fs = std::filesystem;
using core::ConfigNode;

constexpr const char* rig = "lidar: {model: vlp-16}\nimu: {rate_hz: 200}\n";

SimulationInput input_of(const std::string& faults) {
  SimulationInput input;
  input.scenario_name = "yard";
  input.duration = core::duration_from_s(0.55);
  auto scene = std::make_shared<scenes::Scene>(tests::empty_scene());
  tests::add_instance(*scene, tests::square(80), tests::pose({0, 0, 0}), -1, scenes::Label::pavement);
  tests::add_instance(*scene, tests::box({5, 0.5, 4}), tests::pose({12, 9, 4}), -1, scenes::Label::building);
  input.scene = scene;
  auto motion = std::make_shared<tests::SteadyMotion>();
  motion->v_m_s = {5, 0, 0};
  motion->omega_world_rad_s = {0, 0, 0.4};
  motion->length_s = 0.55;
  input.motion = motion;
  input.rig = ConfigNode::parse(rig, "test.yaml");
  input.faults = ConfigNode::parse(faults, "test.yaml");
  input.resolved_scenario = "name: yard\nseed: 1\nduration_s: 1\nscene: {kind: stand}\nmotion: {kind: still}\n";
  input.resolved_motion = "  kind: still\n";
  return input;
}

/// Recording and truth of one simulation, gone at the end.
struct Simulated {
  tests::TemporaryFolder folder;
  SimulationSummary summary;
  std::vector<core::LidarSweep> sweeps;
  std::vector<core::ImuSample> imu;
  std::vector<truth::PointLabels> labels;
  core::Rig sheet, true_rig;
  std::string log, manifest, imu_errors;

  explicit Simulated(const std::string& faults, int threads = 1) {
    const fs::path recording = folder.path() / "recording", truth = folder.path() / "truth";
    summary = simulate(input_of(faults), {.threads = threads, .fast = false}, recording, truth,
                       [](double, const std::string&) {});
    const core::Recording read = core::Recording::open(recording);
    for (std::size_t k = 0; k < read.sweep_count(); ++k) sweeps.push_back(read.sweep(k));
    imu = read.imu();
    sheet = read.rig();
    const core::ChunkReader chunks(truth / "lidar0_labels.chunks");
    for (std::size_t k = 0; k < chunks.size(); ++k) labels.push_back(truth::labels_from_chunk(chunks.read(k)));
    true_rig = core::rig_from_json(core::read_file(truth / "rig.json"), "rig.json");
    log = core::read_file(truth / "faults.json");
    imu_errors = core::read_file(truth / "imu0_errors.json");
    manifest = core::read_file(recording / "manifest.json");
  }
};

void expect_same_labels(const truth::PointLabels& a, const truth::PointLabels& b) {
  EXPECT_EQ(a.begin, b.begin);
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.t_ns, b.t_ns);
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(a.instance, b.instance);
}

TEST(SimulateFaults, ClocksAreOffAndPointsLabelsAndDataSheetAreNot) {
  const Simulated clean(""), faulty("{lidar: {clock_offset_ms: -5}, imu: {clock_offset_ms: 3}}");
  ASSERT_EQ(faulty.sweeps.size(), clean.sweeps.size());
  for (std::size_t k = 0; k < clean.sweeps.size(); ++k) {
    EXPECT_EQ((faulty.sweeps[k].begin - clean.sweeps[k].begin).count(), -5'000'000);
    EXPECT_EQ((faulty.sweeps[k].end - clean.sweeps[k].end).count(), -5'000'000);
    EXPECT_EQ(faulty.sweeps[k].t_ns, clean.sweeps[k].t_ns);
    EXPECT_EQ(faulty.sweeps[k].x_m, clean.sweeps[k].x_m);
    expect_same_labels(faulty.labels[k], clean.labels[k]);
  }
  ASSERT_EQ(faulty.imu.size(), clean.imu.size());
  for (std::size_t k = 0; k < clean.imu.size(); ++k) {
    EXPECT_EQ((faulty.imu[k].t - clean.imu[k].t).count(), 3'000'000);
    EXPECT_EQ(faulty.imu[k].accel_m_s2, clean.imu[k].accel_m_s2);
  }
  EXPECT_EQ(core::rig_to_json(faulty.sheet), core::rig_to_json(clean.sheet));
  EXPECT_THAT(faulty.log, testing::HasSubstr("\"offset_ms\": -5.0"));
  EXPECT_THAT(faulty.log, testing::HasSubstr("\"sensor\": \"imu0\""));
  EXPECT_THAT(clean.log, testing::Not(testing::HasSubstr("kind")));
}

TEST(SimulateFaults, RecordingDoesNotTellThatAnythingIsWrong) {
  const Simulated faulty("{lidar: {point_time_reversed: true, lost_packets: 0.1}, imu: {lost_samples: 0.1}}");
  for (const char* word : {"fault", "reversed", "lost", "probability"})
    EXPECT_EQ(faulty.manifest.find(word), std::string::npos) << word;
}

TEST(SimulateFaults, PacketsOfAStaggeredSensorAreWholeFiringCycles) {
  // Every point's recorded time is the begin of the 24 cycles of 55.296 us that it was fired in.
  const Simulated clean(""), faulty("{lidar: {point_time_per_packet: true, packet_columns: 24}}");
  for (std::size_t k = 0; k < clean.sweeps.size(); ++k) {
    ASSERT_EQ(faulty.sweeps[k].size(), clean.sweeps[k].size());
    for (std::size_t i = 0; i < clean.sweeps[k].size(); ++i) {
      const double packet = std::floor((clean.sweeps[k].t_ns[i] + 1) / (24 * 55296.0));
      ASSERT_NEAR(faulty.sweeps[k].t_ns[i], packet * 24 * 55296.0, 1.5);
    }
    expect_same_labels(faulty.labels[k], clean.labels[k]);
  }
}

TEST(SimulateFaults, LostSweepsAreMissingFromRecordingAndLabelsAlike) {
  const Simulated clean(""), faulty("{lidar: {sweep_gaps: [{from_s: 0.15, to_s: 0.35}]}}");
  ASSERT_EQ(clean.sweeps.size(), 5u);
  ASSERT_EQ(faulty.sweeps.size(), 3u);
  ASSERT_EQ(faulty.labels.size(), 3u);
  EXPECT_EQ(faulty.summary.sweeps, 3u);
  const std::size_t left[] = {0, 1, 4};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(faulty.sweeps[k].index, static_cast<std::int64_t>(left[k]));
    EXPECT_EQ(faulty.sweeps[k].x_m, clean.sweeps[left[k]].x_m);
    expect_same_labels(faulty.labels[k], clean.labels[left[k]]);
  }
  EXPECT_THAT(faulty.log, testing::HasSubstr("sweeps [2, 3] of 5"));
}

TEST(SimulateFaults, AWrongMountingMovesTheSensorAndNotItsDataSheet) {
  // With the LiDAR truly 0.5 m further up, the ground below it is that much further away.
  const Simulated clean(""),
      faulty("{lidar: {extrinsic_error: {xyz_m: [0, 0, 0.5]}}, imu: {extrinsic_error: {rpy_deg: [90, 0, 0]}}}");
  EXPECT_EQ(core::rig_to_json(faulty.sheet), core::rig_to_json(clean.sheet));
  EXPECT_NEAR(
      (faulty.true_rig.lidars[0].T_body_lidar.translation() - clean.true_rig.lidars[0].T_body_lidar.translation()).z(),
      0.5, 1e-12);
  const auto lowest = [](const Simulated& s) {
    return *std::min_element(s.sweeps[2].z_m.begin(), s.sweeps[2].z_m.end());
  };
  EXPECT_NEAR(lowest(faulty) - lowest(clean), -0.5, 0.1);
  EXPECT_NEAR(clean.imu[50].accel_m_s2.z(), 9.8, 0.1);
  EXPECT_NEAR(faulty.imu[50].accel_m_s2.y(), 9.8, 0.1) << "rolled by 90 degrees, its y axis points up";
}

TEST(SimulateFaults, SameBytesAtAnyNumberOfThreads) {
  const char* faults =
      "{lidar: {sweep_jitter_ms: 1, packet_jitter_ms: 0.1, lost_packets: 0.2, lost_sweeps: 0.3}, imu: {jitter_ms: 1}}";
  const Simulated one(faults, 1), two(faults, 2);
  EXPECT_EQ(one.summary.recording_hash, two.summary.recording_hash);
  EXPECT_EQ(one.log, two.log);
}

TEST(SimulateFaults, ResolvedBlockReadsBackAsItselfAndAbsenceStaysAbsent) {
  const ConfigNode with_imu = ConfigNode::parse(rig, "test.yaml"),
                   without = ConfigNode::parse("lidar: {}", "test.yaml");
  const ConfigNode faults =
      ConfigNode::parse("{lidar: {clock_offset_ms: 5, lost_sectors: [{to_deg: 10}]}}", "test.yaml");
  for (const ConfigNode& node : {with_imu, without}) {
    const std::string resolved = resolve_faults(faults, node);
    EXPECT_EQ(resolve_faults(ConfigNode::parse(resolved, "resolved.yaml"), node), resolved);
    EXPECT_THAT(resolved, testing::HasSubstr("clock_offset_ms: 5"));
    EXPECT_EQ(resolve_faults(ConfigNode(), node), "");
  }
}

TEST(SimulateImu, RealisedErrorsAreInTheTruthAndNotInTheRecording) {
  const Simulated run("");
  EXPECT_THAT(run.imu_errors, testing::HasSubstr("turn_on_bias_rad_s"));
  EXPECT_THAT(run.manifest, testing::Not(testing::HasSubstr("bias")));
  EXPECT_THAT(run.manifest, testing::Not(testing::HasSubstr("misalignment")));
}

TEST(SimulateFaults, BadFaultsAreRefusedBeforeAnythingIsWritten) {
  EXPECT_THROW(check(input_of("{lidar: {lost_packets: 2}}")), core::InputError);
  EXPECT_NO_THROW(check(input_of("{lidar: {lost_packets: 0.2}}")));
}

TEST(SimulateFaults, OptionsAreDescribed) {
  std::vector<std::string> names;
  for (const core::OptionDescription& option : describe_fault_options()) names.push_back(option.name);
  EXPECT_THAT(names, testing::IsSupersetOf({"lidar.clock_offset_ms", "lidar.lost_sectors", "imu.gaps[].from_s"}));
}

}  // namespace
}  // namespace tarmac::sim
