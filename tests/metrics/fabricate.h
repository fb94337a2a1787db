/// Truths in closed form, and drives along them held in memory: sweeps whose every column sees the same points of the
/// world, so that what a control does to them can be written down.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "core/estimate.h"
#include "metrics/evaluate.h"
#include "sim/truth/ground_truth.h"

namespace tarmac::metrics::tests {

/// T(t) = T0 Exp(xi t), xi = (velocity, rate) in the body's frame. Zero rate: a straight line.
class ConstantTwist final : public core::SmoothTrajectory {
 public:
  ConstantTwist(const core::SE3& T0, const core::Vector6& xi, core::Time begin, core::Time end)
      : T0_(T0), xi_(xi), begin_(begin), end_(end) {}
  core::Time begin() const override { return begin_; }
  core::Time end() const override { return end_; }
  core::Kinematics at(core::Time t) const override;

 private:
  core::SE3 T0_;
  core::Vector6 xi_;
  core::Time begin_, end_;
};

/// Sums of sinusoids in position, yaw, pitch and roll: no estimator's class of functions.
class Wobbly final : public core::SmoothTrajectory {
 public:
  Wobbly(core::Time begin, core::Time end) : begin_(begin), end_(end) {}
  core::Time begin() const override { return begin_; }
  core::Time end() const override { return end_; }
  core::Kinematics at(core::Time t) const override;

 private:
  core::Time begin_, end_;
};

struct DriveShape {
  int sweeps = 40;
  int columns = 32;
  core::Duration period{100'000'000};
  core::Duration column_spacing{3'000'000};
  core::Time first_begin = core::time_from_ns(2'000'000'000);
  core::Time begin(int k) const { return first_begin + k * period; }
  core::Time end(int k) const { return begin(k) + (columns - 1) * column_spacing; }
  core::Time column(int k, int c) const { return begin(k) + c * column_spacing; }
};

/// A point of the world that every column of a sweep sees.
struct Target {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  bool moving = false;
};

struct Drive {
  DriveShape shape;
  sim::truth::GroundTruth truth;
  core::Rig nominal;
  std::vector<core::LidarSweep> sweeps;
  std::vector<sim::truth::PointLabels> labels;

  SweepSource source() const;
  Evaluation evaluate(const core::Estimate& estimate, const EvaluateSettings& settings = {}) const;
};

/// Where the LiDAR sits: turned and off the body's origin.
core::SE3 lidar_mount();

/// Points are measured without noise from the true pose at their column's time.
Drive make_drive(std::shared_ptr<const core::SmoothTrajectory> motion, const DriveShape& shape,
                 const std::function<std::vector<Target>(int sweep)>& targets);

/// The eight corners of a box around `centre`: uncorrelated coordinates.
std::vector<Target> box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_extent);

/// The same estimate in another map frame: T_other_map from the left on every pose.
core::Estimate in_other_map(const core::Estimate& estimate, const core::SE3& T_other_map);

/// A rigid motion from a translation and a rotation vector.
core::SE3 pose(const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& rotation_vector);

}  // namespace tarmac::metrics::tests
