#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/files.h"
#include "io/sensor/plain.h"
#include "tests/io/fabricate.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::io {
namespace {

using core::LidarSweep;
using core::Recording;
using tests::put;
using tests::TemporaryFolder;

constexpr double pi = std::numbers::pi;

TEST(KittiLayout, ExportHoldsTheDocumentedFiles) {
  const TemporaryFolder folder;
  const LidarSweep sweep = tests::sweep_of(0, 3);
  tests::record(folder / "rec", tests::calibrated_rig(), {sweep, tests::sweep_of(1, 0)}, {});
  export_kitti(Recording::open(folder / "rec"), folder / "kitti", {});
  const std::string bin = core::read_file(folder / "kitti" / "velodyne" / "000000.bin");
  std::vector<float> expected;
  for (std::size_t i = 0; i < 3; ++i) {
    expected.insert(expected.end(), {sweep.x_m[i], sweep.y_m[i], sweep.z_m[i], sweep.intensity[i]});
  }
  EXPECT_EQ(bin, tests::floats(expected));
  EXPECT_EQ(std::filesystem::file_size(folder / "kitti" / "velodyne" / "000001.bin"), 0u);
  // The middle of the sweep: begin plus half of 49,900,003 ns; the second begins 50,000,001 ns later.
  EXPECT_EQ(core::read_file(folder / "kitti" / "times.txt"), "1700000000.024950001\n1700000000.074950002\n");
}

/// A sweep of a sensor that turns clockwise from the rear: point k at t = k/n of the turn.
std::string turning_cloud(int n, float radius_m) {
  std::vector<float> values;
  for (int k = 0; k < n; ++k) {
    const double azimuth_rad = pi - 2 * pi * (k + 0.5) / n;
    values.insert(values.end(), {radius_m * static_cast<float>(std::cos(azimuth_rad)),
                                 radius_m * static_cast<float>(std::sin(azimuth_rad)), 1.0f, 0.5f});
  }
  return tests::floats(values);
}

TEST(KittiLayout, ImportDerivesPointTimesClockwiseFromTheRear) {
  const TemporaryFolder folder;
  for (const char* name : {"000000.bin", "000001.bin", "000002.bin"}) {
    put(folder / "kitti" / "velodyne" / name, turning_cloud(100, 10));
  }
  put(folder / "kitti" / "times.txt", "0.1\n2.000000e-01\n0.3\n");
  std::string note;
  import_kitti(folder / "kitti", folder / "rec", [&](double, const std::string& n) { note = n; });
  const Recording recording = Recording::open(folder / "rec");
  EXPECT_THAT(note, ::testing::HasSubstr("derived from azimuth"));
  EXPECT_THAT(recording.rig().lidars[0].model, ::testing::HasSubstr("derived from azimuth"));
  EXPECT_FALSE(recording.rig().calibrated);
  EXPECT_DOUBLE_EQ(recording.rig().lidars[0].sweep_rate_hz, 10);
  ASSERT_EQ(recording.sweep_count(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const LidarSweep sweep = recording.sweep(k);
    EXPECT_EQ(core::to_ns(sweep.begin), 50'000'000 + 100'000'000 * static_cast<std::int64_t>(k));
    EXPECT_EQ((sweep.end - sweep.begin).count(), 99'999'999) << "just before the next sweep";
    ASSERT_EQ(sweep.size(), 100u);
    for (std::size_t i = 0; i < 100; ++i) {
      // Azimuths of float32 coordinates are good to 1e-7 of a turn: 10 ns and a little.
      EXPECT_NEAR(sweep.t_ns[i], 1e8 * (static_cast<double>(i) + 0.5) / 100, 20) << i;
      EXPECT_EQ(sweep.intensity[i], 0.5f);
    }
  }
}

TEST(KittiLayout, ImportKeepsPointsThatAreNotFiniteAndEmptySweeps) {
  const TemporaryFolder folder;
  put(folder / "kitti" / "velodyne" / "000000.bin", tests::floats({std::nanf(""), 0, 0, 0, -1, 0, 0, 1}));
  put(folder / "kitti" / "velodyne" / "000001.bin", "");
  put(folder / "kitti" / "times.txt", "0\n0.1\n");
  import_kitti(folder / "kitti", folder / "rec", {});
  const Recording recording = Recording::open(folder / "rec");
  EXPECT_TRUE(std::isnan(recording.sweep(0).x_m[0]));
  EXPECT_EQ(recording.sweep(0).t_ns[0], 0);
  EXPECT_EQ(recording.sweep(0).t_ns[1], 0) << "straight back is where the turn begins";
  EXPECT_TRUE(recording.sweep(1).empty());
}

TEST(KittiLayout, RoundTripsCloudsAndMidSweepTimes) {
  const TemporaryFolder folder;
  tests::record(folder / "rec", tests::calibrated_rig(),
                {tests::sweep_of(0, 50), tests::sweep_of(1, 60), tests::sweep_of(2, 0)}, {});
  export_kitti(Recording::open(folder / "rec"), folder / "kitti", {});
  import_kitti(folder / "kitti", folder / "back", {});
  export_kitti(Recording::open(folder / "back"), folder / "again", {});
  for (const char* name : {"velodyne/000000.bin", "velodyne/000001.bin", "velodyne/000002.bin"}) {
    EXPECT_EQ(core::read_file(folder / "kitti" / name), core::read_file(folder / "again" / name)) << name;
  }
}

TEST(KittiLayout, MalformedInputIsAnErrorThatSaysWhereAndWhat) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& times, const std::string& cloud) {
    put(folder / "kitti" / "times.txt", times);
    put(folder / "kitti" / "velodyne" / "000000.bin", cloud);
    return tests::message_of<core::InputError>([&] { import_kitti(folder / "kitti", folder / "rec", {}); });
  };
  const std::string times = (folder / "kitti" / "times.txt").string();
  using ::testing::HasSubstr;
  EXPECT_THAT(error("0\n", std::string(15, '\0')), HasSubstr("000000.bin: 15 bytes: expected a multiple of 16"));
  EXPECT_THAT(error("", ""), HasSubstr("holds no time"));
  EXPECT_THAT(error("zero\n", ""), HasSubstr(times + ":1: field 1 (time) is 'zero'"));
  EXPECT_THAT(error("0 1\n", ""), HasSubstr(times + ":1: 2 fields"));
  EXPECT_THAT(error("0\n0\n", ""), HasSubstr(times + ":2: time is not after"));
  EXPECT_THAT(error("0\n0.1\n", ""), HasSubstr("000001.bin: missing"));
  put(folder / "kitti" / "velodyne" / "000001.bin", "");
  EXPECT_THAT(error("0\n", ""), HasSubstr("2 files"));
  EXPECT_THAT(error("0\n10\n", ""), HasSubstr("more than 2 s apart"));
  std::filesystem::remove(folder / "kitti" / "times.txt");
  EXPECT_THAT(tests::message_of<core::InputError>([&] { import_kitti(folder / "kitti", folder / "rec", {}); }),
              HasSubstr("times.txt"));
}

}  // namespace
}  // namespace tarmac::io
