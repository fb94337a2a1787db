#include "sim/truth/ground_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "scenes/registry.h"
#include "sim/truth/motion.h"
#include "sim/truth/write_truth.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using testing::AllOf;
using testing::HasSubstr;

const std::string scenario_text = R"(name: short-drive
seed: 42
duration_s: 7.5
scene: {kind: stand}
motion:
  kind: drive
  start: {x_m: -60, y_m: -30, heading_deg: 3.3}
  path: [{straight_m: 30}, {turn_deg: 90, radius_m: 6}]
  speed: [{to_m_s: 3.7, peak_m_s2: 1.9}]
  stop_peak_m_s2: 0.7
rig: {imu: {model: bmi088}}
)";

Rig rig() {
  Rig rig;
  rig.lidars.push_back({.model = "ouster-os1-64-gen2", .T_body_lidar = SE3(Eigen::Translation3d(1, 0, 1.9))});
  return rig;
}

class TruthFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("tarmac_truth_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    const ConfigNode scenario = ConfigNode::parse(scenario_text, "scenario.yaml");
    motion_ = make_motion(scenario.child("motion"), duration_from_s(7.5),
                          scenes::make_ground(scenario.child("scene"), 42), 42);
    write_truth(folder_, scenario_text, resolve_motion(scenario.child("motion")), *motion_, rig(),
                {{"clock-offset", "imu0", "5 ms"}});
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string error_of_loading() const {
    try {
      load_ground_truth(folder_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
  std::shared_ptr<const SmoothTrajectory> motion_;
};

TEST_F(TruthFolder, GivesBackTheMotionBitForBitAndAllElse) {
  const GroundTruth truth = load_ground_truth(folder_);
  EXPECT_EQ(truth.scenario, "short-drive");
  EXPECT_EQ(truth.seed, 42u);
  EXPECT_EQ(truth.folder, folder_);
  EXPECT_EQ(truth.motion->end(), motion_->end());
  for (std::int64_t t_ns = 0; t_ns <= 7'500'000'000; t_ns += 37'123'457) {
    const Kinematics want = motion_->at(time_from_ns(t_ns)), got = truth.motion->at(time_from_ns(t_ns));
    ASSERT_EQ(got.T_world_body.matrix(), want.T_world_body.matrix()) << t_ns;
    ASSERT_EQ(got.a_world, want.a_world) << t_ns;
    ASSERT_EQ(got.alpha_body, want.alpha_body) << t_ns;
  }
  EXPECT_EQ(rig_to_json(truth.rig), rig_to_json(rig()));
  ASSERT_EQ(truth.faults.size(), 1u);
  EXPECT_EQ(truth.faults[0].kind, "clock-offset");
  EXPECT_EQ(truth.faults[0].sensor, "imu0");
  EXPECT_EQ(truth.faults[0].detail, "5 ms");
}

TEST_F(TruthFolder, TumHoldsThePoseEveryMillisecondWithAllNanoseconds) {
  std::istringstream lines(read_file(folder_ / "truth.tum"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line[0], '#');
  int count = 0;
  for (; std::getline(lines, line); ++count) {
    std::int64_t s = 0, ns = 0;
    char dot = 0;
    Eigen::Vector3d p;
    Eigen::Vector4d q;
    std::istringstream(line) >> s >> dot >> ns >> p.x() >> p.y() >> p.z() >> q[0] >> q[1] >> q[2] >> q[3];
    const Time t = time_from_ns(s * 1'000'000'000 + ns);
    ASSERT_EQ(to_ns(t), count * 1'000'000LL);
    const SE3 want = motion_->pose(t);
    ASSERT_LT((p - want.translation()).norm(), 1e-11);
    ASSERT_LT((q - se3::quat_xyzw(want)).norm(), 1e-11);
  }
  EXPECT_EQ(count, 7501);
}

TEST_F(TruthFolder, MotionFileNamesItsFunctionClassAndResolvesToTheSameMotion) {
  const ConfigNode file = ConfigNode::load((folder_ / "motion.yaml").string());
  EXPECT_THAT(file.child("function_class").scalar("function_class"), HasSubstr("tanh"));
  const ConfigNode scenario = ConfigNode::parse(scenario_text, "scenario.yaml");
  EXPECT_EQ(resolve_motion(file.child("motion")), resolve_motion(scenario.child("motion")));
}

TEST_F(TruthFolder, LabelsComeBackPerSweep) {
  PointLabels labels;
  labels.begin = time_from_ns(100'000'000);
  labels.end = time_from_ns(199'902'344);
  labels.label = {scenes::Label::pavement, scenes::Label::vehicle};
  labels.instance = {7, 70000};
  labels.moving = {0, 1};
  labels.t_ns = {0, 99'902'344};
  {
    ChunkWriter writer(folder_ / "lidar0_labels.chunks");
    writer.append(labels.begin, to_chunk(labels));
    writer.append(labels.end, to_chunk(PointLabels{}));
    writer.finish();
  }
  const auto got = load_ground_truth(folder_).labels();
  ASSERT_EQ(got.size(), 2u);
  EXPECT_EQ(got[0].begin, labels.begin);
  EXPECT_EQ(got[0].end, labels.end);
  EXPECT_EQ(got[0].label, labels.label);
  EXPECT_EQ(got[0].instance, labels.instance);
  EXPECT_EQ(got[0].moving, labels.moving);
  EXPECT_EQ(got[0].t_ns, labels.t_ns);
  EXPECT_EQ(got[0].time(1), labels.end);
  EXPECT_EQ(got[0].kind, std::vector(2, ReturnKind::surface));
  EXPECT_FALSE(got[0].has_point_truth());
  EXPECT_TRUE(got[1].label.empty());
}

PointLabels labels_with_all_columns() {
  PointLabels labels;
  labels.label = {scenes::Label::glass, scenes::Label::building, scenes::Label::none};
  labels.instance = {7, 8, PointLabels::no_instance};
  labels.moving = {0, 0, 0};
  labels.t_ns = {0, 1, 2};
  labels.kind = {ReturnKind::dirt, ReturnKind::ghost, ReturnKind::noise};
  labels.true_range_m = {1.5, 1.0 / 3, 7e-9};
  labels.normal_x = {1, 0, 0};
  labels.normal_y = {0, 1, 0};
  labels.normal_z = {0, 0, 0.25f};
  labels.cos_incidence = {0.5f, 1, 0.125f};
  return labels;
}

TEST(PointLabels, EveryColumnComesBackBitForBit) {
  const PointLabels labels = labels_with_all_columns(), got = labels_from_chunk(to_chunk(labels));
  EXPECT_EQ(got.kind, labels.kind);
  EXPECT_EQ(got.true_range_m, labels.true_range_m);
  EXPECT_EQ(got.normal_x, labels.normal_x);
  EXPECT_EQ(got.normal_y, labels.normal_y);
  EXPECT_EQ(got.normal_z, labels.normal_z);
  EXPECT_EQ(got.cos_incidence, labels.cos_incidence);
}

/// 24 bytes a point that no metric reads stay on the disk.
TEST_F(TruthFolder, PointTruthIsReadOnRequestOnly) {
  const PointLabels labels = labels_with_all_columns();
  {
    ChunkWriter writer(folder_ / "lidar0_labels.chunks");
    writer.append(labels.begin, to_chunk(labels));
    writer.finish();
  }
  const GroundTruth truth = load_ground_truth(folder_);
  const PointLabels plain = truth.labels().at(0);
  EXPECT_FALSE(plain.has_point_truth());
  EXPECT_TRUE(plain.normal_x.empty() && plain.normal_y.empty() && plain.normal_z.empty());
  EXPECT_TRUE(plain.cos_incidence.empty());
  EXPECT_EQ(plain.kind, labels.kind);
  EXPECT_EQ(plain.instance, labels.instance);
  const PointLabels all = truth.labels(0, Columns::labels_and_point_truth).at(0);
  EXPECT_EQ(all.true_range_m, labels.true_range_m);
  EXPECT_EQ(all.cos_incidence, labels.cos_incidence);
}

TEST(PointLabels, FilesFromBeforeKindsExistedHoldSurfacesOnly) {
  ChunkData chunk;
  chunk.add(std::span<const std::uint8_t>(std::vector<std::uint8_t>{1, 10}));
  chunk.add(std::span<const std::uint32_t>(std::vector<std::uint32_t>{3, 4}));
  chunk.add(std::span<const std::uint8_t>(std::vector<std::uint8_t>{0, 1}));
  chunk.add(std::span<const std::int32_t>(std::vector<std::int32_t>{5, 6}));
  chunk.add_value(std::int64_t{1});
  chunk.add_value(std::int64_t{2});
  const PointLabels got = labels_from_chunk(chunk);
  ASSERT_EQ(got.label.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(got.kind_of(i), ReturnKind::surface);
  EXPECT_FALSE(got.has_point_truth());
}

TEST(PointLabels, KeepsTheSamePointsOfEveryColumnThatThereIs) {
  PointLabels labels = labels_with_all_columns();
  labels.keep_only({0, 2});
  EXPECT_EQ(labels.kind, (std::vector{ReturnKind::dirt, ReturnKind::noise}));
  EXPECT_EQ(labels.true_range_m, (std::vector{1.5, 7e-9}));
  EXPECT_EQ(labels.cos_incidence, (std::vector{0.5f, 0.125f}));
  PointLabels plain;
  plain.label = {scenes::Label::glass, scenes::Label::building};
  plain.keep_only({1});
  EXPECT_EQ(plain.label, std::vector{scenes::Label::building});
  EXPECT_TRUE(plain.kind.empty());
}

TEST(PointLabels, ColumnsOfUnequalLengthAndKindsThatAreNoneAreRefused) {
  PointLabels labels = labels_with_all_columns();
  labels.true_range_m.pop_back();
  EXPECT_THROW(labels_from_chunk(to_chunk(labels)), DamagedFile);
  labels = labels_with_all_columns();
  labels.kind[1] = static_cast<ReturnKind>(200);
  EXPECT_THROW(labels_from_chunk(to_chunk(labels)), DamagedFile);
}

TEST_F(TruthFolder, MissingLabelsAreAnErrorThatSaysSo) {
  const GroundTruth truth = load_ground_truth(folder_);
  try {
    truth.labels(1);
    FAIL() << "there are none";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("lidar1_labels"), HasSubstr("simulate")));
  }
}

TEST_F(TruthFolder, AFolderThatIsNoTruthIsRefused) {
  std::filesystem::remove(folder_ / "rig.json");
  EXPECT_THAT(error_of_loading(), AllOf(HasSubstr(folder_.string()), HasSubstr("rig.json"), HasSubstr("truth")));
  write_file(folder_ / "rig.json", rig_to_json(rig()));
  write_file(folder_ / "faults.json", "{]");
  EXPECT_THAT(error_of_loading(), HasSubstr("faults.json"));
  write_file(folder_ / "faults.json", "{\"faults\": []}");
  write_file(folder_ / "scenario.yaml", "name: x\nseed: 1\nscene: {kind: stand}\nmotion: {kind: still}\n");
  EXPECT_THAT(error_of_loading(), AllOf(HasSubstr("scenario.yaml"), HasSubstr("duration_s")));
}

}  // namespace
}  // namespace tarmac::sim::truth
