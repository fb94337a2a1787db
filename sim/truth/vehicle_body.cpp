#include "sim/truth/vehicle_body.h"

#include <fmt/core.h>

#include <optional>
#include <utility>

#include "sim/truth/attitude.h"
#include "sim/truth/excitation.h"
#include "sim/truth/road.h"
#include "sim/truth/suspension.h"
#include "sim/truth/vibration.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;
using Eigen::Vector3d;

constexpr double free_fall_m_s2 = 9.81;

/// The wheel over which the body falls fastest, and when. Falling freely, its tyre carries nothing.
struct Fall {
  double a_m_s2 = 0, t_s = 0;
};

class VehicleBody final : public SmoothTrajectory {
 public:
  VehicleBody(const BodyOptions& options, std::unique_ptr<const Course> course, Duration duration,
              std::shared_ptr<const scenes::Ground> ground, std::uint64_t seed)
      : duration_(duration),
        course_(std::move(course)),
        vehicle_(options.suspension),
        vibration_(options.vibration, seed),
        suspension_(solve_suspension(
            course_,
            std::make_shared<const Excitation>(
                vehicle_, Road(options.road, vehicle_.wheelbase_m, vehicle_.track_m, seed, options.bumps),
                std::move(ground)),
            to_s(duration), [this](double t_s, const std::array<Jet, 3>& q) { watch_fall(t_s, q); })) {
    if (vehicle_.surge_hz > 0) {
      surge_ = solve_surge(course_, {vehicle_.surge_hz, vehicle_.surge_damping}, to_s(duration));
    }
  }

  Time begin() const override { return Time(); }
  Time end() const override { return Time(duration_); }

  Kinematics at(Time t) const override {
    if (!covers(t)) throw OutOfSpan(fmt::format("the drive covers 0 to {} s, not {} s", to_s(duration_), to_s(t)));
    const double t_s = to_s(t);
    const Planar p = course_->at(t_s);
    const std::array<Jet, 3> q = suspension_.at(t_s);
    const Vibration::Shake shake = vibration_.at(t_s, p.s);
    const Attitude attitude(p.heading + shake.rpy_rad[2], q[pitch] + shake.rpy_rad[1], q[roll] + shake.rpy_rad[0]);

    // Centre of pitch and roll, between the axles; the body turns about it.
    const Vector3d centre_body(vehicle_.wheelbase_m / 2, 0, vehicle_.centre_height_m);
    Jet ahead = Jet{centre_body.x()} + shake.xyz_m[0];
    if (surge_) ahead = ahead + surge_->at(t_s)[0];
    const Jet& left = shake.xyz_m[1];
    const Jet &c = p.direction.cos, &s = p.direction.sin;
    const Jet centre[3] = {p.x_m + ahead * c - left * s, p.y_m + ahead * s + left * c,
                           Jet{centre_body.z()} + q[heave] + shake.xyz_m[2]};

    const Eigen::Matrix3d& R = attitude.R_world_body;
    const Vector3d &omega = attitude.omega_body, &alpha = attitude.alpha_body, arm = -centre_body;
    Kinematics k;
    k.T_world_body.linear() = R;
    k.T_world_body.translation() = Vector3d(centre[0].f, centre[1].f, centre[2].f) + R * arm;
    k.v_world = Vector3d(centre[0].d1, centre[1].d1, centre[2].d1) + R * omega.cross(arm);
    k.a_world =
        Vector3d(centre[0].d2, centre[1].d2, centre[2].d2) + R * (alpha.cross(arm) + omega.cross(omega.cross(arm)));
    k.omega_body = omega;
    k.alpha_body = alpha;
    return k;
  }

  const Fall& hardest_fall() const { return hardest_fall_; }
  double distance_m(double t_s) const { return course_->at(t_s).s.f; }

 private:
  void watch_fall(double t_s, const std::array<Jet, 3>& q) {
    const double ahead = vehicle_.wheelbase_m / 2, left = vehicle_.track_m / 2;
    const double a = q[heave].d2 - ahead * std::abs(q[pitch].d2) - left * std::abs(q[roll].d2);
    if (a < hardest_fall_.a_m_s2) hardest_fall_ = {a, t_s};
  }

  Duration duration_;
  std::shared_ptr<const Course> course_;
  SuspensionOptions vehicle_;
  Vibration vibration_;
  Fall hardest_fall_;  // before the suspension, whose solution it watches
  Suspension suspension_;
  std::optional<Suspension> surge_;
};

}  // namespace

std::shared_ptr<const SmoothTrajectory> make_vehicle_body(const ConfigNode& node, std::unique_ptr<const Course> course,
                                                          const BodyOptions& options, Duration duration,
                                                          std::shared_ptr<const scenes::Ground> ground,
                                                          std::uint64_t seed) {
  auto body = std::make_shared<VehicleBody>(options, std::move(course), duration, std::move(ground), seed);
  const Fall fall = body->hardest_fall();
  if (fall.a_m_s2 < -free_fall_m_s2) {
    node.fail_at(options.bumps.empty() ? "road" : "bumps",
                 fmt::format("over one wheel the body would fall at {:.1f} m/s^2 at {:.2f} s, {:.1f} m along the path: "
                             "wheels leave the ground there, which this suspension does not model; drive slower, or "
                             "make the road smoother or the bump lower",
                             -fall.a_m_s2, fall.t_s, body->distance_m(fall.t_s)));
  }
  return body;
}

}  // namespace tarmac::sim::truth
