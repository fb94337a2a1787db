// The whole of evaluate(): rows, series, threads, files, a recording on disk.
#include "metrics/evaluation.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "core/chunk_file.h"
#include "core/error.h"
#include "core/files.h"
#include "core/recording.h"
#include "metrics/controls.h"
#include "metrics/cost.h"
#include "metrics/evaluate.h"
#include "metrics/registry.h"
#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {
namespace {

using namespace core;
namespace fs = std::filesystem;

class EvaluationTest : public ::testing::Test {
 protected:
  EvaluationTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("tarmac_") + info->name() + "_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~EvaluationTest() override { fs::remove_all(folder_); }
  fs::path folder_;
};

Drive wobbly_drive() {
  const DriveShape shape{.sweeps = 15};
  const auto motion = std::make_shared<Wobbly>(Time{}, time_from_s(9));
  return make_drive(motion, shape, [=](int k) {
    std::vector<Target> targets = box(motion->pose(shape.end(k)).translation() + Eigen::Vector3d(4, 2, 1), {20, 9, 3});
    targets.push_back({targets.front().p_world, true});
    return targets;
  });
}

Estimate bent(const Drive& drive) {
  return make_control(drive.truth, drive.source(),
                      {.C_right = pose({0.3, 0.1, 0}, {0, 0, 0.02}), .yaw_rate_error_rad_s = 0.03});
}

/// East at 8 m/s, with a deceleration from some instant on.
class Braking final : public SmoothTrajectory {
 public:
  Braking(Time from, double deceleration_m_s2) : from_(from), deceleration_m_s2_(deceleration_m_s2) {}
  Time begin() const override { return Time{}; }
  Time end() const override { return time_from_s(10); }
  Kinematics at(Time t) const override {
    const double s = to_s(t - Time{}), braked_s = std::max(0.0, to_s(t - from_));
    Kinematics k;
    k.T_world_body.translation().x() = 8 * s - 0.5 * deceleration_m_s2_ * braked_s * braked_s;
    k.v_world.x() = 8 - deceleration_m_s2_ * braked_s;
    k.a_world.x() = braked_s > 0 ? -deceleration_m_s2_ : 0;
    return k;
  }

 private:
  Time from_;
  double deceleration_m_s2_;
};

/// Equal to the last bit, NaN included.
bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
           return (std::isnan(x) && std::isnan(y)) || std::memcmp(&x, &y, sizeof x) == 0;
         });
}

void expect_same(const Evaluation& a, const Evaluation& b) {
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (const Row& row : a.rows) {
    const Row* other = b.row(row.metric, row.estimate);
    ASSERT_TRUE(other) << row.metric;
    EXPECT_EQ(row.value, other->value) << row.metric;
    EXPECT_EQ(row.ci_low, other->ci_low);
    EXPECT_EQ(row.ci_high, other->ci_high);
    EXPECT_EQ(row.unit, other->unit);
    EXPECT_EQ(row.status, other->status);
  }
  ASSERT_EQ(a.series.size(), b.series.size());
  for (const Series& series : a.series) {
    const Series* other = b.find(series.name);
    ASSERT_TRUE(other) << series.name;
    EXPECT_EQ(series.x_label, other->x_label);
    EXPECT_EQ(series.y_label, other->y_label);
    EXPECT_TRUE(same(series.x, other->x)) << series.name;
    EXPECT_TRUE(same(series.y, other->y)) << series.name;
    EXPECT_TRUE(same(series.low, other->low)) << series.name;
    EXPECT_TRUE(same(series.high, other->high)) << series.name;
  }
  EXPECT_EQ(a.map.p_world_m, b.map.p_world_m);
  EXPECT_EQ(a.map.error_m, b.map.error_m);
  EXPECT_EQ(a.map.moving, b.map.moving);
}

RunTiming some_timing() {
  RunTiming timing;
  timing.wall_s = 0.5;
  timing.peak_memory_mb = 123;
  for (int k = 0; k < 15; ++k) timing.sweeps.push_back({k, 10.0 + k, 20.0 + k, {}});
  return timing;
}

std::vector<SweepDiagnostics> some_diagnostics() {
  std::vector<SweepDiagnostics> diagnostics(15);
  for (int k = 0; k < 15; ++k) {
    diagnostics[static_cast<std::size_t>(k)].index = k;
    diagnostics[static_cast<std::size_t>(k)].iterations = k;
  }
  return diagnostics;
}

TEST_F(EvaluationTest, HasARowForEveryMetricWithItsUnitAndAValueOrTheReason) {
  const Drive drive = wobbly_drive();
  const Evaluation e = drive.evaluate(bent(drive));
  ASSERT_EQ(e.rows.size(), metrics().size());
  for (const MetricEntry& metric : metrics()) {
    const Row* row = e.row(metric.name);
    ASSERT_TRUE(row) << metric.name;
    EXPECT_EQ(row->unit, metric.unit);
    EXPECT_EQ(row->value.has_value(), row->status.starts_with("ok")) << metric.name << ": " << row->status;
  }
  EXPECT_EQ(e.row("sweep_time_p50_ms")->status, "n/a: the run recorded no times");
  EXPECT_EQ(e.scenario, "fabricated");
  EXPECT_EQ(e.seed, 7u);
}

TEST_F(EvaluationTest, IsTheSameAtAnyNumberOfThreads) {
  const Drive drive = wobbly_drive();
  const Estimate estimate = bent(drive);
  const Evaluation one = drive.evaluate(estimate, {.threads = 1, .map_points = 700});
  for (int repeat = 0; repeat < 3; ++repeat)
    expect_same(one, drive.evaluate(estimate, {.threads = 4, .map_points = 700}));
}

TEST_F(EvaluationTest, ARunWithoutAnyScoredSweepIsAllReasons) {
  const Drive drive = wobbly_drive();
  Estimate estimate;
  estimate.estimator = "none";
  estimate.status = RunStatus::not_initialised;
  estimate.message = "no rest at the start";
  const Evaluation e = drive.evaluate(estimate);
  EXPECT_EQ(e.status, "not_initialised");
  EXPECT_EQ(e.message, "no rest at the start");
  EXPECT_EQ(e.coverage, 0);
  ASSERT_EQ(e.rows.size(), metrics().size());
  EXPECT_EQ(e.row("coverage_percent")->value, 0);
  EXPECT_EQ(e.row("ate_se3_rmse_m")->status, "n/a: no sweep is scored");
  EXPECT_TRUE(e.map.p_world_m.empty());
}

/// A batch method: its final trajectory is the truth, its causal one is bent; rows of both are apart.
TEST_F(EvaluationTest, CausalAndFinalAreScoredApart) {
  const Drive drive = wobbly_drive();
  Estimate estimate = bent(drive);
  estimate.has_final = true;
  estimate.final = make_control(drive.truth, drive.source()).causal;
  const Evaluation both = drive.evaluate(estimate);
  EXPECT_GT(*both.row("point_error_rms_m", "causal")->value, 0.01);
  EXPECT_LT(*both.row("point_error_rms_m", "final")->value, 1e-9);
  EXPECT_LT(*both.row("ate_first_pose_rmse_m", "final")->value, 1e-9);
  EXPECT_EQ(both.row("sweep_time_p50_ms", "final")->status, "n/a: stated of the headline estimate");
  EXPECT_GT(both.find("error_vs_time")->y.back(), 0.01);  // series are the headline's: causal

  estimate.has_causal = false;
  const Evaluation batch = drive.evaluate(estimate);
  EXPECT_EQ(batch.row("point_error_rms_m", "causal"), nullptr);
  EXPECT_LT(batch.find("error_vs_time")->y.back(), 1e-9);
}

/// Wall times are 10 ... 24 ms, processor times 20 ... 34 ms; sweeps span 14 periods and a sweep's 93 ms in 0.5 s.
TEST_F(EvaluationTest, CostComesFromTheRunsRecords) {
  const Drive drive = wobbly_drive();
  const RunTiming timing = some_timing();
  const std::vector<SweepDiagnostics> diagnostics = some_diagnostics();
  const DiagnosticsSource source = diagnostics_of(diagnostics);
  const Estimate estimate = bent(drive);
  const Evaluation e = evaluate({estimate, drive.source(), &drive.truth, &drive.labels, &timing, &source}, {});
  EXPECT_DOUBLE_EQ(*e.row("sweep_time_p50_ms")->value, 17);
  EXPECT_DOUBLE_EQ(*e.row("sweep_time_p95_ms")->value, 10 + 14 * 0.95);
  EXPECT_DOUBLE_EQ(*e.row("sweep_cpu_p50_ms")->value, 27);
  EXPECT_DOUBLE_EQ(*e.row("iterations_mean")->value, 7.5);  // 1 ... 14: a sweep without iterations does not count
  EXPECT_NEAR(*e.row("real_time_factor")->value, (14 * 0.1 + 0.093) / 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(*e.row("peak_memory_mb")->value, 123);
  EXPECT_DOUBLE_EQ(e.find("sweep_time_vs_time")->y[3], 13);
  EXPECT_NEAR(e.find("iterations_vs_time")->x[3], 0.3 + 0.093, 1e-12);
}

TEST_F(EvaluationTest, SeriesOfTheTrueMotionAreItsDerivatives) {
  Vector6 xi;
  xi << 3, 4, 0, 0, 0, -0.25;
  const auto motion = std::make_shared<ConstantTwist>(pose({0, 0, 0}, {0, 0, 1}), xi, Time{}, time_from_s(9));
  const DriveShape shape{.sweeps = 5};
  const Drive drive = make_drive(motion, shape, [&](int) { return box({0, 0, 0}, {9, 8, 7}); });
  const Evaluation e = drive.evaluate(make_control(drive.truth, drive.source()));
  for (const double v : e.find("speed_vs_time")->y) EXPECT_NEAR(v, 5, 1e-12);
  for (const double rate : e.find("yaw_rate_vs_time")->y) EXPECT_NEAR(rate, -0.25 * 180 / M_PI, 1e-10);
  EXPECT_TRUE(same(e.find("path_true")->x, e.find("path_true")->x));
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(e.find("path_estimate")->x[k], e.find("path_true")->x[k], 1e-10);
    EXPECT_NEAR(e.find("path_estimate")->y[k], e.find("path_true")->y[k], 1e-10);
  }
}

TEST_F(EvaluationTest, TheMapSampleIsEvenAndHoldsEachPointsOwnError) {
  const Drive drive = wobbly_drive();
  const SE3 C = pose({0.3, 0.4, 0}, Eigen::Vector3d::Zero());
  Estimate estimate = make_control(drive.truth, drive.source());
  for (std::size_t k = 1; k < 15; ++k) estimate.sweeps[k].status = SweepStatus::lost;
  std::vector<Segment> segments = estimate.causal.segments();
  segments[0].poses.front() = C * segments[0].poses.front();  // the first column 0.5 m off, the others not
  estimate.causal = PiecewiseTrajectory(segments);
  const Evaluation all = drive.evaluate(estimate, {.map_points = 100000});
  ASSERT_EQ(all.map.p_world_m.size(), 32u * 9);
  for (std::size_t i = 0; i < all.map.error_m.size(); ++i) {
    EXPECT_NEAR(all.map.error_m[i], i < 9 ? 0.5 : 0, 1e-5) << i;
    EXPECT_EQ(all.map.moving[i], i % 9 == 8);
  }
  const Evaluation few = drive.evaluate(estimate, {.map_points = 36});
  EXPECT_EQ(few.map.p_world_m.size(), 36u);  // one of every 8 points
}

/// An estimate that stretches the path bends every sweep; brakes count from the sweep whose middle they reach.
TEST_F(EvaluationTest, DeskewErrorUnderBrakingIsThatOfTheSweepsThatBrake) {
  const DriveShape shape{.sweeps = 20};
  const auto row_of = [&](const std::shared_ptr<const SmoothTrajectory>& motion) {
    const Drive drive = make_drive(motion, shape, [&](int k) {
      return box(motion->pose(shape.end(k)).translation() + Eigen::Vector3d(4, 2, 1), {20, 9, 3});
    });
    const Estimate estimate = make_control(drive.truth, drive.source(), {.speed_scale = 1.05});
    const Evaluation e = drive.evaluate(estimate);
    return std::pair(*e.row("deskew_error_braking_rms_m"), *e.row("deskew_error_rms_m")->value);
  };
  const auto always = std::make_shared<Braking>(Time{} - Duration(1), 3);
  const auto [all, whole] = row_of(always);
  ASSERT_TRUE(all.value);
  EXPECT_EQ(all.status, "ok: 20 sweeps");
  EXPECT_DOUBLE_EQ(*all.value, whole);

  const Time late = shape.begin(15) + (shape.end(15) - shape.begin(15)) / 2 - Duration(1'000'000);
  const auto some = std::make_shared<Braking>(late, 3);
  const auto [part, mixed] = row_of(some);
  ASSERT_TRUE(part.value);
  EXPECT_EQ(part.status, "ok: 5 sweeps");
  EXPECT_LT(*part.value, mixed);  // a stretched path bends a sweep less the slower it goes

  const auto gentle = std::make_shared<Braking>(Time{}, 2);
  EXPECT_FALSE(row_of(gentle).first.value);
}

TEST_F(EvaluationTest, WithoutTruthSaysWhatTheRunItselfTellsAndNothingElse) {
  const Drive drive = wobbly_drive();
  const RunTiming timing = some_timing();
  const std::vector<SweepDiagnostics> diagnostics = some_diagnostics();
  const DiagnosticsSource source = diagnostics_of(diagnostics);
  Estimate estimate = bent(drive);
  estimate.sweeps[4].status = SweepStatus::lost;
  const Evaluation e = evaluate({estimate, drive.source(), nullptr, nullptr, &timing, &source}, {});
  EXPECT_EQ(e.status, "ok");
  EXPECT_DOUBLE_EQ(*e.row("coverage_percent")->value, 100 * 14.0 / 15);
  EXPECT_DOUBLE_EQ(*e.row("sweep_time_p50_ms")->value, 17);
  EXPECT_DOUBLE_EQ(*e.row("iterations_mean")->value, 7.5);
  for (const char* needs_truth : {"ate_se3_rmse_m", "rpe_1sweep_trans_rmse_m", "end_error_percent", "path_length_m",
                                  "deskew_error_rms_m", "point_error_rms_m", "point_coverage_percent"}) {
    ASSERT_NE(e.row(needs_truth), nullptr) << needs_truth;
    EXPECT_FALSE(e.row(needs_truth)->value) << needs_truth;
    EXPECT_EQ(e.row(needs_truth)->status, "n/a: the recording has no truth");
  }
  const Series* path = e.find("path_estimate");
  ASSERT_NE(path, nullptr);
  EXPECT_EQ(path->x.size(), 14U);
  EXPECT_EQ(path->x.front(), estimate.sweeps.front().T_map_body.translation().x());
  EXPECT_EQ(e.find("path_true"), nullptr);
  EXPECT_TRUE(e.map.p_world_m.empty());
}

TEST_F(EvaluationTest, ComesBackFromItsFilesExactly) {
  const Drive drive = wobbly_drive();
  const RunTiming timing = some_timing();
  const std::vector<SweepDiagnostics> diagnostics = some_diagnostics();
  const DiagnosticsSource source = diagnostics_of(diagnostics);
  Estimate estimate = bent(drive);
  estimate.sweeps[4].status = SweepStatus::lost;  // a NaN in path_estimate
  Evaluation e = evaluate({estimate, drive.source(), &drive.truth, &drive.labels, &timing, &source}, {});
  e.seed = 18446744073709551615u;
  e.status = "crashed";
  e.message = "last words: \"\n\t\u00e9";
  e.rows[0].ci_low = 1.0 / 3;
  e.rows[0].ci_high = 5e-324;
  save_evaluation(folder_ / "new", e);
  const Evaluation back = load_evaluation(folder_ / "new");
  expect_same(e, back);
  EXPECT_EQ(back.scenario, e.scenario);
  EXPECT_EQ(back.seed, e.seed);
  EXPECT_EQ(back.estimator, e.estimator);
  EXPECT_EQ(back.status, e.status);
  EXPECT_EQ(back.message, e.message);
  EXPECT_EQ(back.coverage, e.coverage);
}

TEST_F(EvaluationTest, TimesLieInAFileOfTheirOwn) {
  const Drive drive = wobbly_drive();
  const Estimate estimate = bent(drive);
  RunTiming timing = some_timing();
  save_evaluation(folder_ / "a", evaluate({estimate, drive.source(), &drive.truth, &drive.labels, &timing}, {}));
  for (SweepTiming& sweep : timing.sweeps) sweep.wall_ms *= 1.1;
  timing.peak_memory_mb = 7;
  save_evaluation(folder_ / "b", evaluate({estimate, drive.source(), &drive.truth, &drive.labels, &timing}, {}));
  EXPECT_EQ(read_file(folder_ / "a/evaluation.json"), read_file(folder_ / "b/evaluation.json"));
  EXPECT_NE(read_file(folder_ / "a/cost.json"), read_file(folder_ / "b/cost.json"));
}

TEST_F(EvaluationTest, AnOldMapDoesNotOutliveItsEvaluation) {
  const Drive drive = wobbly_drive();
  save_evaluation(folder_, drive.evaluate(bent(drive)));
  ASSERT_TRUE(fs::exists(folder_ / "map_sample.bin"));
  save_evaluation(folder_, Evaluation{});
  EXPECT_TRUE(load_evaluation(folder_).map.p_world_m.empty());
}

TEST_F(EvaluationTest, BytesThatAreNoTextAreReplacedAndStillSaved) {
  Evaluation e;
  e.message = "crashed with \xff\xfe";
  save_evaluation(folder_, e);
  EXPECT_TRUE(load_evaluation(folder_).message.starts_with("crashed with "));
}

TEST_F(EvaluationTest, DamagedFilesAreRefused) {
  EXPECT_THROW(load_evaluation(folder_), InputError);
  const Drive drive = wobbly_drive();
  save_evaluation(folder_, drive.evaluate(bent(drive)));
  const std::string text = read_file(folder_ / "evaluation.json");
  write_file(folder_ / "evaluation.json", text.substr(0, text.size() / 2));
  EXPECT_THROW(load_evaluation(folder_), DamagedFile);
  write_file(folder_ / "evaluation.json", "{\"format\": 99}");
  EXPECT_THROW(load_evaluation(folder_), DamagedFile);
  write_file(folder_ / "evaluation.json", text);
  fs::resize_file(folder_ / "map_sample.bin", fs::file_size(folder_ / "map_sample.bin") / 2);
  EXPECT_THROW(load_evaluation(folder_), DamagedFile);
}

/// The same drive through a recording and a truth folder on disk.
TEST_F(EvaluationTest, FromDiskEqualsFromMemory) {
  Drive drive = wobbly_drive();
  {
    RecordingWriter writer(folder_ / "recording", drive.nominal);
    for (const LidarSweep& sweep : drive.sweeps) writer.write(sweep);
    writer.finish();
    fs::create_directories(folder_ / "truth");
    ChunkWriter labels(folder_ / "truth/lidar0_labels.chunks");
    for (const auto& sweep : drive.labels) labels.append(sweep.begin, sim::truth::to_chunk(sweep));
    labels.finish();
  }
  const Recording recording = Recording::open(folder_ / "recording");
  drive.truth.folder = folder_ / "truth";
  drive.nominal = recording.rig();  // a rotation's last digit may change on its way through the data sheet
  const Estimate estimate = bent(drive);
  expect_same(drive.evaluate(estimate), evaluate(estimate, recording, &drive.truth, nullptr, {}));
  EXPECT_EQ(make_control(drive.truth, recording).sweeps.size(), 15u);
}

}  // namespace
}  // namespace tarmac::metrics::tests
