#include "core/trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "core/error.h"
#include "core/random.h"
#include "tests/support/numeric.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using tests::message_of;
using tests::pose_difference;

Time at_ns(std::int64_t t_ns) {
  return time_from_ns(t_ns);
}

Eigen::Vector3d direction(const RandomStream& stream, std::uint64_t i) {
  return Eigen::Vector3d(stream.normal(i, 0), stream.normal(i, 1), stream.normal(i, 2)).normalized();
}

SE3 pose_of(const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& phi_rad = Eigen::Vector3d::Zero()) {
  SE3 T = SE3::Identity();
  T.linear() = so3::exp(phi_rad);
  T.translation() = xyz_m;
  return T;
}

/// A pose anywhere, and a second one turned against it by that angle.
std::pair<SE3, SE3> pose_pair(const RandomStream& stream, std::uint64_t i, double angle_rad) {
  const SE3 T0 = pose_of(10 * direction(stream, 4 * i), 1.3 * direction(stream, 4 * i + 1));
  const SE3 T1 = T0 * pose_of(direction(stream, 4 * i + 2), angle_rad * direction(stream, 4 * i + 3));
  return {T0, T1};
}

struct ModelCase {
  SegmentModel model;
  const char* name;
};
void PrintTo(const ModelCase& model, std::ostream* out) {
  *out << model.name;
}

class EveryModel : public ::testing::TestWithParam<ModelCase> {
 protected:
  /// A segment of the model over [1000, 1400] ns through T0 and T1; sampled ones have a third pose between.
  static Segment make(SegmentModel model, const SE3& T0, const SE3& T1) {
    const Time t0 = at_ns(1000), t1 = at_ns(1400);
    switch (model) {
      case SegmentModel::held:
        return Segment::hold(t0, t1, T0);
      case SegmentModel::two_pose_slerp:
      case SegmentModel::two_pose_screw:
        return Segment::two_pose(model, t0, T0, t1, T1);
      default:
        return Segment::sampled(model, {t0, at_ns(1100), t1}, {T0, T1, T0});
    }
  }
};

TEST_P(EveryModel, JacobianMatchesCentralDifferencesAlsoAtEdgeAngles) {
  const RandomStream stream(1, "test/segment_jacobian");
  std::uint64_t i = 0;
  for (const double angle_rad : {0.0, 1e-9, 1e-4, 0.199, 0.201, 0.5, 1.5, 3.0}) {
    const auto [T0, T1] = pose_pair(stream, i++, angle_rad);
    const Segment segment = make(GetParam().model, T0, T1);
    for (const std::int64_t t_ns : {1000, 1001, 1030, 1099, 1100, 1250, 1399, 1400}) {
      std::vector<BlockJacobian> jacobians;
      const SE3 T = segment.pose(at_ns(t_ns), jacobians);
      EXPECT_EQ(pose_difference(T, segment.pose(at_ns(t_ns))), 0);
      for (int block = 0; block < static_cast<int>(segment.poses.size()); ++block) {
        const auto with_block = [&](const SE3& T_block) {
          Segment moved = segment;
          moved.poses[static_cast<std::size_t>(block)] = T_block;
          return moved.pose(at_ns(t_ns));
        };
        // A block that is not listed does not matter: its derivative is zero.
        Matrix6 J = Matrix6::Zero();
        for (const BlockJacobian& entry : jacobians) {
          if (entry.block == block) J = entry.jacobian;
        }
        const Matrix6 numeric =
            tests::numeric_pose_jacobian(with_block, segment.poses[static_cast<std::size_t>(block)], 1e-5);
        EXPECT_LT(tests::relative_difference(J, numeric), 1e-6)
            << GetParam().name << " angle_rad " << angle_rad << " t_ns " << t_ns << " block " << block;
      }
    }
  }
}

TEST_P(EveryModel, PassesThroughItsPosesAndRefusesTimesOutside) {
  const RandomStream stream(2, "test/segment_ends");
  const auto [T0, T1] = pose_pair(stream, 0, 0.7);
  const Segment segment = make(GetParam().model, T0, T1);
  EXPECT_LT(pose_difference(segment.pose(at_ns(1000)), T0), 1e-14);
  EXPECT_LT(pose_difference(segment.pose(at_ns(1400)), segment.poses.back()), 1e-14);
  EXPECT_THROW(segment.pose(at_ns(999)), OutOfSpan);
  EXPECT_THROW(segment.pose(at_ns(1401)), OutOfSpan);
  std::vector<BlockJacobian> jacobians;
  EXPECT_THROW(segment.pose(at_ns(1401), jacobians), OutOfSpan);
}

TEST_P(EveryModel, MovingTheWorldMovesThePosesAlike) {
  const RandomStream stream(3, "test/segment_world");
  const auto [T0, T1] = pose_pair(stream, 0, 1.1);
  const SE3 T_other_world = pose_of({100, -50, 7}, {0.3, -1, 2});
  const Segment here = make(GetParam().model, T0, T1);
  const Segment there = make(GetParam().model, T_other_world * T0, T_other_world * T1);
  for (const std::int64_t t_ns : {1000, 1042, 1100, 1333, 1400}) {
    EXPECT_LT(pose_difference(there.pose(at_ns(t_ns)), T_other_world * here.pose(at_ns(t_ns))), 1e-12) << t_ns;
  }
}

INSTANTIATE_TEST_SUITE_P(Segment, EveryModel,
                         ::testing::Values(ModelCase{SegmentModel::two_pose_slerp, "two_pose_slerp"},
                                           ModelCase{SegmentModel::two_pose_screw, "two_pose_screw"},
                                           ModelCase{SegmentModel::held, "held"},
                                           ModelCase{SegmentModel::sampled_screw, "sampled_screw"},
                                           ModelCase{SegmentModel::sampled_slerp, "sampled_slerp"},
                                           ModelCase{SegmentModel::sampled_hold, "sampled_hold"}),
                         [](const auto& each) { return each.param.name; });

TEST(TwoPoseScrew, HasAConstantTwist) {
  const RandomStream stream(4, "test/screw");
  const auto [T0, T1] = pose_pair(stream, 0, 0.9);
  const Segment segment = Segment::two_pose(SegmentModel::two_pose_screw, at_ns(0), T0, at_ns(1000), T1);
  const Vector6 tenth = se3::log(segment.pose(at_ns(0)).inverse() * segment.pose(at_ns(100)));
  for (int k = 1; k < 10; ++k) {
    const Vector6 step = se3::log(segment.pose(at_ns(100 * k)).inverse() * segment.pose(at_ns(100 * (k + 1))));
    EXPECT_LT((step - tenth).norm(), 1e-13) << k;
  }
}

TEST(TwoPoseSlerp, TranslatesOnAStraightLineAndTurnsAtAConstantRate) {
  const RandomStream stream(5, "test/slerp");
  const auto [T0, T1] = pose_pair(stream, 0, 2.0);
  const Segment segment = Segment::two_pose(SegmentModel::two_pose_slerp, at_ns(0), T0, at_ns(1000), T1);
  for (int k = 0; k <= 10; ++k) {
    const double s = k / 10.0;
    const SE3 T = segment.pose(at_ns(100 * k));
    EXPECT_LT((T.translation() - ((1 - s) * T0.translation() + s * T1.translation())).norm(), 1e-14);
    const Eigen::Quaterniond q = Eigen::Quaterniond(T0.linear()).slerp(s, Eigen::Quaterniond(T1.linear()));
    EXPECT_LT(so3::angle_rad(T.linear().transpose() * q.toRotationMatrix()), 1e-14);
  }
}

TEST(TwoPose, FormsAgreeWithoutRotationAndDifferByTheSagittaWithIt) {
  const SE3 T0 = SE3::Identity();
  const SE3 straight = pose_of({2, 1, 0}, {0, 0, 0}), turned = pose_of({2, 0, 0}, {0, 0, 0.4});
  const auto middle = [&](SegmentModel model, const SE3& T1) {
    return Segment::two_pose(model, at_ns(0), T0, at_ns(2), T1).pose(at_ns(1));
  };
  EXPECT_LT(
      pose_difference(middle(SegmentModel::two_pose_slerp, straight), middle(SegmentModel::two_pose_screw, straight)),
      1e-15);
  // Chord 2 under an angle of 0.4: radius 1/sin(0.2), sagitta radius (1 - cos 0.2).
  const double sagitta_m = (1 - std::cos(0.2)) / std::sin(0.2);
  EXPECT_NEAR((middle(SegmentModel::two_pose_slerp, turned).translation() -
               middle(SegmentModel::two_pose_screw, turned).translation())
                  .norm(),
              sagitta_m, 1e-14);
}

TEST(TwoPose, AnEmptySpanHoldsItsFirstPose) {
  const SE3 T0 = pose_of({1, 0, 0}, {0, 0, 0}), T1 = pose_of({2, 0, 0}, {0, 0, 0});
  const Segment segment = Segment::two_pose(SegmentModel::two_pose_screw, at_ns(5), T0, at_ns(5), T1);
  EXPECT_LT(pose_difference(segment.pose(at_ns(5)), T0), 1e-15);
}

TEST(Sampled, HoldKeepsAPoseUntilTheNext) {
  const SE3 A = pose_of({1, 0, 0}), B = pose_of({2, 0, 0}), C = pose_of({3, 0, 0});
  const Segment segment = Segment::sampled(SegmentModel::sampled_hold, {at_ns(0), at_ns(10), at_ns(20)}, {A, B, C});
  EXPECT_EQ(segment.pose(at_ns(9)).translation().x(), 1);
  EXPECT_EQ(segment.pose(at_ns(10)).translation().x(), 2);
  EXPECT_EQ(segment.pose(at_ns(19)).translation().x(), 2);
  EXPECT_EQ(segment.pose(at_ns(20)).translation().x(), 3);
}

TEST(Sampled, ASingleSampleAnswersAtItsInstantOnly) {
  const Segment segment = Segment::sampled(SegmentModel::sampled_screw, {at_ns(7)}, {pose_of({1, 2, 3})});
  EXPECT_EQ(segment.pose(at_ns(7)).translation().z(), 3);
  EXPECT_THROW(segment.pose(at_ns(8)), OutOfSpan);
}

TEST(Segment, RefusesWhatItsModelCannotBe) {
  const SE3 I = SE3::Identity();
  const Time a = at_ns(0), b = at_ns(10);
  EXPECT_THROW(Segment::two_pose(SegmentModel::held, a, I, b, I), std::invalid_argument);
  EXPECT_THROW(Segment::sampled(SegmentModel::two_pose_screw, {a, b}, {I, I}), std::invalid_argument);
  EXPECT_THROW(Segment::two_pose(SegmentModel::two_pose_screw, b, I, a, I), InputError);
  EXPECT_THROW(Segment::hold(b, a, I), InputError);
  EXPECT_THROW(Segment::sampled(SegmentModel::sampled_screw, {}, {}), InputError);
  EXPECT_THROW(Segment::sampled(SegmentModel::sampled_screw, {a, b}, {I}), InputError);
  EXPECT_THROW(Segment::sampled(SegmentModel::sampled_screw, {a, a}, {I, I}), InputError);
  EXPECT_THAT(message_of<InputError>([&] {
                Segment::sampled(SegmentModel::sampled_hold, {b, a}, {I, I});
              }),
              ::testing::HasSubstr("sample 1"));
}

Segment held_at_x(std::int64_t begin_ns, std::int64_t end_ns, double x_m) {
  return Segment::hold(at_ns(begin_ns), at_ns(end_ns), pose_of({x_m, 0, 0}));
}

TEST(PiecewiseTrajectory, ABoundaryInstantBelongsToTheLaterSegment) {
  const PiecewiseTrajectory trajectory({held_at_x(0, 10, 1), held_at_x(10, 20, 2), held_at_x(20, 30, 3)});
  EXPECT_EQ(trajectory.pose(at_ns(9)).translation().x(), 1);
  EXPECT_EQ(trajectory.pose(at_ns(10)).translation().x(), 2);
  EXPECT_EQ(trajectory.pose(at_ns(20)).translation().x(), 3);
  EXPECT_EQ(trajectory.pose(at_ns(30)).translation().x(), 3) << "the last end has no later segment";
}

TEST(PiecewiseTrajectory, GapsAndOutsideAreNeverExtrapolated) {
  const PiecewiseTrajectory trajectory({held_at_x(0, 10, 1), held_at_x(15, 20, 2)});
  EXPECT_TRUE(trajectory.covers(at_ns(10)));
  EXPECT_TRUE(trajectory.covers(at_ns(15)));
  for (const std::int64_t t_ns : {-1, 11, 14, 21}) {
    EXPECT_FALSE(trajectory.covers(at_ns(t_ns))) << t_ns;
    EXPECT_EQ(trajectory.find(at_ns(t_ns)), nullptr) << t_ns;
    EXPECT_THROW(trajectory.pose(at_ns(t_ns)), OutOfSpan) << t_ns;
  }
  EXPECT_THAT(message_of<OutOfSpan>([&] { trajectory.pose(at_ns(12)); }), ::testing::HasSubstr("12 ns"));
}

TEST(PiecewiseTrajectory, FindsTheSegmentThatHolds) {
  const PiecewiseTrajectory trajectory({held_at_x(0, 10, 1), held_at_x(10, 10, 5), held_at_x(10, 20, 2)});
  EXPECT_EQ(trajectory.find(at_ns(4)), &trajectory.segments()[0]);
  EXPECT_EQ(trajectory.find(at_ns(10)), &trajectory.segments()[2]) << "also past one of no length";
  EXPECT_EQ(to_ns(trajectory.begin()), 0);
  EXPECT_EQ(to_ns(trajectory.end()), 20);
}

TEST(PiecewiseTrajectory, RefusesOverlapAndDisorder) {
  PiecewiseTrajectory trajectory({held_at_x(0, 10, 1)});
  EXPECT_THROW(trajectory.append(held_at_x(9, 20, 2)), InputError);
  EXPECT_THROW(trajectory.append(held_at_x(-20, -10, 2)), InputError);
  EXPECT_EQ(trajectory.segments().size(), 1u) << "a refused segment leaves no trace";
  EXPECT_NO_THROW(trajectory.append(held_at_x(10, 20, 2)));
  EXPECT_THROW(PiecewiseTrajectory({held_at_x(0, 10, 1), held_at_x(5, 20, 1)}), InputError);
}

TEST(PiecewiseTrajectory, AnEmptyOneSaysSo) {
  const PiecewiseTrajectory trajectory;
  EXPECT_TRUE(trajectory.empty());
  EXPECT_FALSE(trajectory.covers(at_ns(0)));
  EXPECT_THROW(trajectory.begin(), OutOfSpan);
  EXPECT_THROW(trajectory.end(), OutOfSpan);
  EXPECT_THROW(trajectory.pose(at_ns(0)), OutOfSpan);
}

}  // namespace
}  // namespace tarmac::core
