#include "sim/truth/recorded.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "sim/truth/motion.h"
#include "tests/sim/truth/stand_turn.h"
#include "tests/support/numeric.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::sim::truth {
namespace {

using namespace core;
using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

/// A smooth motion of no class of the interpolation's, sampled at uneven times about `mean_step_s` apart.
Vector3d place(double t) {
  return {5 * std::sin(0.4 * t), 3 * std::cos(0.3 * t) + 0.5 * t, 0.2 * std::sin(0.9 * t)};
}
Eigen::Quaterniond facing(double t) {
  return Eigen::Quaterniond(so3::exp(Vector3d(0.1 * std::sin(t), 0.2 * std::cos(0.7 * t), 0.8 * std::sin(0.5 * t))));
}
std::string sampled(double mean_step_s, double length_s) {
  std::string text;
  double t = 0;
  for (int k = 0; t <= length_s; ++k) {
    const Vector3d p = place(t);
    const Eigen::Quaterniond q = facing(t);
    char line[300];
    std::snprintf(line, sizeof line, "%.9f %.15g %.15g %.15g %.15g %.15g %.15g %.15g\n", t, p.x(), p.y(), p.z(), q.x(),
                  q.y(), q.z(), q.w());
    text += line;
    t += mean_step_s * (1 + 0.3 * std::sin(2.4 * k));
    t = std::round(t * 1e9) * 1e-9;
  }
  return text;
}

struct Errors {
  double position_m = 0, angle_rad = 0;
};
Errors errors_of(double mean_step_s) {
  const PathInterpolation path(parse_path(sampled(mean_step_s, 20), "test.tum"));
  Errors worst;
  for (double t = 4; t < 16; t += 0.01234) {
    const SE3 T = path.at(t).T_world_body;
    worst.position_m = std::max(worst.position_m, (T.translation() - place(t)).norm());
    worst.angle_rad = std::max(worst.angle_rad, so3::angle_rad(T.linear().transpose() * facing(t).toRotationMatrix()));
  }
  return worst;
}

TEST(Recorded, InterpolatesWithAtLeastOrderSeven) {
  const Errors coarse = errors_of(0.8), fine = errors_of(0.4);
  std::printf("order: position %.2f, attitude %.2f (errors %.1e m, %.1e rad at 0.4 s)\n",
              std::log2(coarse.position_m / fine.position_m), std::log2(coarse.angle_rad / fine.angle_rad),
              fine.position_m, fine.angle_rad);
  EXPECT_GT(std::log2(coarse.position_m / fine.position_m), 6.9);
  EXPECT_GT(std::log2(coarse.angle_rad / fine.angle_rad), 6.9);
  EXPECT_LT(fine.position_m, 1e-5);
}

TEST(Recorded, PassesThroughEveryPoseInWhateverFrame) {
  const std::string text = sampled(0.5, 12);
  const std::vector<RecordedPose> poses = parse_path(text, "test.tum");
  const PathInterpolation path(poses);
  for (const RecordedPose& pose : poses) {
    const SE3 T = path.at(to_s(pose.t - poses.front().t)).T_world_body;
    EXPECT_LT((T.translation() - pose.xyz_m).norm(), 1e-12);
    EXPECT_NEAR(std::abs(Eigen::Quaterniond(T.linear()).coeffs().dot(pose.quat_xyzw)), 1, 1e-14);
  }
  // Turned and moved as a whole, it is the same path turned and moved.
  const SE3 moved = se3::from_xyz_quat({4, -7, 2}, Eigen::Vector4d(0.5, -0.1, 0.7, 0.5).normalized());
  std::vector<RecordedPose> elsewhere = poses;
  for (RecordedPose& pose : elsewhere) {
    const SE3 T = moved * se3::from_xyz_quat(pose.xyz_m, pose.quat_xyzw);
    pose.xyz_m = T.translation();
    pose.quat_xyzw = se3::quat_xyzw(T);  // with signs of its own
  }
  const PathInterpolation other(elsewhere);
  for (double t = 0; t < 11.5; t += 0.077) {
    EXPECT_LT(tests::pose_difference(other.at(t).T_world_body, moved * path.at(t).T_world_body), 1e-12) << t;
  }
}

TEST(Recorded, RestsThenFollowsThePathAtItsOwnPace) {
  const tests::TemporaryFolder folder;
  std::ofstream(folder.path() / "way.csv") << "t,x,y,z,qx,qy,qz,qw\n# comment\n"
                                           << [] {
                                                std::string text = sampled(0.4, 20);
                                                for (char& c : text) c = c == ' ' ? ',' : c;
                                                return text;
                                              }();
  std::ofstream(folder.path() / "scenario.yaml")
      << "motion:\n  kind: recorded\n  file: way.csv\n  rest_s: 3\n  ease_s: 2\n";
  const auto node = ConfigNode::load((folder.path() / "scenario.yaml").string()).child("motion");
  const auto motion = make_motion(node, duration_from_s(20), nullptr, 1);
  EXPECT_EQ(motion->pose(time_from_s(2.9)).matrix(), motion->pose(Time()).matrix());
  EXPECT_LT((motion->pose(time_from_s(14)).translation() - place(14 - 3 - 1)).norm(), 1e-4);
  // The resolved block needs no file.
  const std::string resolved = resolve_motion(node);
  std::filesystem::remove(folder.path() / "way.csv");
  const auto again = make_motion(ConfigNode::parse("motion:\n" + resolved, "resolved").child("motion"),
                                 duration_from_s(20), nullptr, 1);
  EXPECT_EQ(again->pose(time_from_s(13.7)).matrix(), motion->pose(time_from_s(13.7)).matrix());
}

TEST(Recorded, NanosecondsOfTodaysTimeAreKept) {
  const auto poses = parse_path("1763800000.123456789 0 0 0 0 0 0 1\n1763800000.123456790 0 0 0 0 0 0 1\n", "a.tum");
  EXPECT_EQ((poses[1].t - poses[0].t).count(), 1);
}

/// Twelve good lines, of which one is replaced.
std::string error_of(int line, const std::string& content, const std::string& options = "", double duration_s = 5) {
  const tests::TemporaryFolder folder;
  {
    std::ofstream file(folder.path() / "way.tum");
    for (int k = 1; k <= 12; ++k) {
      if (k == line) {
        if (!content.empty()) file << content << "\n";
      } else {
        file << k * 0.5 << " " << k * 1.0 << " 0 0 0 0 0 1\n";
      }
    }
  }
  std::ofstream(folder.path() / "scenario.yaml") << "motion:\n  kind: recorded\n  file: way.tum\n" << options;
  try {
    make_motion(ConfigNode::load((folder.path() / "scenario.yaml").string()).child("motion"),
                duration_from_s(duration_s), nullptr, 1);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Recorded, EveryMistakeOfAFileIsAnErrorWithItsLine) {
  EXPECT_EQ(error_of(0, ""), "no error");
  EXPECT_THAT(error_of(5, "2.5 nan 0 0 0 0 0 1"), AllOf(HasSubstr("way.tum:5"), HasSubstr("x: 'nan'")));
  EXPECT_THAT(error_of(5, "2.5 5 0 0 0 0 0"), AllOf(HasSubstr("way.tum:5"), HasSubstr("7 columns")));
  EXPECT_THAT(error_of(5, "2.5 5 0 0 0 0 0 0"), AllOf(HasSubstr("way.tum:5"), HasSubstr("quaternion")));
  EXPECT_THAT(error_of(5, "2.0 5 0 0 0 0 0 1"),
              AllOf(HasSubstr("way.tum:5"), HasSubstr("not later than that of line 4")));
  EXPECT_THAT(error_of(5, "2500000000 5 0 0 0 0 0 1"), AllOf(HasSubstr("way.tum:6"), HasSubstr("not later")));
  EXPECT_THAT(error_of(5, "1763800000123456789 5 0 0 0 0 0 1"),
              AllOf(HasSubstr("way.tum:5"), HasSubstr("too large for seconds")));
  EXPECT_THAT(error_of(5, "2.5 45 0 0 0 0 0 1"), AllOf(HasSubstr("way.tum:5"), HasSubstr("jump"), HasSubstr("line 4")));
  EXPECT_THAT(error_of(5, "2.5 5 9 0 0 0 0 1"), AllOf(HasSubstr("way.tum:"), HasSubstr("m/s^2"), HasSubstr("jump")));
  EXPECT_THAT(error_of(5, "2.5 5 0 0 0 0 1 0", "  max_rate_deg_s: 300\n"),
              AllOf(HasSubstr("way.tum:5"), HasSubstr("180.0 deg")));
  EXPECT_THAT(error_of(5, "", "  max_gap_s: 0.9\n"), AllOf(HasSubstr("way.tum:5"), HasSubstr("gap")));
  EXPECT_THAT(error_of(0, "", "", 6),
              AllOf(HasSubstr("way.tum:12"), HasSubstr("the path ends here"), HasSubstr("5.500")));
  EXPECT_THAT(error_of(0, "", "  rest_s: 2\n"), AllOf(HasSubstr("scenario.yaml"), HasSubstr("ease_s")));
  EXPECT_THAT(error_of(0, "", "  poses: ['0 0 0 0 0 0 0 1']\n"),
              AllOf(HasSubstr("scenario.yaml:3"), HasSubstr("not both")));
}

TEST(Recorded, AMissingFileAndTooFewPosesAreErrors) {
  const auto error = [](const std::string& yaml) -> std::string {
    try {
      make_motion(ConfigNode::parse(yaml, "test.yaml"), duration_from_s(1), nullptr, 1);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(error("{kind: recorded, file: /nowhere/way.tum}"),
              AllOf(HasSubstr("test.yaml:1"), HasSubstr("/nowhere/way.tum")));
  EXPECT_THAT(error("{kind: recorded, poses: ['0 0 0 0 0 0 0 1', '1 0 0 0 0 0 0 1']}"),
              AllOf(HasSubstr("test.yaml: motion.poses"), HasSubstr("at least 8")));
  EXPECT_THAT(error("{kind: recorded}"), HasSubstr("give either file"));
}

}  // namespace
}  // namespace tarmac::sim::truth
