#include "sim/truth/constant_twist.h"

#include <fmt/core.h>

namespace tarmac::sim::truth {

namespace {

using namespace core;

class ConstantTwist final : public SmoothTrajectory {
 public:
  ConstantTwist(const ConstantTwistOptions& options, Duration duration) : options_(options), duration_(duration) {
    twist_ << options.v_body_m_s, options.omega_body_rad_s;
  }

  Time begin() const override { return Time(); }
  Time end() const override { return Time(duration_); }

  Kinematics at(Time t) const override {
    if (!covers(t)) throw OutOfSpan(fmt::format("the motion covers 0 to {} s, not {} s", to_s(duration_), to_s(t)));
    Kinematics k;
    k.T_world_body = options_.start * se3::exp(to_s(t) * twist_);
    const Eigen::Matrix3d R = k.T_world_body.linear();
    k.v_world = R * options_.v_body_m_s;
    k.a_world = R * options_.omega_body_rad_s.cross(options_.v_body_m_s);
    k.omega_body = options_.omega_body_rad_s;
    return k;
  }

 private:
  ConstantTwistOptions options_;
  Duration duration_;
  Vector6 twist_;
};

}  // namespace

void ConstantTwistOptions::visit(OptionVisitor& v) {
  v("start", start, "T_world_body at t = 0");
  v("v_body_m_s", v_body_m_s, "velocity of the body's origin, in the body's frame");
  v("omega_body_rad_s", omega_body_rad_s, "angular rate, in the body's frame");
}

void StraightOptions::visit(OptionVisitor& v) {
  v("start", start, "T_world_body at t = 0");
  v("v_world_m_s", v_world_m_s, "velocity, in the world's frame; the attitude stays that of the start");
}

void StillOptions::visit(OptionVisitor& v) {
  v("start", start, "T_world_body at all times");
}

std::shared_ptr<const SmoothTrajectory> make_constant_twist(const ConstantTwistOptions& options, Duration duration) {
  return std::make_shared<ConstantTwist>(options, duration);
}

}  // namespace tarmac::sim::truth
