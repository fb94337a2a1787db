#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "io/sensor/tum.h"
#include "tests/io/fabricate.h"
#include "tests/support/numeric.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::io {
namespace {

using core::InputError;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tests::message_of;
using tests::put;
using tests::TemporaryFolder;

/// Poses with a wall-clock stamp whose nanoseconds a double cannot hold, one before time zero, and any rotation.
std::vector<StampedPose> example() {
  const core::RandomStream stream(1, "test/poses");
  std::vector<StampedPose> poses;
  for (const std::int64_t t_ns : std::initializer_list<std::int64_t>{
           -1'000'000'001, -5, 0, 7, 1'700'000'000'123'456'789, 1'700'000'000'123'456'790}) {
    core::Vector6 xi;
    for (std::uint32_t k = 0; k < 6; ++k) xi[k] = 2 * stream.normal(poses.size(), k);
    poses.push_back({core::time_from_ns(t_ns), core::se3::exp(xi)});
  }
  return poses;
}

void expect_same(const std::vector<StampedPose>& a, const std::vector<StampedPose>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(core::to_ns(a[i].t), core::to_ns(b[i].t)) << i;
    EXPECT_LT(tests::pose_difference(a[i].T, b[i].T), tolerance) << i;
  }
}

TEST(Tum, RoundTripsWithEveryNanosecond) {
  const TemporaryFolder folder;
  write_tum(folder / "a.tum", example(), "T_map_body");
  expect_same(read_tum(folder / "a.tum"), example(), 1e-11);
  EXPECT_THAT(core::read_file(folder / "a.tum"),
              AllOf(StartsWith("# T_map_body\n"), HasSubstr("\n1700000000.123456789 "), HasSubstr("\n-0.000000005 ")));
}

TEST(Tum, ReadsWhatOtherProgramsWrite) {
  const TemporaryFolder folder;
  put(folder / "a.tum",
      "# comment\r\n"
      "\n"
      "1.305031910e+09 1 2 3 0 0 0 1\r\n"
      "  1305031911.5\t1 2 3 0 0 0.70711 0.70711  # rounded\n"
      "1305031912 +1 -2e-3 .5 0 0 0 -1");
  const std::vector<StampedPose> poses = read_tum(folder / "a.tum");
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(core::to_ns(poses[0].t), 1305031910'000000000);
  EXPECT_EQ(core::to_ns(poses[1].t), 1305031911'500000000);
  EXPECT_EQ(core::to_ns(poses[2].t), 1305031912'000000000);
  EXPECT_EQ(poses[2].T.translation(), Eigen::Vector3d(1, -0.002, 0.5));
  EXPECT_EQ(poses[2].T.linear(), Eigen::Matrix3d::Identity());
}

TEST(Tum, SecondsAreReadFromTheirDecimalsAndRoundedToTheNanosecond) {
  const TemporaryFolder folder;
  put(folder / "a.tum",
      "-0.0000000006 0 0 0 0 0 0 1\n"
      "0.0000000004 0 0 0 0 0 0 1\n"
      "1e-9 0 0 0 0 0 0 1\n"
      "0.0000000025 0 0 0 0 0 0 1\n"
      "1700000000.1234567891234 0 0 0 0 0 0 1\n");
  std::vector<std::int64_t> t_ns;
  for (const StampedPose& p : read_tum(folder / "a.tum")) t_ns.push_back(core::to_ns(p.t));
  EXPECT_THAT(t_ns, ::testing::ElementsAre(-1, 0, 1, 3, 1700000000'123456789));
}

TEST(Kitti, RoundTripsPosesAndTakesTimesFromPeriodOrFile) {
  const TemporaryFolder folder;
  write_kitti_poses(folder / "poses.txt", example());
  const std::vector<StampedPose> by_period = read_kitti_poses(folder / "poses.txt", {}, core::Duration(50));
  ASSERT_EQ(by_period.size(), example().size());
  for (std::size_t k = 0; k < by_period.size(); ++k) {
    EXPECT_EQ(core::to_ns(by_period[k].t), 50 * static_cast<std::int64_t>(k));
    EXPECT_LT(tests::pose_difference(by_period[k].T, example()[k].T), 1e-13);
  }
  put(folder / "times.txt", "0.5\n1\n1.25\n2\n3\n4.000000001\n");
  const std::vector<StampedPose> by_file =
      read_kitti_poses(folder / "poses.txt", folder / "times.txt", core::Duration(50));
  EXPECT_EQ(core::to_ns(by_file.front().t), 500'000'000);
  EXPECT_EQ(core::to_ns(by_file.back().t), 4'000'000'001);
}

TEST(Euroc, RoundTripsAndIgnoresFurtherColumns) {
  const TemporaryFolder folder;
  write_euroc(folder / "a.csv", example());
  expect_same(read_euroc(folder / "a.csv"), example(), 1e-11);
  put(folder / "b.csv", "#timestamp,...\n5, 1, 2, 3, 0, 0, 0, 1, 9, 9, 9\n");
  const std::vector<StampedPose> poses = read_euroc(folder / "b.csv");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_LT((poses[0].T * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 2, 3)).norm(), 1e-15)
      << "qw comes first: this is half a turn about z";
}

TEST(AnyTrajectory, IsKnownByItsContent) {
  const TemporaryFolder folder;
  write_tum(folder / "a", example());
  write_euroc(folder / "b", example());
  write_kitti_poses(folder / "c", example());
  expect_same(read_trajectory(folder / "a"), example(), 1e-11);
  expect_same(read_trajectory(folder / "b"), example(), 1e-11);
  EXPECT_EQ(core::to_ns(read_trajectory(folder / "c")[1].t), kitti_period.count());
  put(folder / "times.txt", "1\n2\n3\n4\n5\n6\n");
  EXPECT_EQ(core::to_ns(read_trajectory(folder / "c")[1].t), 2'000'000'000) << "times.txt beside it";
  put(folder / "d", "# only remarks\n1 2 3\n");
  EXPECT_THAT(message_of<InputError>([&] { read_trajectory(folder / "d"); }),
              AllOf(StartsWith((folder / "d").string() + ":2: 3 fields"), HasSubstr("TUM"), HasSubstr("KITTI"),
                    HasSubstr("EuRoC")));
}

struct BadText {
  const char* what;
  const char* text;
  const char* where;
  const char* expected;
};
void PrintTo(const BadText& bad, std::ostream* out) {
  *out << bad.what;
}

class MalformedTum : public ::testing::TestWithParam<BadText> {};

TEST_P(MalformedTum, IsAnErrorWithFileLineAndWhatWasExpected) {
  const TemporaryFolder folder;
  put(folder / "bad.tum", GetParam().text);
  EXPECT_THAT(message_of<InputError>([&] { read_tum(folder / "bad.tum"); }),
              AllOf(StartsWith((folder / "bad.tum").string() + GetParam().where), HasSubstr(GetParam().expected)))
      << GetParam().what;
}

INSTANTIATE_TEST_SUITE_P(
    , MalformedTum,
    ::testing::Values(
        BadText{"too few fields", "# c\n0 0 0 0 0 0 0 1\n1 0 0 0 0 0 1\n", ":3: 7 fields", "expected 8"},
        BadText{"too many fields", "0 0 0 0 0 0 0 1 5\n", ":1: 9 fields", "expected 8"},
        BadText{"no number", "0 0 zero 0 0 0 0 1\n", ":1: field 3 (y) is 'zero'", "finite number"},
        BadText{"nan", "0 0 0 nan 0 0 0 1\n", ":1: field 4 (z) is 'nan'", "finite number"},
        BadText{"infinity", "0 0 0 1e999 0 0 0 1\n", ":1: field 4 (z)", "finite number"},
        BadText{"number with a tail", "0 1m 0 0 0 0 0 1\n", ":1: field 2 (x) is '1m'", "finite number"},
        BadText{"time is none", "12:30 0 0 0 0 0 0 1\n", ":1: field 1 (t) is '12:30'", "seconds"},
        BadText{"time in nanoseconds", "1700000000123456789 0 0 0 0 0 0 1\n", ":1: field 1 (t)", "below 9.2e9"},
        BadText{"time nan", "nan 0 0 0 0 0 0 1\n", ":1: field 1 (t)", "seconds"},
        BadText{"time just a point", ". 0 0 0 0 0 0 1\n", ":1: field 1 (t)", "seconds"},
        BadText{"quaternion too long", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 1 1\n", ":2: quaternion has norm 1.41421",
                "expected 1"},
        BadText{"quaternion zero", "0 0 0 0 0 0 0 0\n", ":1: quaternion has norm 0", "expected 1"},
        BadText{"same time twice", "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ":2: time 1.000000000", "ascending"},
        BadText{"time goes back", "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", ":2: time 1.000000000", "ascending"},
        BadText{"no pose", "# nothing\n\n", ": holds no pose", "expected"},
        BadText{"empty file", "", ": holds no pose", "expected"}));

TEST(MalformedKitti, IsAnErrorWithFileLineAndWhatWasExpected) {
  const TemporaryFolder folder;
  const std::string good = "1 0 0 5 0 1 0 6 0 0 1 7\n";
  const auto error = [&](const std::string& poses, const char* times) {
    put(folder / "poses.txt", poses);
    if (times) put(folder / "times.txt", times);
    return message_of<InputError>([&] {
      read_kitti_poses(folder / "poses.txt", times ? folder / "times.txt" : std::filesystem::path(), kitti_period);
    });
  };
  const std::string poses = (folder / "poses.txt").string(), times = (folder / "times.txt").string();
  EXPECT_THAT(error(good + "1 0 0\n", nullptr), AllOf(StartsWith(poses + ":2: 3 fields"), HasSubstr("expected 12")));
  EXPECT_THAT(error("2 0 0 5 0 1 0 6 0 0 1 7\n", nullptr), AllOf(StartsWith(poses + ":1: "), HasSubstr("no rotation")));
  EXPECT_THAT(error("1 0 0 5 0 1 0 6 0 0 -1 7\n", nullptr), HasSubstr("determinant -1"));
  EXPECT_THAT(error("1 0 0 5 0 1 0 6 0 0 1 x\n", nullptr), HasSubstr("field 12"));
  EXPECT_THAT(error("", nullptr), HasSubstr("holds no pose"));
  EXPECT_THAT(error(good + good, "1\n"), AllOf(StartsWith(poses + ":2: "), HasSubstr("more poses than the 1 times")));
  EXPECT_THAT(error(good, "1\n2\n"), AllOf(StartsWith(times), HasSubstr("2 times"), HasSubstr("1 poses")));
  EXPECT_THAT(error(good + good, "2\n1\n"), HasSubstr("ascending"));
  EXPECT_THAT(error(good, "one\n"), StartsWith(times + ":1: field 1 (time) is 'one'"));
}

TEST(MalformedEuroc, IsAnErrorWithFileLineAndWhatWasExpected) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    put(folder / "a.csv", text);
    return message_of<InputError>([&] { read_euroc(folder / "a.csv"); });
  };
  const std::string file = (folder / "a.csv").string();
  EXPECT_THAT(error("#h\n1,0,0,0,1,0,0\n"), AllOf(StartsWith(file + ":2: 7 fields"), HasSubstr("at least 8")));
  EXPECT_THAT(error("1.5,0,0,0,1,0,0,0\n"),
              AllOf(StartsWith(file + ":1: field 1 (t_ns) is '1.5'"), HasSubstr("integer")));
  EXPECT_THAT(error("1,0,,0,1,0,0,0\n"), StartsWith(file + ":1: field 3 (y) is ''"));
  EXPECT_THAT(error("1,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n"), HasSubstr("ascending"));
  EXPECT_THAT(error("1,0,0,0,0.5,0,0,0\n"), HasSubstr("norm 0.5"));
}

TEST(Trajectories, FilesThatAreNotThereAreNamed) {
  for (auto* read : {&read_tum, &read_euroc, &read_trajectory}) {
    EXPECT_THAT(message_of<InputError>([&] { (*read)("/nowhere/a.tum"); }), HasSubstr("/nowhere/a.tum"));
  }
  EXPECT_THROW(write_tum("/nowhere/a.tum", example()), InputError);
}

}  // namespace
}  // namespace tarmac::io
