#include "sim/truth/excitation.h"

#include <numbers>
#include <utility>

namespace tarmac::sim::truth {

namespace {

/// Height of the ground under a point that moves, with two derivatives by time.
Jet height_along(const scenes::Ground& ground, const Jet& x, const Jet& y) {
  Eigen::Vector2d g;
  Eigen::Vector3d H;
  const double z = ground.height_m(x.f, y.f, &g, &H);
  return {z, g.x() * x.d1 + g.y() * y.d1,
          g.x() * x.d2 + g.y() * y.d2 + H[0] * x.d1 * x.d1 + 2 * H[1] * x.d1 * y.d1 + H[2] * y.d1 * y.d1, 0};
}

}  // namespace

Excitation::Excitation(const SuspensionOptions& vehicle, Road road, std::shared_ptr<const scenes::Ground> ground)
    : vehicle_(vehicle), road_(std::move(road)), ground_(std::move(ground)) {
  oscillators_ = {{{vehicle.heave_hz, vehicle.heave_damping},
                   {vehicle.pitch_hz, vehicle.pitch_damping},
                   {vehicle.roll_hz, vehicle.roll_damping}}};
}

Excitation::Input Excitation::at(const Planar& p) const {
  Input input;
  const std::array<Jet, 3> road = road_.at(p.s.f);
  for (int m = 0; m < 3; ++m) input.wheels[m] = chain(road[m], p.s);
  if (ground_) add_ground(p, input.wheels);
  const Jet a_forward = derivative(p.v_m_s), a_left = p.v_m_s * derivative(p.heading);
  input.load[pitch] = -radians(vehicle_.dive_deg_per_m_s2) * a_forward;
  input.load[roll] = radians(vehicle_.lean_deg_per_m_s2) * a_left;
  return input;
}

std::array<Jet, 3> Excitation::forcing(const Planar& p) const {
  const Input input = at(p);
  std::array<Jet, 3> F;
  for (int m = 0; m < 3; ++m) {
    const double w = 2 * std::numbers::pi * oscillators_[m].frequency_hz, d = 2 * oscillators_[m].damping * w;
    F[m] = w * w * (input.wheels[m] + input.load[m]) + d * derivative(input.wheels[m]);
  }
  return F;
}

void Excitation::add_ground(const Planar& p, std::array<Jet, 3>& wheels) const {
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

Suspension solve_suspension(std::shared_ptr<const Course> course, std::shared_ptr<const Excitation> excitation,
                            double end_s, const Suspension::Visitor& visit) {
  const Excitation::Input begin = excitation->at(course->at(0));
  std::array<double, 3> q, q_dot;
  for (int m = 0; m < 3; ++m) {
    q[m] = begin.wheels[m].f + begin.load[m].f;
    q_dot[m] = begin.wheels[m].d1 + begin.load[m].d1;
  }
  const std::array<Suspension::Oscillator, 3> oscillators = excitation->oscillators();
  const auto forcing = [course = std::move(course), excitation = std::move(excitation)](double t_s) {
    return excitation->forcing(course->at(t_s));
  };
  return Suspension(oscillators, forcing, end_s, q, q_dot, visit);
}

Suspension solve_surge(std::shared_ptr<const Course> course, const Suspension::Oscillator& surge, double end_s) {
  const double w = 2 * std::numbers::pi * surge.frequency_hz;
  const auto forcing = [course = std::move(course)](double t_s) {
    return std::array<Jet, 3>{-derivative(course->at(t_s).v_m_s), Jet{}, Jet{}};
  };
  const Jet F = forcing(0)[0];
  return Suspension({surge, surge, surge}, forcing, end_s, {F.f / (w * w), 0, 0}, {F.d1 / (w * w), 0, 0});
}

}  // namespace tarmac::sim::truth
