#include "scenes/paths/speed_profile.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scenes/paths/smooth_step.h"

namespace tarmac::scenes {

SpeedProfile::SpeedProfile(const SpeedPlan& plan, double path_length_m, Waves ripple, std::vector<Problem>& problems)
    : ripple_(std::move(ripple)) {
  ripple_at_start_m_ = ripple_.value(0);
  ramps_.push_back({0, 0, plan.start_m_s, 0, plan.rest_s});
  for (std::size_t i = 0; i < plan.events.size(); ++i) add(plan.events[i], i, problems);
  if (plan.stop_peak_m_s2 > 0 && ramps_.back().end_m_s() > 0) {
    add({.to_m_s = 0, .peak_m_s2 = plan.stop_peak_m_s2, .by_m = path_length_m}, plan.events.size(), problems);
  }
}

void SpeedProfile::add(const SpeedEvent& event, std::size_t index, std::vector<Problem>& problems) {
  const Ramp& last = ramps_.back();
  const double now_s = last.end_s(), here_m = last.end_m(), v_m_s = last.end_m_s();
  const auto refuse = [&](std::string message) { problems.push_back({index, std::move(message)}); };
  if ((event.at_s >= 0) + (event.at_m >= 0) + (event.by_m >= 0) > 1) {
    return refuse("at_s, at_m and by_m exclude each other: give one of them");
  }
  if (event.wait_s > 0 && (event.at_s >= 0 || event.at_m >= 0 || event.by_m >= 0))
    return refuse("wait_s has no effect beside at_s, at_m or by_m: give one of them");
  if (event.abs_m_s2 == 0 && event.abs_hz != SpeedEvent{}.abs_hz)
    return refuse("abs_hz has no effect without abs_m_s2: give both or none");
  Ramp ramp{now_s + event.wait_s, 0, v_m_s, event.to_m_s - v_m_s, 0};
  ramp.duration_s = smooth_step_peak_slope * std::abs(ramp.change_m_s) / event.peak_m_s2;
  ramp.onset_s = event.onset_s, ramp.abs_m_s2 = event.abs_m_s2, ramp.abs_hz = event.abs_hz;
  if (event.onset_s > 0) {
    const double at_peak_s = std::abs(ramp.change_m_s) / event.peak_m_s2;
    if (event.onset_s > at_peak_s) {
      return refuse(
          fmt::format("onset_s: {} s is longer than the change takes at its peak ({:.3f} s): shorten it, or "
                      "lower peak_m_s2",
                      event.onset_s, at_peak_s));
    }
    ramp.duration_s = at_peak_s + event.onset_s;
  }
  if (event.at_s >= 0) {
    ramp.t_s = event.at_s;
    if (ramp.t_s < now_s) {
      return refuse(fmt::format("at_s: {} s is before the end of the change before it ({:.3f} s)", event.at_s, now_s));
    }
  } else if (event.at_m >= 0 || event.by_m >= 0) {
    const double need_m = event.by_m >= 0 ? ramp.duration_s * (v_m_s + event.to_m_s) / 2 : 0;
    const double begin_m = event.by_m >= 0 ? event.by_m - need_m : event.at_m;
    if (v_m_s <= 0) return refuse("the vehicle stands still here and gets to no distance: give at_s or wait_s");
    if (begin_m < here_m) {
      return refuse(
          fmt::format("the change would have to begin at {:.2f} m, but the one before it ends at {:.2f} m: "
                      "move it, or raise peak_m_s2",
                      begin_m, here_m));
    }
    ramp.t_s = now_s + (begin_m - here_m) / v_m_s;
  }
  ramp.planned_m = here_m + v_m_s * (ramp.t_s - now_s);
  ramps_.push_back(ramp);
}

namespace {

/// Speed that has been gained since the change began, as distance with derivatives by time.
Jet gained(const SpeedProfile::Ramp& ramp, double since_s) {
  const double dv = ramp.change_m_s;
  if (ramp.onset_s == 0) {
    const double T = ramp.duration_s, u = since_s / T;
    const Jet h = smooth_step(u);
    return {dv * T * smooth_step_integral(u), dv * h.f, dv / T * h.d1, dv / (T * T) * h.d2};
  }
  const double tau = ramp.onset_s, at_peak_s = ramp.duration_s - tau, a = dv / at_peak_s;
  const double on = since_s / tau, off = (since_s - at_peak_s) / tau;
  const Jet come = smooth_step(on), gone = smooth_step(off);
  return {a * tau * tau * (smooth_step_second_integral(on) - smooth_step_second_integral(off)),
          a * tau * (smooth_step_integral(on) - smooth_step_integral(off)), a * (come.f - gone.f),
          a / tau * (come.d1 - gone.d1)};
}

Jet scaled(const Jet& by_u, double du) {
  return {by_u.f, by_u.d1 * du, by_u.d2 * du * du, by_u.d3 * du * du * du};
}

/// Braking harder and less hard in turns: swells within a period, fades within the last one.
Jet anti_lock(const SpeedProfile::Ramp& ramp, double since_s) {
  const double w = 2 * std::numbers::pi * ramp.abs_hz, swell_s = std::min(1 / ramp.abs_hz, ramp.duration_s / 2);
  const Jet on = scaled(smooth_step(since_s / swell_s), 1 / swell_s);
  const Jet off = scaled(smooth_step((ramp.duration_s - since_s) / swell_s), -1 / swell_s);
  const double amplitude_m = ramp.abs_m_s2 / (w * w);
  return amplitude_m * (on * off * sin_cos(Jet{w * since_s, w, 0, 0}).sin);
}

}  // namespace

Jet SpeedProfile::planned(double t_s) const {
  auto ramp = std::upper_bound(ramps_.begin(), ramps_.end(), t_s, [](double t, const Ramp& r) { return t < r.t_s; });
  if (ramp != ramps_.begin()) --ramp;
  const double since_s = t_s - ramp->t_s;
  // Not through the blend: at rest the distance is then the same number at all times.
  if (since_s >= ramp->duration_s) {
    return {ramp->end_m() + ramp->end_m_s() * (t_s - ramp->end_s()), ramp->end_m_s(), 0, 0};
  }
  Jet planned{ramp->planned_m + ramp->v_m_s * since_s, ramp->v_m_s, 0, 0};
  if (ramp->change_m_s != 0) planned = planned + gained(*ramp, since_s);
  if (ramp->change_m_s != 0 && ramp->abs_m_s2 > 0) planned = planned + anti_lock(*ramp, since_s);
  return planned;
}

Jet SpeedProfile::at(double t_s) const {
  const Jet S = planned(t_s);
  return S + chain(ripple_.at(S.f), S) - Jet{ripple_at_start_m_};
}

}  // namespace tarmac::scenes
