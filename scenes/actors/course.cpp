#include "scenes/actors/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/paths/smooth_step.h"

namespace tarmac::scenes {
namespace {

struct Plan {
  StartOptions start;
  std::vector<PathPiece> pieces;
  SpeedPlan speed;
};

[[noreturn]] void fail_at_item(const core::ConfigNode& node, const char* list, std::size_t index,
                               const std::string& message) {
  const std::vector<core::ConfigNode> items = node.child(list).items();
  if (index < items.size()) items[index].fail(message);
  node.fail(message);
}

/// One way point that has a time.
struct Stop {
  std::size_t point;
  double t_s, s_m;
};

std::vector<Stop> timetable(const core::ConfigNode& node, const std::vector<WayPoint>& points,
                            const std::vector<double>& s_m) {
  std::vector<Stop> stops;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].at_s >= 0) stops.push_back({i, points[i].at_s, s_m[i]});
  if (stops.empty()) return stops;
  if (points.front().at_s < 0 || points.back().at_s < 0)
    fail_at_item(node, "way_points", points.front().at_s < 0 ? 0 : points.size() - 1,
                 "a gap in time: some way points have at_s, so the first and the last one need it too");
  for (std::size_t k = 1; k < stops.size(); ++k) {
    const double way_m = stops[k].s_m - stops[k - 1].s_m, time_s = stops[k].t_s - stops[k - 1].t_s;
    if (time_s > 0) continue;
    fail_at_item(node, "way_points", stops[k].point,
                 fmt::format("teleports: {:.2f} m from the point before, which it passes at {} s, but at_s is {} s",
                             way_m, stops[k - 1].t_s, stops[k].t_s));
  }
  return stops;
}

/// Between two stops the speed is way over time; around each it changes, half of the change before it and half after,
/// so that outside the changes the actor is exactly where the timetable wants it.
SpeedPlan plan_of(const core::ConfigNode& node, const std::vector<Stop>& stops, double usual_m_s2,
                  const Course::Limits& limits) {
  SpeedPlan plan{.start_m_s = 0, .rest_s = 0, .events = {}, .stop_peak_m_s2 = 0};
  double before_m_s = 0;
  for (std::size_t k = 0; k < stops.size(); ++k) {
    const bool last = k + 1 == stops.size();
    const double leg_s = last ? 0 : stops[k + 1].t_s - stops[k].t_s;
    const double after_m_s = last ? 0 : (stops[k + 1].s_m - stops[k].s_m) / leg_s;
    if (after_m_s > limits.speed_m_s)
      fail_at_item(node, "way_points", stops[k + 1].point,
                   fmt::format("teleports: {:.2f} m in {:.3f} s are {:.1f} m/s; at most {} m/s are possible",
                               stops[k + 1].s_m - stops[k].s_m, leg_s, after_m_s, limits.speed_m_s));
    const double change = std::abs(after_m_s - before_m_s);
    if (k == 0 && stops[0].t_s == 0) {
      plan.start_m_s = after_m_s;  // it is under way when time begins
    } else if (change > 0) {
      double room_s = last ? 1e9 : leg_s;  // half of it before the stop, half behind
      room_s = std::min(room_s, k == 0 ? 2 * stops[0].t_s : stops[k].t_s - stops[k - 1].t_s);
      const double peak = std::max(usual_m_s2, smooth_step_peak_slope * change / room_s);
      if (peak > limits.acceleration_m_s2)
        fail_at_item(node, "way_points", stops[k].point,
                     fmt::format("from {:.2f} to {:.2f} m/s within {:.2f} s need {:.1f} m/s^2; at most {} m/s^2 are "
                                 "possible: give it more time",
                                 before_m_s, after_m_s, room_s, peak, limits.acceleration_m_s2));
      const double duration_s = smooth_step_peak_slope * change / peak;
      plan.events.push_back(
          {.to_m_s = after_m_s, .peak_m_s2 = peak, .at_s = std::max(0.0, stops[k].t_s - duration_s / 2)});
    }
    before_m_s = after_m_s;
  }
  // Changes that just touch may overlap by rounding.
  for (std::size_t k = 1; k < plan.events.size(); ++k) plan.events[k].at_s += 1e-9 * static_cast<double>(k);
  return plan;
}

Plan make_plan(const core::ConfigNode& node, const ActorOptions& o, const Course::Limits& limits) {
  SpeedPlan speed{.start_m_s = o.start.speed_m_s,
                  .rest_s = o.start.speed_m_s > 0 ? 0 : o.rest_s,
                  .events = o.speed,
                  .stop_peak_m_s2 = o.stop_peak_m_s2};
  if (o.way_points.empty()) return {o.start, o.path, speed};
  if (!o.path.empty()) node.fail_at("way_points", "path is given as well; give one of them");
  RoundedPath path = round_corners(node, o.way_points, o.corner_radius_m);
  const std::vector<Stop> stops = timetable(node, o.way_points, path.s_m);
  if (!stops.empty() && !o.speed.empty()) node.fail_at("speed", "the way points have times already; give one of them");
  if (!stops.empty()) speed = plan_of(node, stops, o.stop_peak_m_s2, limits);
  return {path.start, std::move(path.pieces), std::move(speed)};
}

PlanarPath make_path(const core::ConfigNode& node, const Plan& plan) {
  std::vector<PlanarPath::Problem> problems;
  PlanarPath path(plan.start, plan.pieces, {}, problems);
  for (const PlanarPath::Problem& problem : problems) fail_at_item(node, "path", problem.piece, problem.message);
  path.tabulate(path.length_m());
  return path;
}

SpeedProfile make_profile(const core::ConfigNode& node, const Plan& plan, double length_m) {
  std::vector<SpeedProfile::Problem> problems;
  SpeedProfile profile(plan.speed, length_m, {}, problems);
  for (const SpeedProfile::Problem& problem : problems) {
    if (problem.event == plan.speed.events.size())
      node.fail_at("stop_peak_m_s2", "the stop at the end of the path: " + problem.message);
    fail_at_item(node, "speed", problem.event, problem.message);
  }
  return profile;
}

/// Speeds and accelerations as asked for by the timetable's entries.
void check_speeds(const core::ConfigNode& node, const ActorOptions& o, const Course::Limits& limits) {
  if (o.start.speed_m_s > limits.speed_m_s)
    node.child("start").fail_at(
        "speed_m_s", fmt::format("{} m/s; a {} reaches at most {} m/s", o.start.speed_m_s, o.kind, limits.speed_m_s));
  for (std::size_t i = 0; i < o.speed.size(); ++i) {
    const core::ConfigNode event = node.child("speed").items()[i];
    if (o.speed[i].to_m_s > limits.speed_m_s)
      event.fail_at("to_m_s",
                    fmt::format("{} m/s; a {} reaches at most {} m/s", o.speed[i].to_m_s, o.kind, limits.speed_m_s));
    if (o.speed[i].peak_m_s2 > limits.acceleration_m_s2)
      event.fail(fmt::format("peak_m_s2: {} m/s^2; a {} reaches at most {} m/s^2", o.speed[i].peak_m_s2, o.kind,
                             limits.acceleration_m_s2));
  }
  if (o.stop_peak_m_s2 > limits.acceleration_m_s2)
    node.fail_at("stop_peak_m_s2", fmt::format("{} m/s^2; a {} reaches at most {} m/s^2", o.stop_peak_m_s2, o.kind,
                                               limits.acceleration_m_s2));
}

void check_length(const core::ConfigNode& node, const SpeedProfile& profile, double length_m) {
  const SpeedProfile::Ramp& last = profile.ramps().back();
  if (last.end_m() > length_m + 1e-6)
    node.fail_at("speed", fmt::format("leads {:.2f} m along a path of {:.2f} m: lengthen the path or stop earlier",
                                      last.end_m(), length_m));
}

/// The tightest place of the path, and what it asks for at the speed there.
void check_turns(const core::ConfigNode& node, const ActorOptions& o, const Course& course,
                 const Course::Limits& limits) {
  for (const Course::Span& span : course.moves()) {
    const auto count = static_cast<int>(std::ceil((span.end_s - span.begin_s) / 0.02)) + 1;
    for (int k = 0; k < count; ++k) {
      const double t_s = std::min(span.end_s, span.begin_s + 0.02 * k), s = course.s_m(t_s), v = course.speed_m_s(t_s);
      const double curvature = std::abs(course.path().heading(s).d1);
      if (curvature * limits.min_radius_m > 1 + 1e-6)
        node.fail(
            fmt::format("{}: the path's radius is {:.2f} m after {:.1f} m; at least {:.2f} m are possible: turn "
                        "more widely",
                        o.name, 1 / curvature, s, limits.min_radius_m));
      if (v * v * curvature > limits.sideways_m_s2)
        node.fail(
            fmt::format("{}: {:.1f} m/s in a turn of {:.1f} m radius after {:.1f} m, at {:.2f} s, are {:.1f} "
                        "m/s^2 sideways; at most {} m/s^2 are possible: slow down or turn more widely",
                        o.name, v, 1 / curvature, s, t_s, v * v * curvature, limits.sideways_m_s2));
    }
  }
}

std::vector<Course::Span> moves_of(const SpeedProfile& profile) {
  std::vector<Course::Span> moves;
  const auto add = [&](double begin_s, double end_s) {
    if (end_s <= begin_s) return;
    if (!moves.empty() && begin_s - moves.back().end_s < 1e-6)
      moves.back().end_s = end_s;
    else
      moves.push_back({begin_s, end_s});
  };
  const auto& ramps = profile.ramps();
  for (std::size_t k = 0; k < ramps.size(); ++k) {
    const bool stands = ramps[k].v_m_s == 0 && ramps[k].change_m_s == 0;
    if (!stands) add(ramps[k].t_s, ramps[k].end_s());
    if (ramps[k].end_m_s() > 0 && k + 1 < ramps.size()) add(ramps[k].end_s(), ramps[k + 1].t_s);
  }
  return moves;
}

}  // namespace

Course::Course(PlanarPath path, SpeedProfile speed)
    : path_(std::move(path)), speed_(std::move(speed)), moves_(moves_of(speed_)) {}

double Course::s_m(double t_s) const {
  return std::clamp(speed_.at(t_s).f, 0.0, path_.length_m());
}

double Course::top_speed_m_s() const {
  double top = 0;
  for (const SpeedProfile::Ramp& ramp : speed_.ramps()) top = std::max({top, ramp.v_m_s, ramp.end_m_s()});
  return top;
}

Course make_course(const core::ConfigNode& node, const ActorOptions& options, const Course::Limits& limits) {
  const Plan plan = make_plan(node, options, limits);
  PlanarPath path = make_path(node, plan);
  check_speeds(node, options, limits);
  SpeedProfile profile = make_profile(node, plan, path.length_m());
  check_length(node, profile, path.length_m());
  Course course(std::move(path), std::move(profile));
  check_turns(node, options, course, limits);
  return course;
}

}  // namespace tarmac::scenes
