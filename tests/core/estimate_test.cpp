#include "core/estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/diagnostics.h"
#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using tests::message_of;

Time at_ns(std::int64_t t_ns) {
  return time_from_ns(t_ns);
}

SE3 random_pose(std::uint64_t i) {
  const RandomStream stream(1, "test/estimate");
  Vector6 xi;
  for (std::uint32_t k = 0; k < 6; ++k) xi[k] = stream.normal(i, k);
  return se3::exp(xi);
}

/// One segment of every model.
Estimate example() {
  Estimate e;
  e.estimator = "kiss-icp";
  e.status = RunStatus::not_initialised;
  e.message = "never at rest: \xc3\xa9";
  e.gravity_aligned = true;
  e.has_final = true;
  e.causal.append(Segment::two_pose(SegmentModel::two_pose_slerp, at_ns(0), random_pose(0), at_ns(10), random_pose(1)));
  e.causal.append(
      Segment::two_pose(SegmentModel::two_pose_screw, at_ns(10), random_pose(2), at_ns(20), random_pose(3)));
  e.causal.append(Segment::hold(at_ns(25), at_ns(30), random_pose(4)));
  const std::vector<Time> times = {at_ns(30), at_ns(33), at_ns(40)};
  e.causal.append(
      Segment::sampled(SegmentModel::sampled_screw, times, {random_pose(5), random_pose(6), random_pose(7)}));
  e.final.append(
      Segment::sampled(SegmentModel::sampled_slerp, times, {random_pose(8), random_pose(9), random_pose(10)}));
  e.final.append(Segment::sampled(SegmentModel::sampled_hold, {at_ns(41)}, {random_pose(11)}));
  for (int k = 0; k < 5; ++k) {
    e.sweeps.push_back({k == 3 ? 7 : k, at_ns(10 * k), at_ns(10 * k + 9), at_ns(10 * k + 8),
                        static_cast<SweepStatus>(k), random_pose(20 + static_cast<std::uint64_t>(k))});
  }
  return e;
}

void expect_same(const PiecewiseTrajectory& a, const PiecewiseTrajectory& b) {
  ASSERT_EQ(a.segments().size(), b.segments().size());
  for (std::size_t i = 0; i < a.segments().size(); ++i) {
    const Segment &s = a.segments()[i], &r = b.segments()[i];
    EXPECT_EQ(s.t0, r.t0);
    EXPECT_EQ(s.t1, r.t1);
    EXPECT_EQ(s.model, r.model);
    EXPECT_EQ(s.times, r.times);
    ASSERT_EQ(s.poses.size(), r.poses.size());
    for (std::size_t k = 0; k < s.poses.size(); ++k) EXPECT_EQ(s.poses[k].matrix(), r.poses[k].matrix());
  }
}

TEST(Estimate, RoundTripsBitExactly) {
  const tests::TemporaryFolder folder;
  const Estimate e = example();
  save_estimate(folder / "trajectory.bin", e);
  const Estimate back = load_estimate(folder / "trajectory.bin");
  EXPECT_EQ(back.estimator, e.estimator);
  EXPECT_EQ(back.status, e.status);
  EXPECT_EQ(back.message, e.message);
  EXPECT_EQ(back.gravity_aligned, e.gravity_aligned);
  EXPECT_EQ(back.has_causal, e.has_causal);
  EXPECT_EQ(back.has_final, e.has_final);
  expect_same(back.causal, e.causal);
  expect_same(back.final, e.final);
  ASSERT_EQ(back.sweeps.size(), e.sweeps.size());
  for (std::size_t i = 0; i < e.sweeps.size(); ++i) {
    EXPECT_EQ(back.sweeps[i].index, e.sweeps[i].index);
    EXPECT_EQ(back.sweeps[i].begin, e.sweeps[i].begin);
    EXPECT_EQ(back.sweeps[i].end, e.sweeps[i].end);
    EXPECT_EQ(back.sweeps[i].reference, e.sweeps[i].reference);
    EXPECT_EQ(back.sweeps[i].status, e.sweeps[i].status);
    EXPECT_EQ(back.sweeps[i].T_map_body.matrix(), e.sweeps[i].T_map_body.matrix());
  }
}

TEST(Estimate, AnEmptyOneRoundTrips) {
  const tests::TemporaryFolder folder;
  save_estimate(folder / "trajectory.bin", Estimate());
  const Estimate back = load_estimate(folder / "trajectory.bin");
  EXPECT_TRUE(back.causal.empty());
  EXPECT_TRUE(back.sweeps.empty());
  EXPECT_EQ(back.status, RunStatus::ok);
}

TEST(Estimate, TheSameEstimateGivesTheSameBytes) {
  const tests::TemporaryFolder folder;
  save_estimate(folder / "a", example());
  save_estimate(folder / "b", example());
  EXPECT_EQ(read_file(folder / "a"), read_file(folder / "b"));
}

TEST(Estimate, DamageIsRefusedByName) {
  const tests::TemporaryFolder folder;
  save_estimate(folder / "trajectory.bin", example());
  const std::string whole = read_file(folder / "trajectory.bin");
  for (const std::size_t size : {std::size_t{0}, whole.size() / 3, whole.size() / 2, whole.size() - 1}) {
    write_file(folder / "cut.bin", whole.substr(0, size));
    EXPECT_THAT(message_of<DamagedFile>([&] { load_estimate(folder / "cut.bin"); }), ::testing::HasSubstr("cut.bin"))
        << size;
  }
  for (std::size_t at = 3; at < whole.size(); at += 97) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(~flipped[at]);
    write_file(folder / "flipped.bin", flipped);
    EXPECT_THROW(load_estimate(folder / "flipped.bin"), DamagedFile) << at;
  }
}

TEST(Estimate, FilesOfAnotherKindAreRefused) {
  const tests::TemporaryFolder folder;
  save_diagnostics(folder / "diagnostics.bin", {SweepDiagnostics(), SweepDiagnostics(), SweepDiagnostics()});
  EXPECT_THROW(load_estimate(folder / "diagnostics.bin"), DamagedFile);
  save_estimate(folder / "trajectory.bin", example());
  EXPECT_THROW(load_diagnostics(folder / "trajectory.bin"), DamagedFile);
}

TEST(Estimate, HeadlineIsCausalWhereThereIsOne) {
  Estimate e = example();
  EXPECT_EQ(&e.headline(), &e.causal);
  e.has_causal = false;
  EXPECT_EQ(&e.headline(), &e.final);
}

TEST(Estimate, StatusesHaveNames) {
  EXPECT_STREQ(name_of(SweepStatus::out_of_order), "out_of_order");
  EXPECT_STREQ(name_of(RunStatus::not_initialised), "not_initialised");
}

SweepDiagnostics example_diagnostics(std::uint64_t number) {
  const RandomStream stream(number, "test/diagnostics");
  SweepDiagnostics d;
  d.index = static_cast<std::int64_t>(number) + 1000;
  d.iterations = 12;
  d.converged = number % 2 == 0;
  d.points_in = 65000;
  d.points_used = 3000;
  d.residuals = 2999;
  d.scale_m = 0.1 + 0.2;
  for (std::uint32_t k = 0; k < 36; ++k) {
    d.H_data(k / 6, k % 6) = stream.normal(0, k);
    d.H_prior(k / 6, k % 6) = stream.normal(1, k);
    d.covariance(k / 6, k % 6) = stream.normal(100, k);
  }
  d.rows_are_surface = number == 1;
  for (std::uint64_t i = 0; i < 20 * number; ++i) {
    const auto f = [&](std::uint32_t j) { return static_cast<float>(stream.normal(i + 2, j)); };
    (i % 3 == 0 ? d.surface : d.rows)
        .push_back({static_cast<std::int32_t>(i) - 5,
                    f(0),
                    f(1),
                    {f(2), f(3), f(4), f(5), f(6), f(7)},
                    static_cast<std::uint16_t>(i)});
  }
  return d;
}

void expect_same_rows(const std::vector<ResidualRow>& a, const std::vector<ResidualRow>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].t_ns, b[i].t_ns);
    EXPECT_EQ(a[i].value, b[i].value);
    EXPECT_EQ(a[i].weight, b[i].weight);
    EXPECT_EQ(a[i].sensor, b[i].sensor);
    for (int j = 0; j < 6; ++j) EXPECT_EQ(a[i].jacobian[j], b[i].jacobian[j]);
  }
}

TEST(Diagnostics, RoundTripBitExactly) {
  const tests::TemporaryFolder folder;
  const std::vector<SweepDiagnostics> sweeps = {example_diagnostics(0), example_diagnostics(1), example_diagnostics(2)};
  save_diagnostics(folder / "diagnostics.bin", sweeps);
  const std::vector<SweepDiagnostics> back = load_diagnostics(folder / "diagnostics.bin");
  ASSERT_EQ(back.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(back[k].index, sweeps[k].index);
    EXPECT_EQ(back[k].iterations, sweeps[k].iterations);
    EXPECT_EQ(back[k].converged, sweeps[k].converged);
    EXPECT_EQ(back[k].points_in, sweeps[k].points_in);
    EXPECT_EQ(back[k].points_used, sweeps[k].points_used);
    EXPECT_EQ(back[k].residuals, sweeps[k].residuals);
    EXPECT_EQ(back[k].scale_m, sweeps[k].scale_m);
    EXPECT_EQ(back[k].H_data, sweeps[k].H_data);
    EXPECT_EQ(back[k].H_prior, sweeps[k].H_prior);
    EXPECT_EQ(back[k].covariance, sweeps[k].covariance);
    EXPECT_EQ(back[k].rows_are_surface, sweeps[k].rows_are_surface);
    expect_same_rows(back[k].rows, sweeps[k].rows);
    expect_same_rows(back[k].surface, sweeps[k].surface);
  }
  save_diagnostics(folder / "none.bin", {});
  EXPECT_TRUE(load_diagnostics(folder / "none.bin").empty());
}

TEST(Diagnostics, AFileThatWasNotFinishedIsNotThere) {
  const tests::TemporaryFolder folder;
  {
    DiagnosticsWriter writer(folder / "diagnostics.bin");
    writer.append(example_diagnostics(1));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "diagnostics.bin"));
  EXPECT_THROW(DiagnosticsReader(folder / "diagnostics.bin.part"), DamagedFile);
}

TEST(Diagnostics, LevelsHaveNames) {
  EXPECT_EQ(diagnostics_level("none"), DiagnosticsLevel::none);
  EXPECT_EQ(diagnostics_level("system"), DiagnosticsLevel::system);
  EXPECT_EQ(diagnostics_level("full"), DiagnosticsLevel::full);
  EXPECT_THAT(message_of<InputError>([] { diagnostics_level("all"); }), ::testing::HasSubstr("none, system or full"));
}

TEST(Timing, RoundTrips) {
  const tests::TemporaryFolder folder;
  RunTiming timing;
  timing.threads = 2;
  timing.wall_s = 1.0 / 3;
  timing.cpu_s = 0.5;
  timing.peak_memory_mb = 123.25;
  timing.sweeps = {{4, 1.5, 2.5, {{"search", 0.1}, {"deskew", 0.2}}}, {5, 1.25, 2, {}}};
  save_timing(folder / "timing.json", timing);
  const RunTiming back = load_timing(folder / "timing.json");
  EXPECT_EQ(back.threads, timing.threads);
  EXPECT_EQ(back.wall_s, timing.wall_s);
  EXPECT_EQ(back.cpu_s, timing.cpu_s);
  EXPECT_EQ(back.peak_memory_mb, timing.peak_memory_mb);
  ASSERT_EQ(back.sweeps.size(), 2u);
  EXPECT_EQ(back.sweeps[0].index, 4);
  EXPECT_EQ(back.sweeps[0].wall_ms, 1.5);
  EXPECT_EQ(back.sweeps[0].cpu_ms, 2.5);
  EXPECT_EQ(back.sweeps[0].stages_ms, timing.sweeps[0].stages_ms) << "in their order";
  EXPECT_TRUE(back.sweeps[1].stages_ms.empty());
}

TEST(Timing, DamageIsRefusedByName) {
  const tests::TemporaryFolder folder;
  for (const char* content : {"", "{", "[]", "{\"threads\": 1}"}) {
    write_file(folder / "timing.json", content);
    EXPECT_THAT(message_of<DamagedFile>([&] { load_timing(folder / "timing.json"); }),
                ::testing::HasSubstr("timing.json"))
        << content;
  }
}

}  // namespace
}  // namespace tarmac::core
