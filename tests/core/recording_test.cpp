#include "core/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::message_of;

Rig example_rig() {
  Rig rig;
  rig.lidars.resize(1);
  rig.lidars[0].model = "test-lidar";
  rig.lidars[0].T_body_lidar.translation() = Eigen::Vector3d(0.1, 0, 1.9);
  rig.imus.resize(1);
  rig.imus[0].model = "test-imu";
  rig.imus[0].rate_hz = 200;
  return rig;
}

LidarSweep example_sweep(std::int64_t index, std::size_t n = 50) {
  const RandomStream stream(static_cast<std::uint64_t>(index), "test/sweep");
  LidarSweep sweep;
  sweep.index = index;
  sweep.begin = time_from_ns(100'000'000 * index);
  sweep.end = sweep.begin + Duration(99'900'000);
  for (std::size_t i = 0; i < n; ++i) {
    const auto f = [&](std::uint32_t j) { return static_cast<float>(stream.normal(i, j)); };
    sweep.push_back({f(0), f(1), f(2)}, static_cast<std::int32_t>(i) * 1000, static_cast<std::uint16_t>(i % 64), f(3));
  }
  return sweep;
}

std::vector<ImuSample> example_imu(std::size_t n) {
  std::vector<ImuSample> samples(n);
  for (std::size_t i = 0; i < n; ++i) {
    samples[i].t = time_from_ns(static_cast<std::int64_t>(i) * 5'000'000);
    samples[i].gyro_rad_s = Eigen::Vector3d(0.1, 0.2, 1.0 / static_cast<double>(i + 1));
    samples[i].accel_m_s2 = Eigen::Vector3d(0, static_cast<double>(i), 9.81);
  }
  return samples;
}

struct Content {
  Rig rig = example_rig();
  std::vector<LidarSweep> sweeps = {example_sweep(0), example_sweep(1), example_sweep(2, 0), example_sweep(4)};
  std::vector<ImuSample> imu = example_imu(90);
};

std::string write(const std::filesystem::path& folder, const Content& content) {
  RecordingWriter writer(folder, content.rig);
  for (const LidarSweep& sweep : content.sweeps) writer.write(sweep);
  if (!content.rig.imus.empty()) writer.write(0, content.imu);
  return writer.finish();
}

void expect_same(const LidarSweep& a, const LidarSweep& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.begin, b.begin);
  EXPECT_EQ(a.end, b.end);
  EXPECT_EQ(a.sensor, b.sensor);
  const auto bits = [](const std::vector<float>& v) {
    std::vector<std::uint32_t> out;
    for (const float f : v) out.push_back(std::bit_cast<std::uint32_t>(f));
    return out;
  };
  EXPECT_EQ(bits(a.x_m), bits(b.x_m));
  EXPECT_EQ(bits(a.y_m), bits(b.y_m));
  EXPECT_EQ(bits(a.z_m), bits(b.z_m));
  EXPECT_EQ(a.t_ns, b.t_ns);
  EXPECT_EQ(a.ring, b.ring);
  EXPECT_EQ(bits(a.intensity), bits(b.intensity));
}

TEST(Recording, RoundTripsBitExactlyWithEmptySweepsNansAndHoles) {
  const tests::TemporaryFolder folder;
  Content content;
  content.sweeps[0].x_m[3] = std::nanf("");
  content.sweeps[1].z_m[0] = -std::numeric_limits<float>::infinity();
  const std::string hash = write(folder / "rec", content);
  const Recording recording = Recording::open(folder / "rec");
  EXPECT_EQ(recording.hash(), hash);
  ASSERT_EQ(recording.sweep_count(), content.sweeps.size());
  for (std::size_t i = 0; i < content.sweeps.size(); ++i) expect_same(recording.sweep(i), content.sweeps[i]);
  const std::vector<ImuSample> imu = recording.imu();
  ASSERT_EQ(imu.size(), content.imu.size());
  for (std::size_t i = 0; i < imu.size(); ++i) {
    EXPECT_EQ(imu[i].t, content.imu[i].t);
    EXPECT_EQ(imu[i].gyro_rad_s, content.imu[i].gyro_rad_s);
    EXPECT_EQ(imu[i].accel_m_s2, content.imu[i].accel_m_s2);
  }
  EXPECT_EQ(rig_to_json(recording.rig()), rig_to_json(content.rig));
  EXPECT_EQ(recording.sweep_count(1), 0u);
  EXPECT_TRUE(recording.imu(1).empty());
}

TEST(Recording, OpensWithAnyExtrinsicAndNoise) {
  // The hash covers the data sheet: numbers must come back from it as they went in, whatever they are.
  const RandomStream stream(1, "test/extrinsics");
  const tests::TemporaryFolder folder;
  for (std::uint64_t k = 0; k < 20; ++k) {
    Content content;
    content.sweeps.clear();
    const auto u = [&](std::uint32_t j) { return 6 * stream.uniform(k, j) - 3; };
    content.rig.lidars[0].T_body_lidar.linear() = so3::exp({u(0), u(1), u(2)});
    content.rig.lidars[0].T_body_lidar.translation() = Eigen::Vector3d(u(3), u(4), u(5));
    content.rig.imus[0].T_body_imu.linear() = so3::exp({u(6), u(7), u(8)});
    content.rig.imus[0].gyro_noise_density_rad_s_rthz = std::exp(u(9));
    const std::string hash = write(folder.path(), content);
    ASSERT_EQ(Recording::open(folder.path()).hash(), hash) << k;
  }
}

TEST(Recording, PackedOnAnyThreadItIsTheSame) {
  const tests::TemporaryFolder folder;
  const Content content;
  const std::string hash = write(folder / "a", content);
  RecordingWriter writer(folder / "b", content.rig);
  for (const LidarSweep& sweep : content.sweeps) {
    const ChunkData chunk = RecordingWriter::chunk(sweep);
    writer.write_packed(sweep, ChunkWriter::digest(chunk), ChunkWriter::pack(chunk));
  }
  writer.write(0, content.imu);
  EXPECT_EQ(writer.finish(), hash);
  EXPECT_EQ(read_file(folder / "a" / "lidar0.chunks"), read_file(folder / "b" / "lidar0.chunks"));
}

TEST(RecordingHash, ChangesWithAnyValue) {
  const tests::TemporaryFolder folder;
  const std::string original = write(folder / "original", Content());
  EXPECT_EQ(write(folder / "again", Content()), original);
  const std::vector<std::pair<const char*, std::function<void(Content&)>>> changes = {
      {"x", [](Content& c) { c.sweeps[1].x_m[7] = std::nextafter(c.sweeps[1].x_m[7], 100.0f); }},
      {"y", [](Content& c) { c.sweeps[1].y_m[7] *= -1; }},
      {"z", [](Content& c) { c.sweeps[3].z_m.back() += 1; }},
      {"point time", [](Content& c) { c.sweeps[0].t_ns[1] += 1; }},
      {"ring", [](Content& c) { c.sweeps[0].ring[1] += 1; }},
      {"intensity", [](Content& c) { c.sweeps[0].intensity[1] += 1; }},
      {"begin", [](Content& c) { c.sweeps[2].begin += Duration(1); }},
      {"end", [](Content& c) { c.sweeps[2].end += Duration(1); }},
      {"index", [](Content& c) { c.sweeps[3].index += 1; }},
      {"order", [](Content& c) { std::swap(c.sweeps[0], c.sweeps[1]); }},
      {"a sweep less", [](Content& c) { c.sweeps.pop_back(); }},
      {"IMU time", [](Content& c) { c.imu[5].t += Duration(1); }},
      {"rate", [](Content& c) { c.imu[5].gyro_rad_s.x() = std::nextafter(c.imu[5].gyro_rad_s.x(), 1.0); }},
      {"specific force", [](Content& c) { c.imu[5].accel_m_s2.z() += 1e-12; }},
      {"extrinsic", [](Content& c) { c.rig.lidars[0].T_body_lidar.translation().x() += 1e-12; }},
      {"calibrated", [](Content& c) { c.rig.calibrated = false; }},
      {"gravity", [](Content& c) { c.rig.gravity_m_s2 += 1e-9; }},
      {"delay", [](Content& c) { c.rig.imus[0].delay += Duration(1); }},
      {"stamp convention", [](Content& c) { c.rig.lidars[0].stamp_convention = "end"; }}};
  std::vector<std::string> hashes = {original};
  for (const auto& [what, change] : changes) {
    Content content;
    change(content);
    const std::string hash = write(folder / "changed", content);
    EXPECT_THAT(hashes, ::testing::Not(::testing::Contains(hash))) << what;
    hashes.push_back(hash);
  }
}

TEST(RecordingHash, IsNotOverProvenance) {
  const tests::TemporaryFolder folder;
  const std::string hash = write(folder / "rec", Content());
  write_file(folder / "rec" / "notes.txt", "made elsewhere");
  EXPECT_EQ(Recording::open(folder / "rec").hash(), hash);
}

TEST(Recording, AnUnfinishedOneIsRefused) {
  const tests::TemporaryFolder folder;
  {
    RecordingWriter writer(folder / "rec", example_rig());
    writer.write(example_sweep(0));
  }
  EXPECT_THAT(message_of<DamagedFile>([&] { Recording::open(folder / "rec"); }),
              ::testing::AllOf(HasSubstr("manifest.json"), HasSubstr("never finished")));
}

TEST(Recording, AnInterruptedRewriteIsNotTakenForTheOldOne) {
  const tests::TemporaryFolder folder;
  write(folder / "rec", Content());
  {
    RecordingWriter writer(folder / "rec", example_rig());
    writer.write(example_sweep(0));
  }
  EXPECT_THROW(Recording::open(folder / "rec"), DamagedFile);
}

TEST(Recording, AWriterLeavesNoStreamOfAnEarlierRecording) {
  const tests::TemporaryFolder folder;
  write(folder / "rec", Content());
  Content without_imu;
  without_imu.rig.imus.clear();
  write(folder / "rec", without_imu);
  EXPECT_FALSE(std::filesystem::exists(folder / "rec" / "imu0.chunks"));
  EXPECT_TRUE(Recording::open(folder / "rec").imu().empty());
}

TEST(Recording, DamageIsRefusedWithTheFilesName) {
  const tests::TemporaryFolder folder;
  const auto damaged = [&](const char* file, const std::function<std::string(std::string)>& change) {
    write(folder / "rec", Content());
    const std::filesystem::path path = folder / "rec" / file;
    write_file(path, change(read_file(path)));
    return message_of<InputError>([&] {
      const Recording recording = Recording::open(folder / "rec");
      for (std::size_t i = 0; i < recording.sweep_count(); ++i) (void)recording.sweep(i);
      (void)recording.imu();
    });
  };
  const auto cut = [](const std::string& s) { return s.substr(0, s.size() / 2); };
  const auto flip = [](std::string s) {
    s[s.size() / 3] = static_cast<char>(~s[s.size() / 3]);
    return s;
  };
  EXPECT_THAT(damaged("lidar0.chunks", cut), HasSubstr("lidar0.chunks"));
  EXPECT_THAT(damaged("lidar0.chunks", flip), HasSubstr("lidar0.chunks"));
  EXPECT_THAT(damaged("imu0.chunks", cut), HasSubstr("imu0.chunks"));
  EXPECT_THAT(damaged("imu0.chunks", flip), HasSubstr("imu0.chunks"));
  EXPECT_THAT(damaged("manifest.json", cut), HasSubstr("manifest.json"));
  EXPECT_THAT(damaged("manifest.json", [](const std::string&) { return "[1, 2]"; }), HasSubstr("manifest.json"));
}

TEST(Recording, AStreamOfAnotherRecordingIsRefused) {
  const tests::TemporaryFolder folder;
  Content other;
  other.sweeps[0].x_m[0] += 1;
  write(folder / "a", Content());
  write(folder / "b", other);
  std::filesystem::copy_file(folder / "b" / "lidar0.chunks", folder / "a" / "lidar0.chunks",
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(message_of<DamagedFile>([&] { Recording::open(folder / "a"); }), HasSubstr("do not match the hash"));
}

TEST(Recording, AMissingStreamAndAnAlteredDataSheetAreRefused) {
  const tests::TemporaryFolder folder;
  write(folder / "rec", Content());
  std::string manifest = read_file(folder / "rec" / "manifest.json");
  const std::size_t at = manifest.find("test-lidar");
  write_file(folder / "rec" / "manifest.json", manifest.replace(at, 10, "best-lidar"));
  EXPECT_THROW(Recording::open(folder / "rec"), DamagedFile);
  write(folder / "rec", Content());
  std::filesystem::remove(folder / "rec" / "imu0.chunks");
  EXPECT_THAT(message_of<DamagedFile>([&] { Recording::open(folder / "rec"); }), HasSubstr("imu0.chunks"));
}

TEST(Recording, AnotherFormatVersionIsRefusedByName) {
  const tests::TemporaryFolder folder;
  write(folder / "rec", Content());
  std::string manifest = read_file(folder / "rec" / "manifest.json");
  const std::string version = "\"version\": 1";
  ASSERT_NE(manifest.find(version), std::string::npos);
  write_file(folder / "rec" / "manifest.json",
             manifest.replace(manifest.find(version), version.size(), "\"version\": 2"));
  EXPECT_THAT(message_of<InputError>([&] { Recording::open(folder / "rec"); }), HasSubstr("version 2"));
  EXPECT_THAT(message_of<InputError>([&] { Recording::open(folder / "absent"); }), HasSubstr("no such folder"));
}

/// "i12" for an IMU sample at 12 ns, "s0" for sweep 0.
std::vector<std::string> replayed(const Recording& recording) {
  std::vector<std::string> events;
  recording.replay([&](std::size_t, const ImuSample& s) { events.push_back("i" + std::to_string(to_ns(s.t))); },
                   [&](const LidarSweep& s) { events.push_back("s" + std::to_string(s.index)); });
  return events;
}

Content timed(const std::vector<std::array<std::int64_t, 2>>& spans, const std::vector<std::int64_t>& imu_ns) {
  Content content;
  content.sweeps.clear();
  content.imu.clear();
  for (const auto& [begin, end] : spans) {
    LidarSweep sweep = example_sweep(static_cast<std::int64_t>(content.sweeps.size()), 1);
    sweep.begin = time_from_ns(begin);
    sweep.end = time_from_ns(end);
    content.sweeps.push_back(sweep);
  }
  for (const std::int64_t t_ns : imu_ns) content.imu.push_back({.t = time_from_ns(t_ns)});
  return content;
}

TEST(RecordingReplay, ComesByAvailabilityImuFirstOnTies) {
  const tests::TemporaryFolder folder;
  write(folder / "rec", timed({{0, 10}, {11, 20}, {21, 30}}, {5, 10, 15, 20, 25, 40}));
  EXPECT_THAT(replayed(Recording::open(folder / "rec")),
              ElementsAre("i5", "i10", "s0", "i15", "i20", "s1", "i25", "s2", "i40"));
}

TEST(RecordingReplay, KeepsTheStoredOrderWhereStampsGoBackwards) {
  const tests::TemporaryFolder folder;
  write(folder / "rec", timed({{11, 20}, {0, 10}, {21, 30}}, {5, 3, 25}));
  EXPECT_THAT(replayed(Recording::open(folder / "rec")), ElementsAre("i5", "i3", "s0", "s1", "i25", "s2"));
}

TEST(RecordingReplay, WorksWithoutImuAndWithoutListeners) {
  const tests::TemporaryFolder folder;
  Content content = timed({{0, 10}, {11, 20}}, {});
  content.rig.imus.clear();
  write(folder / "rec", content);
  const Recording recording = Recording::open(folder / "rec");
  EXPECT_THAT(replayed(recording), ElementsAre("s0", "s1"));
  EXPECT_NO_THROW(recording.replay(nullptr, nullptr));
}

}  // namespace
}  // namespace tarmac::core
