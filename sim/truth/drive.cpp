#include "sim/truth/drive.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "scenes/paths/planar_path.h"
#include "scenes/paths/speed_profile.h"
#include "sim/truth/drive_options.h"
#include "sim/truth/road.h"
#include "sim/truth/suspension.h"
#include "sim/truth/vibration.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;
using Eigen::Vector3d;

/// The rear axle over ground, with derivatives by time.
struct Planar {
  Jet s, x_m, y_m, heading;
  SinCos direction;  ///< of heading
};

/// Everything about the drive that needs no suspension.
class Course {
 public:
  Course(PlanarPath path, SpeedProfile speed) : path_(std::move(path)), speed_(std::move(speed)) {}

  Planar at(double t_s) const {
    Planar p;
    p.s = speed_.at(t_s);
    const PlanarPath::Point point = path_.at(p.s.f);
    p.heading = chain(point.heading, p.s);
    p.direction = sin_cos(p.heading);
    // The rear axle does not slip: it moves where the vehicle points.
    const Jet v = derivative(p.s), vx = v * p.direction.cos, vy = v * p.direction.sin;
    p.x_m = {point.x_m, vx.f, vx.d1, vx.d2};
    p.y_m = {point.y_m, vy.f, vy.d1, vy.d2};
    return p;
  }

 private:
  PlanarPath path_;
  SpeedProfile speed_;
};

/// Height of the ground under a point that moves, with two derivatives by time.
Jet height_along(const scenes::Ground& ground, const Jet& x, const Jet& y) {
  Eigen::Vector2d g;
  Eigen::Vector3d H;
  const double z = ground.height_m(x.f, y.f, &g, &H);
  return {z, g.x() * x.d1 + g.y() * y.d1,
          g.x() * x.d2 + g.y() * y.d2 + H[0] * x.d1 * x.d1 + 2 * H[1] * x.d1 * y.d1 + H[2] * y.d1 * y.d1, 0};
}

/// What drives the suspension: where the wheels would put the body, and how far accelerations tilt it.
class Excitation {
 public:
  Excitation(const SuspensionOptions& vehicle, Road road, std::shared_ptr<const scenes::Ground> ground)
      : vehicle_(vehicle), road_(std::move(road)), ground_(std::move(ground)) {
    oscillators_ = {{{vehicle.heave_hz, vehicle.heave_damping},
                     {vehicle.pitch_hz, vehicle.pitch_damping},
                     {vehicle.roll_hz, vehicle.roll_damping}}};
  }

  const std::array<Suspension::Oscillator, 3>& oscillators() const { return oscillators_; }

  struct Input {
    std::array<Jet, 3> wheels;  ///< per mode, with two derivatives by time
    std::array<Jet, 3> load;    ///< steady answer to accelerations, with one derivative
  };
  Input at(const Planar& p) const {
    Input input;
    const std::array<Jet, 3> road = road_.at(p.s.f);
    for (int m = 0; m < 3; ++m) input.wheels[m] = chain(road[m], p.s);
    if (ground_) add_ground(p, input.wheels);
    const Jet v = derivative(p.s), a_forward = derivative(v), a_left = v * derivative(p.heading);
    input.load[pitch] = -radians(vehicle_.dive_deg_per_m_s2) * a_forward;
    input.load[roll] = radians(vehicle_.lean_deg_per_m_s2) * a_left;
    return input;
  }

  /// F of the suspension: w^2 (wheels + load) + 2 zeta w d(wheels)/dt: spring and damper stand on the wheels.
  std::array<Jet, 3> forcing(const Planar& p) const {
    const Input input = at(p);
    std::array<Jet, 3> F;
    for (int m = 0; m < 3; ++m) {
      const double w = 2 * std::numbers::pi * oscillators_[m].frequency_hz, d = 2 * oscillators_[m].damping * w;
      F[m] = w * w * (input.wheels[m] + input.load[m]) + d * derivative(input.wheels[m]);
    }
    return F;
  }

 private:
  void add_ground(const Planar& p, std::array<Jet, 3>& wheels) const {
    const auto under = [&](double ahead, double left) {
      const Jet &c = p.direction.cos, &s = p.direction.sin;
      return height_along(*ground_, p.x_m + ahead * c - left * s, p.y_m + ahead * s + left * c);
    };
    const double L = vehicle_.wheelbase_m, half = vehicle_.track_m / 2;
    const Jet front_left = under(L, half), front_right = under(L, -half), rear_left = under(0, half),
              rear_right = under(0, -half);
    const Jet front = 0.5 * (front_left + front_right), rear = 0.5 * (rear_left + rear_right);
    wheels[heave] = wheels[heave] + 0.5 * (front + rear);
    wheels[pitch] = wheels[pitch] + (1 / L) * (rear - front);
    wheels[roll] = wheels[roll] + (1 / (4 * half)) * (front_left - front_right + rear_left - rear_right);
  }

  SuspensionOptions vehicle_;
  Road road_;
  std::shared_ptr<const scenes::Ground> ground_;
  std::array<Suspension::Oscillator, 3> oscillators_;
};

Suspension solve_suspension(const Course& course, const Excitation& excitation, double end_s) {
  const Excitation::Input begin = excitation.at(course.at(0));
  std::array<double, 3> q, q_dot;
  for (int m = 0; m < 3; ++m) {
    q[m] = begin.wheels[m].f + begin.load[m].f;
    q_dot[m] = begin.wheels[m].d1 + begin.load[m].d1;
  }
  // At rest nothing changes, and a drive has seconds of it: the last answer is kept while the vehicle stands.
  std::optional<std::pair<double, std::array<Jet, 3>>> standing;
  const auto forcing = [&](double t_s) {
    const Planar p = course.at(t_s);
    const bool stands = p.s.d1 == 0 && p.s.d2 == 0 && p.s.d3 == 0;
    if (stands && standing && standing->first == p.s.f) return standing->second;
    const std::array<Jet, 3> F = excitation.forcing(p);
    if (stands) standing = {p.s.f, F};
    return F;
  };
  return Suspension(excitation.oscillators(), forcing, end_s, q, q_dot);
}

/// R = Rz(yaw) Ry(pitch) Rx(roll), with its body rates.
struct Attitude {
  Eigen::Matrix3d R_world_body;
  Vector3d omega_body, alpha_body;

  Attitude(const Jet& yaw, const Jet& pitch_angle, const Jet& roll_angle) {
    const SinCos y = sin_cos(yaw), p = sin_cos(pitch_angle), r = sin_cos(roll_angle);
    const double cy = y.cos.f, sy = y.sin.f, cp = p.cos.f, sp = p.sin.f, cr = r.cos.f, sr = r.sin.f;
    R_world_body << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,              //
        -sp, cp * sr, cp * cr;
    const Jet dy = derivative(yaw), dp = derivative(pitch_angle), dr = derivative(roll_angle);
    const Jet wx = dr - dy * p.sin, wy = dp * r.cos + dy * p.cos * r.sin, wz = dy * p.cos * r.cos - dp * r.sin;
    omega_body = {wx.f, wy.f, wz.f};
    alpha_body = {wx.d1, wy.d1, wz.d1};
  }
};

class Drive final : public SmoothTrajectory {
 public:
  Drive(const DriveOptions& options, Course course, Duration duration, std::shared_ptr<const scenes::Ground> ground,
        std::uint64_t seed)
      : duration_(duration),
        course_(std::move(course)),
        vehicle_(options.suspension),
        vibration_(options.vibration, seed),
        suspension_(solve_suspension(
            course_, Excitation(vehicle_, Road(options.road, vehicle_.wheelbase_m, vehicle_.track_m, seed), ground),
            to_s(duration))) {}

  Time begin() const override { return Time(); }
  Time end() const override { return Time(duration_); }

  Kinematics at(Time t) const override {
    if (!covers(t)) throw OutOfSpan(fmt::format("the drive covers 0 to {} s, not {} s", to_s(duration_), to_s(t)));
    const double t_s = to_s(t);
    const Planar p = course_.at(t_s);
    const std::array<Jet, 3> q = suspension_.at(t_s);
    const Vibration::Shake shake = vibration_.at(t_s, p.s);
    const Attitude attitude(p.heading + shake.rpy_rad[2], q[pitch] + shake.rpy_rad[1], q[roll] + shake.rpy_rad[0]);

    // Centre of pitch and roll, between the axles; the body turns about it.
    const Vector3d centre_body(vehicle_.wheelbase_m / 2, 0, vehicle_.centre_height_m);
    const Jet ahead = Jet{centre_body.x()} + shake.xyz_m[0], left = shake.xyz_m[1];
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

 private:
  Duration duration_;
  Course course_;
  SuspensionOptions vehicle_;
  Vibration vibration_;
  Suspension suspension_;
};

void check_waves(const ConfigNode& node, const char* group, double shortest, double longest) {
  if (shortest <= longest) return;
  node.child(group).fail_at("max_wavelength_m",
                            fmt::format("{} is below min_wavelength_m, which is {}", longest, shortest));
}

/// Fails at the item of a list, or at the list when the item is not in the file.
[[noreturn]] void fail_at_item(const ConfigNode& node, const char* list, std::size_t index,
                               const std::string& message) {
  const std::vector<ConfigNode> items = node.child(list).items();
  if (index < items.size()) items[index].fail(message);
  node.fail_at(list, message);
}

Course make_course(const ConfigNode& node, const DriveOptions& options, double end_s, std::uint64_t seed) {
  if (options.path.empty()) {
    node.fail_at("path", "a drive needs at least one piece, such as {straight_m: 100} or {turn_deg: 90, radius_m: 8}");
  }
  check_waves(node, "jitter", options.jitter.min_wavelength_m, options.jitter.max_wavelength_m);
  check_waves(node, "wander", options.wander.min_wavelength_m, options.wander.max_wavelength_m);
  const WanderOptions& w = options.wander;
  const JitterOptions& j = options.jitter;
  const Waves wander(w.lateral_rms_m, w.min_wavelength_m, w.max_wavelength_m, 3, RandomStream(seed, "motion/wander"));
  const Waves ripple(j.speed_fraction_rms, j.min_wavelength_m, j.max_wavelength_m, 4,
                     RandomStream(seed, "motion/jitter"));
  std::vector<PlanarPath::Problem> path_problems;
  PlanarPath path(options.start, options.path, wander, path_problems);
  for (const auto& problem : path_problems) fail_at_item(node, "path", problem.piece, problem.message);
  std::vector<SpeedProfile::Problem> speed_problems;
  SpeedProfile speed(options.speed_plan(), path.length_m(), ripple.integral(), speed_problems);
  for (const auto& problem : speed_problems) {
    if (problem.event == options.speed.size()) {
      node.fail_at("stop_peak_m_s2", "the stop at the end of the path: " + problem.message);
    }
    fail_at_item(node, "speed", problem.event, problem.message);
  }
  // The suspension's last interval ends up to two nodes after the motion does.
  path.tabulate(speed.at(end_s + 2 * Suspension::node_spacing_s).f);
  return Course(std::move(path), std::move(speed));
}

}  // namespace

std::shared_ptr<const SmoothTrajectory> make_drive(const ConfigNode& node, Duration duration,
                                                   std::shared_ptr<const scenes::Ground> ground, std::uint64_t seed) {
  DriveOptions options;
  node.read(options, {"kind"});
  Course course = make_course(node, options, to_s(duration), seed);
  return std::make_shared<Drive>(options, std::move(course), duration, std::move(ground), seed);
}

}  // namespace tarmac::sim::truth
