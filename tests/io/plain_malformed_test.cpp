#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/error.h"
#include "core/files.h"
#include "io/sensor/plain.h"
#include "tests/io/fabricate.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::io {
namespace {

using core::InputError;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::put;
using tests::TemporaryFolder;

/// A sound folder of two sweeps with rings, IMU and calibration; each case breaks one thing.
class MalformedPlain : public ::testing::Test {
 protected:
  MalformedPlain() {
    const std::string sweep = tests::floats({1, 2, 3, 4, 0, 5, 6, 7, 8, 0.05f});
    for (const char* name : {"000000", "000001"}) {
      put(path(std::string("lidar/") + name + ".bin"), sweep);
      put(path(std::string("lidar/") + name + ".ring"), std::string(4, '\1'));
    }
    put(path("lidar/stamps.txt"), "0 100000000\n100000000 200000000\n");
    put(path("imu.csv"), "t_ns,gx,gy,gz,ax,ay,az\n0,0,0,0,0,0,9.8\n5000000,0,0,0,0,0,9.8\n");
    put(path("calibration.yaml"),
        "lidar:\n  T_body_lidar: {xyz_m: [0, 0, 2]}\nimu:\n  T_body_imu: {xyz_m: [1, 0, 0]}\n  rate_hz: 200\n");
  }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / "plain" / name; }
  void import() const { import_plain(path(""), folder_ / "rec", {}); }
  std::string error() const {
    return tests::message_of<InputError>([&] { import(); });
  }
  std::string at(const std::string& name) const { return path(name).string(); }
  /// The error after that file has that content.
  std::string error_with(const std::string& name, const std::string& content) {
    const std::string before = core::read_file(path(name));
    put(path(name), content);
    const std::string message = error();
    EXPECT_THROW(core::Recording::open(folder_ / "rec"), InputError) << "nothing that could be taken for whole";
    put(path(name), before);
    return message;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(MalformedPlain, TheSoundFolderIsRead) {
  EXPECT_NO_THROW(import());
}

TEST_F(MalformedPlain, Stamps) {
  EXPECT_THAT(error_with("lidar/stamps.txt", "0 1\n2\n"),
              AllOf(StartsWith(at("lidar/stamps.txt") + ":2: 1 fields"), HasSubstr("begin and end")));
  EXPECT_THAT(error_with("lidar/stamps.txt", "0 1\n2 3 4\n"), HasSubstr(":2: 3 fields"));
  EXPECT_THAT(error_with("lidar/stamps.txt", "0 1.5\n2 3\n"),
              AllOf(HasSubstr(":1: field 2 (end) is '1.5'"), HasSubstr("integer nanoseconds")));
  EXPECT_THAT(error_with("lidar/stamps.txt", "0 1\n5 4\n"), HasSubstr(":2: the sweep ends before it begins"));
  EXPECT_THAT(error_with("lidar/stamps.txt", ""), HasSubstr("holds no sweep"));
  EXPECT_THAT(error_with("lidar/stamps.txt", "0 1\n2 3\n4 5\n"),
              AllOf(StartsWith(at("lidar/000002.bin") + ": missing"), HasSubstr("3 lines")));
  EXPECT_THAT(error_with("lidar/stamps.txt", "0 1\n"), AllOf(HasSubstr("1 lines"), HasSubstr("2 files")));
  std::filesystem::remove(path("lidar/stamps.txt"));
  EXPECT_THAT(error(), AllOf(StartsWith(at("lidar/stamps.txt") + ": missing"), HasSubstr("begin end")));
}

TEST_F(MalformedPlain, Sweeps) {
  EXPECT_THAT(error_with("lidar/000001.bin", std::string(39, '\0')),
              AllOf(StartsWith(at("lidar/000001.bin") + ": 39 bytes"), HasSubstr("multiple of 20")));
  const float nan = std::nanf("");
  const auto with_time = [&](float t_s) { return tests::floats({1, 2, 3, 4, 0, 5, 6, 7, 8, t_s}); };
  EXPECT_THAT(
      error_with("lidar/000001.bin", with_time(nan)),
      AllOf(StartsWith(at("lidar/000001.bin") + ": point 1: t is nan"), HasSubstr("seconds since the sweep's begin")));
  EXPECT_THAT(error_with("lidar/000001.bin", with_time(50000)), HasSubstr("another unit"));
  EXPECT_THAT(error_with("lidar/000001.bin", with_time(-3)), HasSubstr("point 1: t is -3"));
  std::filesystem::remove(path("lidar/000001.bin"));
  EXPECT_THAT(error(), StartsWith(at("lidar/000001.bin") + ": missing"));
}

TEST_F(MalformedPlain, Rings) {
  EXPECT_THAT(error_with("lidar/000001.ring", std::string(3, '\0')),
              AllOf(StartsWith(at("lidar/000001.ring")), HasSubstr("multiple of 2")));
  EXPECT_THAT(error_with("lidar/000001.ring", std::string(2, '\0')),
              AllOf(HasSubstr("1 rings"), HasSubstr("expected 2")));
  std::filesystem::remove(path("lidar/000001.ring"));
  EXPECT_THAT(error(), StartsWith(at("lidar/000001.ring") + ": missing"));
  std::filesystem::remove(path("lidar/000000.ring"));
  EXPECT_NO_THROW(import()) << "rings are optional, all together";
}

TEST_F(MalformedPlain, ImuCsv) {
  const std::string header = "t_ns,gx,gy,gz,ax,ay,az\n";
  EXPECT_THAT(error_with("imu.csv", ""), AllOf(StartsWith(at("imu.csv")), HasSubstr("expected the header")));
  EXPECT_THAT(error_with("imu.csv", "0,0,0,0,0,0,9.8\n"),
              AllOf(StartsWith(at("imu.csv") + ":1: "), HasSubstr("expected the header")));
  EXPECT_THAT(error_with("imu.csv", "t_ns,ax,ay,az,gx,gy,gz\n"), HasSubstr("expected the header"));
  EXPECT_THAT(error_with("imu.csv", header + "0,0,0,0,0,0,9.8\n1,0,0,0,0,0\n"),
              AllOf(StartsWith(at("imu.csv") + ":3: 6 fields"), HasSubstr("expected 7")));
  EXPECT_THAT(error_with("imu.csv", header + "0,0,0,0,0,up,9.8\n"), HasSubstr(":2: field 6 (ay) is 'up'"));
  EXPECT_THAT(error_with("imu.csv", header + "0,nan,0,0,0,0,9.8\n"),
              AllOf(HasSubstr("field 2 (gx)"), HasSubstr("finite")));
  EXPECT_THAT(error_with("imu.csv", header + "0.5,0,0,0,0,0,9.8\n"),
              AllOf(HasSubstr("field 1 (t_ns)"), HasSubstr("integer nanoseconds")));
  put(path("imu.csv"), header + "5,0,0,0,0,0,1\n5,0,0,0,0,0,2\n3,0,0,0,0,0,3\n");
  EXPECT_NO_THROW(import()) << "stamps out of order are kept for the harness to judge";
}

TEST_F(MalformedPlain, Calibration) {
  const auto error_of = [&](const std::string& text) { return error_with("calibration.yaml", text); };
  const std::string lidar = "lidar:\n  T_body_lidar: {xyz_m: [0, 0, 2]}\n",
                    imu = "imu:\n  T_body_imu: {xyz_m: [1, 0, 0]}\n";
  const std::string file = at("calibration.yaml");
  EXPECT_THAT(error_of(lidar + imu + "gravity: 9.8\n"),
              AllOf(StartsWith(file + ":5: gravity: "), HasSubstr("gravity_m_s2")));
  EXPECT_THAT(error_of("lidar:\n  T_body_lidr: {xyz_m: [0, 0, 2]}\n" + imu),
              AllOf(StartsWith(file + ":2: lidar.T_body_lidr"), HasSubstr("did you mean 'T_body_lidar'")));
  EXPECT_THAT(error_of(lidar), AllOf(StartsWith(file), HasSubstr("imu"), HasSubstr("T_body_imu is missing")));
  EXPECT_THAT(error_of(lidar + "imu: {rate_hz: 100}\n"),
              AllOf(StartsWith(file + ":3: imu: "), HasSubstr("T_body_imu is missing")));
  EXPECT_THAT(error_of(imu), HasSubstr("T_body_lidar is missing"));
  EXPECT_THAT(error_of(lidar + imu + "  rate_hz: -5\n"),
              AllOf(StartsWith(file + ":5: imu.rate_hz"), HasSubstr("above 0")));
  EXPECT_THAT(error_of(lidar + "  stamp_convention: middle\n" + imu), HasSubstr("begin, mid, end"));
  EXPECT_THAT(error_of("lidar: {T_body_lidar: {quat_xyzw: [1, 1, 0, 0]}}\n" + imu),
              AllOf(StartsWith(file + ":1: "), HasSubstr("norm 1")));
  EXPECT_THAT(error_of(""), HasSubstr("T_body_lidar is missing"));
  EXPECT_THAT(error_of("lidar: [\n"), HasSubstr("no YAML"));
}

}  // namespace
}  // namespace tarmac::io
