/// Motions with a closed form, for controls of the testbench rather than for judging estimators: their function class
/// is one that estimators do use.
#pragma once

#include <memory>

#include "core/options.h"
#include "core/trajectory.h"

namespace tarmac::sim::truth {

/// T(t) = T(0) Exp(t (v, omega)).
struct ConstantTwistOptions {
  core::SE3 start = core::SE3::Identity();
  Eigen::Vector3d v_body_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_body_rad_s = Eigen::Vector3d::Zero();
  void visit(core::OptionVisitor& v);
};

struct StraightOptions {
  core::SE3 start = core::SE3::Identity();
  Eigen::Vector3d v_world_m_s = Eigen::Vector3d(5, 0, 0);
  void visit(core::OptionVisitor& v);
};

struct StillOptions {
  core::SE3 start = core::SE3::Identity();
  void visit(core::OptionVisitor& v);
};

std::shared_ptr<const core::SmoothTrajectory> make_constant_twist(const ConstantTwistOptions& options,
                                                                  core::Duration duration);

}  // namespace tarmac::sim::truth
