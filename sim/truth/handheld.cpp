#include "sim/truth/handheld.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/paths/smooth_step.h"
#include "sim/truth/attitude.h"
#include "sim/truth/course.h"
#include "sim/truth/gait.h"
#include "sim/truth/handheld_options.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;

/// Yaw of the looks around at a time: to the left in a quarter of the period, to the right in half of it, and back.
Jet looking(const std::vector<LookOptions>& looks, double t_s) {
  Jet yaw;
  for (const LookOptions& look : looks) {
    const double quarter_s = look.period_s / 4;
    const auto turn = [&](double deg, double from_s, double duration_s) {
      const Jet u{(t_s - from_s) / duration_s, 1 / duration_s, 0, 0};
      yaw = yaw + radians(deg) * chain(scenes::smooth_step(u.f), u);
    };
    turn(look.left_deg, look.at_s, quarter_s);
    turn(-look.left_deg - look.right_deg, look.at_s + quarter_s, 2 * quarter_s);
    turn(look.right_deg, look.at_s + 3 * quarter_s, quarter_s);
  }
  return yaw;
}

class Handheld final : public SmoothTrajectory {
 public:
  Handheld(const HandheldOptions& options, CoursePlan plan, Duration duration,
           std::shared_ptr<const scenes::Ground> ground, std::uint64_t seed)
      : options_(options),
        plan_(std::move(plan)),
        duration_(duration),
        ground_(std::move(ground)),
        phase_(options.gait, seed),
        gait_(options.gait, seed),
        strikes_(options.gait, seed),
        unrest_(options.hold, seed) {
    add_strikes();
  }

  Time begin() const override { return Time(); }
  Time end() const override { return Time(duration_); }

  Kinematics at(Time t) const override {
    if (!covers(t)) throw OutOfSpan(fmt::format("the walk covers 0 to {} s, not {} s", to_s(duration_), to_s(t)));
    const double t_s = to_s(t);
    const Planar p = axle_at(plan_, t_s);
    const Swing swing = swing_at(p, t_s);
    const HoldOptions& hold = options_.hold;

    const Jet facing = p.heading + looking(options_.looks, t_s);
    const SinCos direction = sin_cos(facing);
    const Jet ahead = Jet{hold.ahead_m} + swing[0];
    const Jet x = p.x_m + ahead * direction.cos - swing[1] * direction.sin;
    const Jet y = p.y_m + ahead * direction.sin + swing[1] * direction.cos;
    const Jet z = ground_height(p) + Jet{hold.height_m} + swing[2];

    const Attitude attitude(facing + swing[5], Jet{radians(hold.tilt_deg)} + swing[4], swing[3]);
    Kinematics k;
    k.T_world_body.linear() = attitude.R_world_body;
    k.T_world_body.translation() << x.f, y.f, z.f;
    k.v_world << x.d1, y.d1, z.d1;
    k.a_world << x.d2, y.d2, z.d2;
    k.omega_body = attitude.omega_body;
    k.alpha_body = attitude.alpha_body;
    return k;
  }

 private:
  Swing swing_at(const Planar& p, double t_s) const {
    const Jet share = gait_.share(p.v_m_s);
    const Swing gait = gait_.at(phase_.at(p.s), share), unrest = unrest_.at(t_s, share), strikes = strikes_.at(t_s);
    Swing sum;
    for (std::size_t axis = 0; axis < 6; ++axis) sum[axis] = gait[axis] + unrest[axis] + strikes[axis];
    return sum;
  }

  /// Of the ground under the person, with two derivatives by time.
  Jet ground_height(const Planar& p) const {
    if (!ground_) return {};
    Eigen::Vector2d g;
    Eigen::Vector3d H;
    const double z = ground_->height_m(p.x_m.f, p.y_m.f, &g, &H);
    return {z, g.x() * p.x_m.d1 + g.y() * p.y_m.d1,
            g.x() * p.x_m.d2 + g.y() * p.y_m.d2 + H[0] * p.x_m.d1 * p.x_m.d1 + 2 * H[1] * p.x_m.d1 * p.y_m.d1 +
                H[2] * p.y_m.d1 * p.y_m.d1,
            0};
  }

  double phase_at(double t_s) const { return phase_.at(plan_.speed.at(t_s)).f; }

  /// A heel strikes whenever the phase of the steps passes a whole number.
  void add_strikes() {
    constexpr double step_s = 0.01;
    double before = phase_at(0);
    const double end_s = to_s(duration_);
    for (double t_s = step_s; t_s < end_s + step_s; t_s += step_s) {
      const double now = phase_at(t_s);
      if (std::floor(now) > std::floor(before)) {
        double low = t_s - step_s, high = t_s;
        for (int k = 0; k < 60; ++k) {
          const double middle = (low + high) / 2;
          (phase_at(middle) < std::floor(now) ? low : high) = middle;
        }
        strikes_.add(high, gait_.share(derivative(plan_.speed.at(high))).f);
      }
      before = now;
    }
  }

  HandheldOptions options_;
  CoursePlan plan_;
  Duration duration_;
  std::shared_ptr<const scenes::Ground> ground_;
  StepPhase phase_;
  Gait gait_;
  Strikes strikes_;
  Unrest unrest_;
};

}  // namespace

std::shared_ptr<const SmoothTrajectory> make_handheld(const ConfigNode& node, Duration duration,
                                                      std::shared_ptr<const scenes::Ground> ground,
                                                      std::uint64_t seed) {
  const HandheldOptions options = read_handheld_options(node);
  CoursePlan plan = plan_course(node, options, to_s(duration), 0.02, seed);
  return std::make_shared<Handheld>(options, std::move(plan), duration, std::move(ground), seed);
}

}  // namespace tarmac::sim::truth
