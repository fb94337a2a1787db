#include "sim/truth/flight.h"

#include <algorithm>
#include <utility>

#include "scenes/paths/smooth_step.h"

namespace tarmac::sim::truth {

namespace {

/// What SpeedProfile::planned() leaves out: the fourth derivative of the planned distance by time.
double fourth_derivative(const SpeedProfile& speed, double t_s) {
  const auto& ramps = speed.ramps();
  const auto after = std::upper_bound(ramps.begin(), ramps.end(), t_s,
                                      [](double t, const SpeedProfile::Ramp& r) { return t < r.t_s; });
  const SpeedProfile::Ramp& ramp = after == ramps.begin() ? *after : *std::prev(after);
  const double since_s = t_s - ramp.t_s, dv = ramp.change_m_s, T = ramp.duration_s, tau = ramp.onset_s;
  if (dv == 0 || since_s <= 0 || since_s >= T) return 0;
  if (tau == 0) return dv / (T * T * T) * scenes::smooth_step(since_s / T).d3;
  const double a = dv / (T - tau);
  return a / (tau * tau) *
         (scenes::smooth_step(since_s / tau).d2 - scenes::smooth_step((since_s - (T - tau)) / tau).d2);
}

Series<3> along(const Jet& by_distance, const Series<4>& s) {
  return compose(series_of(by_distance), s.truncated<3>());
}

}  // namespace

double FlightPlan::take_off_s(const TakeOffOptions& options) {
  return scenes::smooth_step_peak_slope * options.height_m / options.climb_m_s;
}

FlightPlan::FlightPlan(const DroneOptions& options, CoursePlan course, double ground_m)
    : options_(options),
      course_(std::move(course)),
      ground_m_(ground_m),
      lift_off_s_(options.rest_s),
      ripple_at_start_m_(course_.ripple.value(0)) {}

Series<4> FlightPlan::distance(double t_s) const {
  const Series<3> known = series_of(course_.speed.planned(t_s));
  Series<4> S;
  std::copy(known.c.begin(), known.c.end(), S.c.begin());
  S.c[4] = fourth_derivative(course_.speed, t_s) / 24;
  Series<4> s = S + wave_sum(course_.ripple, S);
  s.c[0] -= ripple_at_start_m_;
  return s;
}

Planned FlightPlan::at(double t_s) const {
  const Series<4> s = distance(t_s);
  const PlanarPath::Point point = course_.path.at(s.value());
  Planned planned;
  planned.heading = along(point.heading, s);
  const auto direction = sin_cos(planned.heading);
  const Series<3> v = derivative(s);
  planned.xyz_m[0] = integral(v * direction.cos, point.x_m);
  planned.xyz_m[1] = integral(v * direction.sin, point.y_m);
  const double T = take_off_s(options_.take_off);
  planned.airborne = smooth_step(Series<4>::line((t_s - lift_off_s_) / T, 1 / T));
  Series<4> z =
      Series<4>::constant(ground_m_ + options_.take_off.legs_m) + options_.take_off.height_m * planned.airborne;
  for (const ClimbOptions& climb : options_.climbs) {
    Series<4> u = (1 / climb.over_m) * s;
    u.c[0] -= climb.at_m / climb.over_m;
    z += climb.by_m * smooth_step(u);
  }
  planned.xyz_m[2] = z;
  return planned;
}

}  // namespace tarmac::sim::truth
