#include "core/merged_sweeps.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <thread>
#include <tuple>
#include <utility>

#include "core/random.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using tests::TemporaryFolder;

constexpr std::int64_t ms = 1'000'000;

/// Sweeps of one LiDAR: firings every `step_ns` for most of each period.
std::vector<LidarSweep> stream_of(std::uint16_t sensor, std::int64_t start_ns, std::int64_t period_ns,
                                  std::int64_t step_ns, std::int64_t count) {
  std::vector<LidarSweep> sweeps;
  const RandomStream draw(sensor + std::uint64_t{1}, "test/merged");
  for (std::int64_t k = 0; k < count; ++k) {
    LidarSweep sweep;
    sweep.index = k;
    sweep.sensor = sensor;
    sweep.begin = time_from_ns(start_ns + k * period_ns);
    const std::int64_t firings = period_ns / step_ns;
    for (std::int64_t f = 0; f < firings; ++f) {
      const auto u = [&](std::uint32_t j) {
        return static_cast<float>(draw.normal(static_cast<std::uint64_t>(k * firings + f), j));
      };
      for (std::uint16_t ring = 0; ring < 3; ++ring)
        sweep.push_back({u(0), u(1), u(2) + static_cast<float>(ring)}, static_cast<std::int32_t>(f * step_ns), ring,
                        u(3));
    }
    sweep.end = sweep.begin + Duration((firings - 1) * step_ns);
    sweeps.push_back(sweep);
  }
  return sweeps;
}

Rig rig_of_three() {
  Rig rig;
  rig.lidars.resize(3);
  for (std::size_t k = 0; k < 3; ++k) {
    LidarSheet& sheet = rig.lidars[k];
    sheet.model = fmt::format("sensor-{}", k);
    sheet.T_body_lidar.linear() = so3::exp({0.1, -0.2, 0.7 * static_cast<double>(k)});
    sheet.T_body_lidar.translation() = Eigen::Vector3d(static_cast<double>(k), -0.5, 1.9);
    sheet.min_range_m = 0.5 + static_cast<double>(k);
    sheet.max_range_m = 100 - 10 * static_cast<double>(k);
  }
  rig.lidars[1].sweep_rate_hz = 20;
  return rig;
}

Recording write(const std::filesystem::path& folder, const Rig& rig,
                const std::vector<std::vector<LidarSweep>>& streams, const std::vector<ImuSample>& imu = {}) {
  RecordingWriter writer(folder, rig);
  for (const auto& stream : streams)
    for (const LidarSweep& sweep : stream) writer.write(sweep);
  if (!imu.empty()) writer.write(0, imu);
  writer.finish();
  return Recording::open(folder);
}

/// 10 Hz, 20 Hz that starts later, and 10 Hz half a period off.
std::vector<std::vector<LidarSweep>> three_streams() {
  return {stream_of(0, 1000 * ms, 100 * ms, 2 * ms, 8), stream_of(1, 1030 * ms, 50 * ms, 3 * ms, 15),
          stream_of(2, 950 * ms, 100 * ms, 5 * ms, 9)};
}

TEST(MergedSweeps, EveryPointOfTheFirstLidarsPeriodsIsThereOnceInOrderOfTimeAndInTheBodysFrame) {
  const TemporaryFolder folder;
  const auto streams = three_streams();
  const Rig rig = rig_of_three();
  const Recording recording = write(folder / "rec", rig, streams);
  const MergedSweeps merged(recording);
  ASSERT_EQ(merged.count(), 8u);
  std::set<std::tuple<int, std::uint32_t, std::uint32_t>> seen;
  for (std::size_t k = 0; k < merged.count(); ++k) {
    std::vector<PointSource> sources;
    const LidarSweep sweep = merged.sweep(k, &sources);
    EXPECT_EQ(sweep.index, static_cast<std::int64_t>(k));
    EXPECT_EQ(sweep.begin, streams[0][k].begin);
    ASSERT_EQ(sources.size(), sweep.size());
    ASSERT_EQ(sweep.point_sensor.size(), sweep.size());
    Time last = sweep.begin;
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      const PointSource& from = sources[i];
      EXPECT_TRUE(seen.insert({from.lidar, from.sweep, from.point}).second);
      EXPECT_EQ(sweep.sensor_of(i), from.lidar);
      const LidarSweep& original = streams[from.lidar][from.sweep];
      EXPECT_EQ(sweep.time(i), original.time(from.point));
      EXPECT_EQ(sweep.ring[i], original.ring[from.point]);
      EXPECT_EQ(sweep.intensity[i], original.intensity[from.point]);
      const Eigen::Vector3f expected = (rig.lidars[from.lidar].T_body_lidar * original.point(from.point)).cast<float>();
      EXPECT_EQ(sweep.point(i), expected.cast<double>());
      ASSERT_GE(sweep.time(i), last);
      last = sweep.time(i);
      if (i > 0 && sweep.time(i) == sweep.time(i - 1)) {
        ASSERT_GE(sweep.sensor_of(i), sweep.sensor_of(i - 1));
      }
    }
    EXPECT_GE(sweep.end, last);
    if (k + 1 < merged.count()) {
      EXPECT_LT(sweep.end, streams[0][k + 1].begin);
    }
  }
  // All that was fired from the first sweep's begin until the last period's end, and nothing else.
  for (std::uint16_t lidar = 0; lidar < 3; ++lidar)
    for (std::uint32_t k = 0; k < streams[lidar].size(); ++k)
      for (std::uint32_t p = 0; p < streams[lidar][k].size(); ++p) {
        const Time t = streams[lidar][k].time(p);
        const bool inside = t >= time_from_ns(1000 * ms) && t < time_from_ns(1800 * ms);
        EXPECT_EQ(seen.count({lidar, k, p}), inside ? 1u : 0u) << lidar << " " << k << " " << p;
      }
}

/// Quantised stamps tie, reversed ones go back: neither may mix up what one LiDAR fired after the other.
TEST(MergedSweeps, FaultyStampsDoNotLoseTheOrderInWhichALidarFired) {
  const TemporaryFolder folder;
  auto streams = three_streams();
  for (LidarSweep& sweep : streams[0])
    for (std::int32_t& t_ns : sweep.t_ns)
      t_ns = t_ns / static_cast<std::int32_t>(10 * ms) * static_cast<std::int32_t>(10 * ms);
  for (LidarSweep& sweep : streams[1])
    for (std::int32_t& t_ns : sweep.t_ns)
      t_ns = t_ns / static_cast<std::int32_t>(7 * ms) * static_cast<std::int32_t>(7 * ms);
  for (LidarSweep& sweep : streams[2])
    for (std::int32_t& t_ns : sweep.t_ns) t_ns = static_cast<std::int32_t>((sweep.end - sweep.begin).count()) - t_ns;
  const Recording recording = write(folder / "rec", rig_of_three(), streams);
  const MergedSweeps merged(recording);
  std::size_t backward = 0;
  for (std::size_t k = 0; k < merged.count(); ++k) {
    std::vector<PointSource> sources;
    const LidarSweep sweep = merged.sweep(k, &sources);
    std::map<std::uint16_t, std::pair<std::uint32_t, std::uint32_t>> last;
    std::optional<Time> last_of_two;
    for (std::size_t i = 0; i < sweep.size(); ++i) {
      const PointSource& from = sources[i];
      ASSERT_EQ(sweep.time(i), streams[from.lidar][from.sweep].time(from.point));
      const std::pair place{from.sweep, from.point};
      const auto [before, is_first] = last.try_emplace(from.lidar, place);
      if (!is_first) {
        ASSERT_LT(before->second, place) << "lidar " << from.lidar << " of sweep " << k;
      }
      before->second = place;
      // Those whose stamps never go back are in order of time among each other.
      if (from.lidar < 2) {
        if (last_of_two) {
          ASSERT_GE(sweep.time(i), *last_of_two);
        }
        last_of_two = sweep.time(i);
      }
      if (i > 0 && sweep.t_ns[i] < sweep.t_ns[i - 1]) ++backward;
    }
    EXPECT_EQ(last.size(), 3u);
  }
  EXPECT_GT(backward, 0u) << "the faulty stamps are not mended";
}

TEST(MergedSweeps, TheRigIsOneLidarInTheBodysFrame) {
  const TemporaryFolder folder;
  const Recording recording = write(folder / "rec", rig_of_three(), three_streams());
  const Rig rig = MergedSweeps(recording).rig();
  ASSERT_EQ(rig.lidars.size(), 1u);
  EXPECT_EQ(rig.lidars[0].model, "sensor-0 + sensor-1 + sensor-2");
  EXPECT_EQ(rig.lidars[0].T_body_lidar.matrix(), Eigen::Matrix4d::Identity());
  EXPECT_EQ(rig.lidars[0].min_range_m, 0.5);
  EXPECT_EQ(rig.lidars[0].max_range_m, 100);
  EXPECT_EQ(rig.lidars[0].sweep_rate_hz, 10);
}

TEST(MergedSweeps, NominalClockOffsetsAreTakenOffAndNothingElseOfTheClock) {
  const TemporaryFolder folder;
  Rig rig = rig_of_three();
  auto streams = three_streams();
  const Recording plain = write(folder / "plain", rig, streams);
  rig.lidars[2].clock_offset = Duration(37 * ms);
  for (LidarSweep& sweep : streams[2]) {
    sweep.begin += Duration(37 * ms);
    sweep.end += Duration(37 * ms);
  }
  const Recording offset = write(folder / "offset", rig, streams);
  for (std::size_t k = 0; k < 8; ++k) {
    const LidarSweep a = MergedSweeps(plain).sweep(k), b = MergedSweeps(offset).sweep(k);
    EXPECT_EQ(a.t_ns, b.t_ns);
    EXPECT_EQ(a.point_sensor, b.point_sensor);
    EXPECT_EQ(a.x_m, b.x_m);
  }
}

TEST(MergedSweeps, ALostSweepOfTheFirstLidarDoesNotLengthenThePeriodBefore) {
  const TemporaryFolder folder;
  auto streams = three_streams();
  streams[0].erase(streams[0].begin() + 3);
  const Recording recording = write(folder / "rec", rig_of_three(), streams);
  const MergedSweeps merged(recording);
  ASSERT_EQ(merged.count(), 7u);
  const LidarSweep before = merged.sweep(2), after = merged.sweep(3);
  EXPECT_LT(before.end, time_from_ns(1300 * ms));
  EXPECT_EQ(after.index, 4);
  EXPECT_GE(after.time(0), time_from_ns(1400 * ms));
}

TEST(MergedSweeps, ReplayHandsThemOverAtTheirLastFiringAfterTheImu) {
  const TemporaryFolder folder;
  Rig rig = rig_of_three();
  rig.imus.resize(1);
  std::vector<ImuSample> imu(90);
  for (std::size_t i = 0; i < imu.size(); ++i) imu[i].t = time_from_ns(static_cast<std::int64_t>(950 + 10 * i) * ms);
  const Recording recording = write(folder / "rec", rig, three_streams(), imu);
  const MergedSweeps merged(recording);
  std::vector<Time> events;
  std::size_t samples = 0, sweeps = 0;
  merged.replay(
      [&](std::size_t, const ImuSample& sample) {
        events.push_back(sample.t);
        ++samples;
      },
      [&](const LidarSweep& sweep) {
        events.push_back(sweep.end);
        EXPECT_EQ(sweep.index, static_cast<std::int64_t>(sweeps));
        EXPECT_EQ(sweep.x_m, merged.sweep(sweeps).x_m);
        ++sweeps;
      });
  EXPECT_EQ(samples, imu.size());
  EXPECT_EQ(sweeps, 8u);
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end()));
}

TEST(MergedSweeps, MayBeAskedForInAnyOrderOnSeveralThreads) {
  const TemporaryFolder folder;
  const Recording recording = write(folder / "rec", rig_of_three(), three_streams());
  const MergedSweeps merged(recording);
  std::vector<LidarSweep> alone;
  for (std::size_t k = 0; k < merged.count(); ++k) alone.push_back(merged.sweep(k));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 3; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t k = 0; k < 40; ++k) {
        const std::size_t at = (7 * k + t) % merged.count();
        EXPECT_EQ(merged.sweep(at).x_m, alone[at].x_m);
      }
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace tarmac::core
