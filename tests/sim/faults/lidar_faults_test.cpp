// What changes in a LiDAR's stream is what was asked for, and nothing else; labels keep the truth.
#include "sim/faults/lidar_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/sim/faults/fabricate.h"

namespace tarmac::sim::faults {
namespace {

using namespace core;
using tests::column_ns;
using tests::LabelledSweep;

constexpr std::int64_t sweep_count = 200;
constexpr std::uint64_t seed = 1;

struct Faulty {
  LidarFaultOptions options;
  LidarFaults faults;
  explicit Faulty(const std::string& lidar, std::int64_t count = sweep_count)
      : options(tests::faults_of("faults: {lidar: {" + lidar + "}}").lidar),
        faults(options, tests::true_sweeps(count), seed, "lidar0") {}
  LabelledSweep sweep(std::int64_t index) const {
    LabelledSweep out = tests::labelled_sweep(index);
    faults.apply(out.sweep, out.labels, faults.needs_columns() ? tests::columns() : Columns());
    return out;
  }
  std::vector<truth::Fault> log() const {
    return lidar_log(options, faults, std::vector<std::size_t>(sweep_count, tests::column_count), "lidar0");
  }
};

void expect_same_points(const LabelledSweep& a, const LabelledSweep& b) {
  EXPECT_EQ(a.sweep.x_m, b.sweep.x_m);
  EXPECT_EQ(a.sweep.y_m, b.sweep.y_m);
  EXPECT_EQ(a.sweep.ring, b.sweep.ring);
  EXPECT_EQ(a.labels.instance, b.labels.instance);
  EXPECT_EQ(a.labels.t_ns, b.labels.t_ns);
  EXPECT_EQ(a.labels.begin, b.labels.begin);
  EXPECT_EQ(a.labels.end, b.labels.end);
}

/// Every point's recorded time is `expected(true time from begin, true sweep)`, points and labels untouched.
template <class Expected>
void expect_times(const Faulty& faulty, const Expected& expected, double tolerance_ns = 0.5) {
  for (const std::int64_t index : {0, 1, 150}) {
    const LabelledSweep clean = tests::labelled_sweep(index), got = faulty.sweep(index);
    expect_same_points(got, clean);
    for (std::size_t i = 0; i < clean.sweep.size(); ++i)
      ASSERT_NEAR(static_cast<double>(got.sweep.t_ns[i]), expected(static_cast<double>(clean.sweep.t_ns[i])),
                  tolerance_ns)
          << i;
  }
}

void expect_header_shift(const Faulty& faulty, std::int64_t shift_ns) {
  for (const std::int64_t index : {0, 1, 150}) {
    const LabelledSweep clean = tests::labelled_sweep(index), got = faulty.sweep(index);
    EXPECT_EQ((got.sweep.begin - clean.sweep.begin).count(), shift_ns);
    EXPECT_EQ((got.sweep.end - clean.sweep.end).count(), shift_ns);
  }
}

const truth::Fault& only_fault(const std::vector<truth::Fault>& log) {
  EXPECT_EQ(log.size(), 1u);
  return log.at(0);
}

const auto unchanged = [](double t) { return t; };
const double span_ns = column_ns(tests::column_count - 1);

TEST(LidarFaults, NothingAskedForChangesNothingAndLogsNothing) {
  const Faulty clean("");
  EXPECT_FALSE(clean.faults.needs_columns());
  expect_times(clean, unchanged, 0);
  expect_header_shift(clean, 0);
  EXPECT_TRUE(clean.log().empty());
  for (std::int64_t k = 0; k < sweep_count; ++k) EXPECT_FALSE(clean.faults.lost(k));
}

TEST(LidarFaults, ClockOffsetShiftsEverySweepAndNoPointInside) {
  for (const double offset_ms : {5.0, -5.0}) {
    const Faulty faulty("clock_offset_ms: " + std::to_string(offset_ms));
    expect_times(faulty, unchanged, 0);
    expect_header_shift(faulty, static_cast<std::int64_t>(offset_ms * 1e6));
    const truth::Fault fault = only_fault(faulty.log());
    EXPECT_EQ(fault.kind, "clock-offset");
    EXPECT_EQ(fault.sensor, "lidar0");
    EXPECT_EQ(fault.parameters.at("offset_ms"), offset_ms);
  }
}

TEST(LidarFaults, ClockDriftGrowsWithTimeAndStretchesEachSweep) {
  const Faulty faulty("clock_drift_ppm: 200");
  expect_times(
      faulty, [](double t) { return t * (1 + 200e-6); }, 1.1);
  EXPECT_EQ(to_ns(faulty.sweep(0).sweep.begin), 0);
  EXPECT_EQ(to_ns(faulty.sweep(150).sweep.begin), 15'000'000'000 + 3'000'000);
  EXPECT_EQ(only_fault(faulty.log()).parameters.at("drift_ppm"), 200);
}

TEST(LidarFaults, SweepJitterHasItsSigmaAndKeepsSweepsInOrder) {
  const double sigma_ms = 0.4;
  const Faulty faulty("sweep_jitter_ms: 0.4");
  double sum2 = 0;
  Time last_end = time_from_ns(-1'000'000'000);
  for (std::int64_t k = 0; k < sweep_count; ++k) {
    const LabelledSweep clean = tests::labelled_sweep(k), got = faulty.sweep(k);
    const double jitter_ms = 1e-6 * static_cast<double>((got.sweep.begin - clean.sweep.begin).count());
    sum2 += jitter_ms * jitter_ms;
    EXPECT_LT(last_end, got.sweep.begin) << k;
    EXPECT_LE(got.sweep.begin, got.sweep.end) << k;
    EXPECT_EQ(got.sweep.t_ns, clean.sweep.t_ns);
    last_end = got.sweep.end;
  }
  // The relative standard deviation of a sigma from n draws is 1 / sqrt(2 n) = 5 %.
  EXPECT_NEAR(std::sqrt(sum2 / sweep_count) / sigma_ms, 1, 0.15);
  EXPECT_EQ(only_fault(faulty.log()).parameters.at("sigma_ms"), sigma_ms);
}

TEST(LidarFaults, JitterBeyondAWholeSweepStillGivesSweepsInOrder) {
  const Faulty faulty("sweep_jitter_ms: 300");
  Time last_end = time_from_ns(-100'000'000'000);
  for (std::int64_t k = 0; k < sweep_count; ++k) {
    const LidarSweep sweep = faulty.sweep(k).sweep;
    EXPECT_LE(last_end, sweep.begin) << k;
    EXPECT_LE(sweep.begin, sweep.end) << k;
    last_end = sweep.end;
  }
}

TEST(LidarFaults, PacketJitterMovesSixteenColumnsTogether) {
  const Faulty faulty("packet_jitter_ms: 0.2");
  double sum2 = 0;
  int packets = 0;
  for (std::int64_t k = 0; k < 20; ++k) {
    const LabelledSweep clean = tests::labelled_sweep(k), got = faulty.sweep(k);
    expect_same_points(got, clean);
    std::vector<double> jitter_ns(tests::column_count / 16, NAN);
    for (std::size_t i = 0; i < got.sweep.size(); ++i) {
      double& of_packet = jitter_ns[static_cast<std::size_t>(got.sweep.x_m[i]) / 16];
      const double jitter = got.sweep.t_ns[i] - clean.sweep.t_ns[i];
      if (std::isnan(of_packet)) of_packet = jitter;
      ASSERT_EQ(jitter, of_packet);
    }
    for (const double jitter : jitter_ns) sum2 += jitter * jitter;
    packets += static_cast<int>(jitter_ns.size());
  }
  EXPECT_NEAR(std::sqrt(sum2 / packets) / 0.2e6, 1, 0.06);  // 1280 draws: 1 sigma is 2 %
}

TEST(LidarFaults, StampConventionDelaysTheWholeSweep) {
  expect_header_shift(Faulty("stamp: mid"), static_cast<std::int64_t>(span_ns) / 2);
  const Faulty end("stamp: end");
  expect_header_shift(end, static_cast<std::int64_t>(span_ns));
  expect_times(end, unchanged, 0);
  EXPECT_EQ(only_fault(end.log()).parameters.at("fraction_of_sweep"), 1);
}

TEST(LidarFaults, PointTimesCountFromAnotherInstant) {
  const Faulty mid("point_time_origin: mid"), end("point_time_origin: end");
  expect_times(mid, [](double t) { return t - span_ns / 2; });
  expect_times(
      end, [](double t) { return t - span_ns; }, 0);
  expect_header_shift(end, 0);
  EXPECT_EQ(only_fault(mid.log()).kind, "point-time-origin");
}

TEST(LidarFaults, WrongUnitsAreWholeMicrosecondsOrMillisecondsTakenAsNanoseconds) {
  const Faulty us("point_time_unit: us"), ms("point_time_unit: ms");
  expect_times(
      us, [](double t) { return std::floor(t / 1e3); }, 0);
  expect_times(
      ms, [](double t) { return std::floor(t / 1e6); }, 0);
  expect_header_shift(us, 0);
  EXPECT_EQ(only_fault(us.log()).parameters.at("factor"), 1e-3);
  EXPECT_EQ(only_fault(ms.log()).parameters.at("factor"), 1e-6);
}

TEST(LidarFaults, ScaledTimesLeaveTheSweepButItsStampsStayInOrder) {
  const Faulty faulty("point_time_scale: 1.25");
  expect_times(faulty, [](double t) { return 1.25 * t; });
  expect_header_shift(faulty, 0);
  EXPECT_EQ(only_fault(faulty.log()).parameters.at("factor"), 1.25);
}

TEST(LidarFaults, ReversedTimesRunFromTheEndToTheBegin) {
  const Faulty faulty("point_time_reversed: true");
  expect_times(
      faulty, [](double t) { return span_ns - t; }, 0);
  EXPECT_EQ(only_fault(faulty.log()).kind, "point-times-reversed");
}

TEST(LidarFaults, QuantisedTimesAreCutDownToTheirStep) {
  const Faulty faulty("point_time_step_ms: 1");
  expect_times(
      faulty, [](double t) { return std::floor(t / 1e6) * 1e6; }, 0);
  EXPECT_EQ(only_fault(faulty.log()).parameters.at("step_ms"), 1);
}

TEST(LidarFaults, StampsPerPacketAreThoseOfItsFirstColumn) {
  const Faulty faulty("point_time_per_packet: true");
  for (const std::int64_t index : {0, 150}) {
    const LabelledSweep clean = tests::labelled_sweep(index), got = faulty.sweep(index);
    expect_same_points(got, clean);
    for (std::size_t i = 0; i < got.sweep.size(); ++i)
      ASSERT_EQ(got.sweep.t_ns[i], column_ns(static_cast<std::int64_t>(got.sweep.x_m[i]) / 16 * 16)) << i;
  }
}

TEST(LidarFaults, Float32StampsStepByTheFloatsSpacingAtTheirEpoch) {
  // Between 8192 and 16384 s a float32 steps by 2^-10 s.
  const Faulty faulty("point_time_float32: true, float32_epoch_s: 10000");
  const double step_s = std::ldexp(1, -10);
  const LabelledSweep clean = tests::labelled_sweep(150), got = faulty.sweep(150);
  expect_same_points(got, clean);
  std::vector<std::int32_t> distinct = got.sweep.t_ns;
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  EXPECT_NEAR(static_cast<double>(distinct.size()), span_ns * 1e-9 / step_s, 2);
  for (std::size_t i = 0; i < got.sweep.size(); ++i) {
    ASSERT_LE(std::abs(got.sweep.t_ns[i] - clean.sweep.t_ns[i]), step_s / 2 * 1e9 + 1);
    const double stamp_s = 10000 + to_s(got.sweep.time(i)), steps = stamp_s / step_s;
    ASSERT_NEAR(steps, std::round(steps), 1e-5);
  }
  // Without an epoch, a recording of seconds keeps its microseconds.
  expect_times(Faulty("point_time_float32: true"), unchanged, 1e9 * std::ldexp(1, -21));
  EXPECT_EQ(only_fault(faulty.log()).parameters.at("epoch_s"), 10000);
}

TEST(LidarFaults, MissingStampsAreAllTheSweeps) {
  expect_times(
      Faulty("point_time_missing: true"), [](double) { return 0.0; }, 0);
}

TEST(LidarFaults, ErrorsAddUpInTheirOrder) {
  // Reversed first, then scaled, then cut.
  expect_times(
      Faulty("point_time_reversed: true, point_time_scale: 0.5, point_time_step_ms: 1"),
      [](double t) { return std::floor((span_ns - t) / 2 / 1e6) * 1e6; }, 0);
}

TEST(LidarFaults, LostPacketsTakeSixteenColumnsWithTheirLabelsAtTheirRate) {
  const Faulty faulty("lost_packets: 0.1");
  double lost = 0;
  for (std::int64_t k = 0; k < sweep_count; ++k) {
    const LabelledSweep clean = tests::labelled_sweep(k), got = faulty.sweep(k);
    std::vector<int> found(tests::column_count / 16, 0), there(found);
    for (const float x : clean.sweep.x_m) ++there[static_cast<std::size_t>(x) / 16];
    for (std::size_t i = 0; i < got.sweep.size(); ++i) {
      ++found[static_cast<std::size_t>(got.sweep.x_m[i]) / 16];
      const auto firing = static_cast<std::uint32_t>(2 * got.sweep.x_m[i] + got.sweep.y_m[i]);
      ASSERT_EQ(got.labels.instance[i], firing) << "the label went with its point";
      ASSERT_EQ(got.labels.t_ns[i], got.sweep.t_ns[i]);
    }
    for (std::size_t p = 0; p < found.size(); ++p) {
      ASSERT_TRUE(found[p] == 0 || found[p] == there[p]) << "packets are lost whole";
      lost += found[p] == 0;
    }
    EXPECT_EQ(got.sweep.begin, clean.sweep.begin);
    EXPECT_EQ(got.sweep.end, clean.sweep.end);
    EXPECT_EQ(got.labels.label.size(), got.sweep.size());
    EXPECT_EQ(got.labels.moving.size(), got.sweep.size());
  }
  const double packets = static_cast<double>(sweep_count * tests::column_count / 16);
  EXPECT_NEAR(lost / packets, 0.1, 4 * std::sqrt(0.1 * 0.9 / packets));
  const std::vector<truth::Fault> log = faulty.log();
  EXPECT_EQ(only_fault(log).parameters.at("lost"), lost);
  EXPECT_EQ(only_fault(log).parameters.at("packets"), packets);
}

TEST(LidarFaults, ALostSectorIsEmptyInItsTimeAndFullOtherwise) {
  // The head is at 180 deg at the begin; 350 to 10 deg is the middle of the sweep.
  const Faulty faulty("lost_sectors: [{from_deg: 350, to_deg: 10, from_s: 5, to_s: 10}]");
  for (const std::int64_t k : {49, 50, 99, 100}) {
    const LabelledSweep clean = tests::labelled_sweep(k), got = faulty.sweep(k);
    if (k < 50 || k >= 100) {
      expect_same_points(got, clean);
      continue;
    }
    std::size_t expected = 0;
    for (const float x : clean.sweep.x_m) {
      const double azimuth = std::fmod(180 + 360.0 * x / tests::column_count, 360);
      expected += !(azimuth >= 350 || azimuth < 10);
    }
    EXPECT_LT(expected, clean.sweep.size());
    EXPECT_EQ(got.sweep.size(), expected);
    for (const float x : got.sweep.x_m) {
      const double azimuth = std::fmod(180 + 360.0 * x / tests::column_count, 360);
      ASSERT_TRUE(azimuth >= 10 && azimuth < 350) << azimuth;
    }
  }
  EXPECT_EQ(only_fault(faulty.log()).parameters.at("to_deg"), 10);
}

TEST(LidarFaults, LostSweepsLeaveHolesAsLogged) {
  const Faulty faulty("lost_sweeps: 0.2, sweep_gaps: [{from_s: 5, to_s: 6}]");
  int lost = 0;
  for (std::int64_t k = 0; k < sweep_count; ++k) {
    lost += faulty.faults.lost(k);
    if (k >= 50 && k < 60) {
      EXPECT_TRUE(faulty.faults.lost(k)) << k;
    }
  }
  EXPECT_NEAR(lost, 10 + 0.2 * 190, 4 * std::sqrt(0.2 * 0.8 * 190));
  const auto log = faulty.log();
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[0].kind, "sweep-gap");
  EXPECT_EQ(log[1].kind, "lost-sweeps");
  EXPECT_EQ(log[1].parameters.at("lost"), lost);
}

TEST(LidarFaults, EachChanceHasItsOwnDraws) {
  // Losing packets changes neither which sweeps are lost nor how their stamps jitter.
  const Faulty one("lost_sweeps: 0.2, sweep_jitter_ms: 1");
  const Faulty both("lost_sweeps: 0.2, sweep_jitter_ms: 1, lost_packets: 0.3, packet_jitter_ms: 0.1");
  for (std::int64_t k = 0; k < sweep_count; ++k) {
    EXPECT_EQ(one.faults.lost(k), both.faults.lost(k));
    EXPECT_EQ(one.sweep(k).sweep.begin, both.sweep(k).sweep.begin);
  }
}

TEST(LidarFaults, AWrongMountingIsLoggedWithItsNumbers) {
  const Faulty faulty("extrinsic_error: {xyz_m: [0.05, 0, -0.02], rpy_deg: [0, 0, 1]}");
  const truth::Fault fault = only_fault(faulty.log());
  EXPECT_EQ(fault.kind, "wrong-extrinsic");
  EXPECT_DOUBLE_EQ(fault.parameters.at("x_m"), 0.05);
  EXPECT_NEAR(fault.parameters.at("rotation_z_rad"), M_PI / 180, 1e-15);
}

}  // namespace
}  // namespace tarmac::sim::faults
