#include "sim/truth/drone.h"

#include <fmt/core.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "core/random.h"
#include "sim/truth/course.h"
#include "sim/truth/flight.h"
#include "sim/truth/series.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double g_m_s2 = 9.81;  ///< of the tilt; the IMU's own is in the rig

using Columns = std::array<std::array<Series<2>, 3>, 3>;  ///< [column][row]

std::array<Series<2>, 3> cross(const std::array<Series<2>, 3>& a, const std::array<Series<2>, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Series<2> length(const std::array<Series<2>, 3>& a) {
  return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

std::array<Series<2>, 3> unit(const std::array<Series<2>, 3>& a) {
  const Series<2> n = length(a);
  return {a[0] / n, a[1] / n, a[2] / n};
}

/// Upward axis along the thrust, forward axis as near to the heading as that leaves it.
Columns tilted(const std::array<Series<2>, 3>& thrust, const Series<2>& heading) {
  const auto direction = sin_cos(heading);
  const std::array<Series<2>, 3> up = unit(thrust), ahead{direction.cos, direction.sin, {}};
  const std::array<Series<2>, 3> left = unit(cross(up, ahead));
  return {cross(left, up), left, up};
}

/// Rz(yaw) Ry(pitch) Rx(roll).
Columns turned(const std::array<Series<2>, 3>& rpy) {
  const auto r = sin_cos(rpy[0]), p = sin_cos(rpy[1]), y = sin_cos(rpy[2]);
  return {{{y.cos * p.cos, y.sin * p.cos, -p.sin},
           {y.cos * p.sin * r.sin - y.sin * r.cos, y.sin * p.sin * r.sin + y.cos * r.cos, p.cos * r.sin},
           {y.cos * p.sin * r.cos + y.sin * r.sin, y.sin * p.sin * r.cos - y.cos * r.sin, p.cos * r.cos}}};
}

std::array<Series<2>, 3> rotated(const Columns& R, const std::array<Series<2>, 3>& v) {
  std::array<Series<2>, 3> result;
  for (std::size_t row = 0; row < 3; ++row) result[row] = R[0][row] * v[0] + R[1][row] * v[1] + R[2][row] * v[2];
  return result;
}

/// Gusts as they push, and how far the drone gives way: it holds its position by an oscillator, whose steady answer to
/// each of the gusts' sines is a sine again.
class Gusts {
 public:
  Gusts(const WindOptions& wind, const AirframeOptions& airframe, double air_speed_m_s, std::uint64_t seed) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const RandomStream random(seed, fmt::format("motion/gusts{}", axis));
      std::vector<Line> lines;
      double power = 0;
      for (int k = 0; k < count; ++k) {
        const double f = lowest_hz * std::pow(highest_hz / lowest_hz, (k + random.uniform(k, 0)) / count);
        const double w = two_pi * f, x = wind.gust_length_m * w / air_speed_m_s;
        // Dryden along the wind, 1 / (1 + x^2), times the width of the band, which grows with w.
        const double density = w / (1 + x * x);
        lines.push_back({w, std::sqrt(2 * density), two_pi * random.uniform(k, 1)});
        power += density;
      }
      const double rms = (axis == 2 ? 0.5 : 1) * wind.gust_m_s;
      for (Line& line : lines) add(axis, line, rms / std::sqrt(power), airframe);
    }
  }

  /// [m/s], world.
  std::array<Series<3>, 3> air(double t_s) const { return sum<3>(air_, t_s); }
  /// [m], world.
  std::array<Series<4>, 3> give(double t_s) const { return sum<4>(give_, t_s); }

 private:
  static constexpr int count = 14;
  static constexpr double lowest_hz = 0.02, highest_hz = 1.5;
  struct Line {
    double w, amplitude, phase;
  };

  void add(std::size_t axis, Line line, double scale, const AirframeOptions& airframe) {
    line.amplitude *= scale;
    air_[axis].push_back(line);
    const double hold = two_pi * airframe.hold_hz;
    const std::complex<double> answer =
        airframe.drag_per_s /
        std::complex<double>(hold * hold - line.w * line.w, 2 * airframe.hold_damping * hold * line.w);
    give_[axis].push_back({line.w, line.amplitude * std::abs(answer), line.phase + std::arg(answer)});
  }

  template <int N>
  static std::array<Series<N>, 3> sum(const std::array<std::vector<Line>, 3>& lines, double t_s) {
    std::array<Series<N>, 3> result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const Line& line : lines[axis]) {
        result[axis] += line.amplitude * sin_cos(Series<N>::line(line.w * t_s + line.phase, line.w)).sin;
      }
    }
    return result;
  }

  std::array<std::vector<Line>, 3> air_, give_;
};

/// The rotors' lines, four rotors at slightly different speeds, and the attitude's jitter; all sines of the time.
class Shaking {
 public:
  Shaking(const AirframeOptions& airframe, std::uint64_t seed) {
    constexpr double blade_share = 0.6;  // of the acceleration of the imbalance at one line a turn
    const double share = 1 / std::sqrt(4 * (1 + blade_share * blade_share));
    const RandomStream random(seed, "motion/rotors");
    for (int rotor = 0; rotor < 4; ++rotor) {
      const double hz = airframe.rotor_hz * (0.97 + 0.06 * random.uniform(rotor, 0));
      for (const int order : {1, airframe.blades}) {
        const double w = two_pi * hz * order, part = share * (order == 1 ? 1 : blade_share) * std::numbers::sqrt2;
        Line line{w, {}, {}};
        for (std::uint32_t axis = 0; axis < 6; ++axis) {
          line.amplitude[axis] =
              axis < 3 ? part * airframe.rotor_rms_m_s2 / (w * w) : part * radians(airframe.rotor_rms_deg_s) / w;
          line.phase[axis] = two_pi * random.uniform(rotor, 1 + axis + (order == 1 ? 0 : 6));
        }
        rotors_.push_back(line);
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      jitter_[axis] = Waves(radians(airframe.jitter_deg), 1 / 3.0, 2, 4,
                            RandomStream(seed, fmt::format("motion/jitter_attitude{}", axis)));
    }
  }

  /// Forward, left, up [m]; roll, pitch, yaw [rad]. `spinning` and `airborne` go from 0 to 1.
  std::array<Series<2>, 6> at(double t_s, const Series<2>& spinning, const Series<2>& airborne) const {
    std::array<Series<2>, 6> sum;
    for (const Line& line : rotors_) {
      for (std::size_t axis = 0; axis < 6; ++axis) {
        sum[axis] += line.amplitude[axis] * sin_cos(Series<2>::line(line.w * t_s + line.phase[axis], line.w)).sin;
      }
    }
    for (Series<2>& axis : sum) axis = spinning * axis;
    const Series<2> time = Series<2>::line(t_s, 1);
    for (std::size_t axis = 0; axis < 3; ++axis) sum[3 + axis] += airborne * wave_sum(jitter_[axis], time);
    return sum;
  }

 private:
  struct Line {
    double w;
    std::array<double, 6> amplitude, phase;
  };
  std::vector<Line> rotors_;
  std::array<Waves, 3> jitter_;
};

class Drone final : public SmoothTrajectory {
 public:
  Drone(const DroneOptions& options, CoursePlan plan, Duration duration, double ground_m, std::uint64_t seed)
      : options_(options),
        duration_(duration),
        plan_(options, std::move(plan), ground_m),
        gusts_(options.wind, options.airframe, std::max(3.0, options.wind.mean_m_s), seed),
        shaking_(options.airframe, seed) {}

  Time begin() const override { return Time(); }
  Time end() const override { return Time(duration_); }

  Kinematics at(Time t) const override {
    if (!covers(t)) throw OutOfSpan(fmt::format("the flight covers 0 to {} s, not {} s", to_s(duration_), to_s(t)));
    const double t_s = to_s(t);
    const Flight flight = flight_at(t_s);
    const Columns tilt = tilted(flight.thrust, flight.heading);
    const double spin_s = options_.take_off.spin_up_s;
    const Series<2> spinning = smooth_step(Series<2>::line((t_s - options_.rest_s) / spin_s + 1, 1 / spin_s));
    const std::array<Series<2>, 6> shake = shaking_.at(t_s, spinning, flight.airborne);
    const std::array<Series<2>, 3> shift = rotated(tilt, {shake[0], shake[1], shake[2]});
    const Columns small = turned({shake[3], shake[4], shake[5]});

    Kinematics k;
    Eigen::Matrix3d R, R1, R2;
    for (int column = 0; column < 3; ++column) {
      const std::array<Series<2>, 3> axis = rotated(tilt, small[static_cast<std::size_t>(column)]);
      for (int row = 0; row < 3; ++row) {
        const Series<2>& entry = axis[static_cast<std::size_t>(row)];
        R(row, column) = entry.value(), R1(row, column) = entry.d1(), R2(row, column) = entry.d2();
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const Series<2> p = flight.xyz_m[i] + shift[i];
      k.T_world_body.translation()[axis] = p.value();
      k.v_world[axis] = p.d1(), k.a_world[axis] = p.d2();
    }
    k.T_world_body.linear() = R;
    const Eigen::Matrix3d W = R.transpose() * R1, A = R1.transpose() * R1 + R.transpose() * R2;
    k.omega_body = Eigen::Vector3d(W(2, 1) - W(1, 2), W(0, 2) - W(2, 0), W(1, 0) - W(0, 1)) / 2;
    k.alpha_body = Eigen::Vector3d(A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1)) / 2;
    return k;
  }

  double tilt_deg(double t_s) const {
    const auto f = flight_at(t_s).thrust;
    return std::atan2(std::hypot(f[0].value(), f[1].value()), f[2].value()) * 180 / std::numbers::pi;
  }

 private:
  struct Flight {
    std::array<Series<2>, 3> xyz_m, thrust;
    Series<2> heading, airborne;
  };

  /// The thrust per mass is what the acceleration needs beside gravity, and what drag takes away.
  Flight flight_at(double t_s) const {
    const Planned planned = plan_.at(t_s);
    const std::array<Series<4>, 3> give = gusts_.give(t_s);
    const std::array<Series<3>, 3> gust = gusts_.air(t_s);
    const double from = radians(options_.wind.from_deg);
    const double wind[3] = {-options_.wind.mean_m_s * std::cos(from), -options_.wind.mean_m_s * std::sin(from), 0};
    Flight flight;
    flight.heading = planned.heading.truncated<2>();
    flight.airborne = planned.airborne.truncated<2>();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Series<4> p = planned.xyz_m[axis] + planned.airborne * give[axis];
      const Series<3> v = derivative(p);
      const Series<2> air = flight.airborne * (Series<2>::constant(wind[axis]) + gust[axis].truncated<2>());
      flight.xyz_m[axis] = p.truncated<2>();
      flight.thrust[axis] = derivative(v) + options_.airframe.drag_per_s * (v.truncated<2>() - air);
    }
    flight.thrust[2].c[0] += g_m_s2;
    return flight;
  }

  DroneOptions options_;
  Duration duration_;
  FlightPlan plan_;
  Gusts gusts_;
  Shaking shaking_;
};

}  // namespace

std::shared_ptr<const SmoothTrajectory> make_drone(const ConfigNode& node, Duration duration,
                                                   std::shared_ptr<const scenes::Ground> ground, std::uint64_t seed) {
  const DroneOptions options = read_drone_options(node);
  CourseOptions course = options;
  course.rest_s += FlightPlan::take_off_s(options.take_off);
  const double end_s = to_s(duration);
  CoursePlan plan = plan_course(node, course, end_s, 0, seed);
  const double ground_m = ground ? ground->height_m(options.start.x_m, options.start.y_m) : 0;
  auto drone = std::make_shared<Drone>(options, std::move(plan), duration, ground_m, seed);
  for (double t_s = 0; t_s <= end_s; t_s += 0.02) {
    if (const double tilt = drone->tilt_deg(t_s); tilt > options.airframe.max_tilt_deg) {
      node.fail_at("airframe",
                   fmt::format("at {:.2f} s the drone would tilt by {:.0f} deg, more than max_tilt_deg: fly "
                               "slower there, or wider turns, or accelerate less",
                               t_s, tilt));
    }
  }
  return drone;
}

}  // namespace tarmac::sim::truth
