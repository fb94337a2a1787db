#include "sim/truth/course.h"

#include <fmt/core.h>

#include <utility>
#include <vector>

#include "core/random.h"

namespace tarmac::sim::truth {

using namespace core;

namespace {

class AxleCourse final : public Course {
 public:
  explicit AxleCourse(CoursePlan plan) : plan_(std::move(plan)) {}
  Planar at(double t_s) const override { return axle_at(plan_, t_s); }

 private:
  CoursePlan plan_;
};

void check_waves(const ConfigNode& node, const char* group, double shortest, double longest) {
  if (shortest <= longest) return;
  node.child(group).fail_at("max_wavelength_m",
                            fmt::format("{} is below min_wavelength_m, which is {}", longest, shortest));
}

}  // namespace

void fail_at_item(const ConfigNode& node, const char* list, std::size_t index, const std::string& message) {
  const std::vector<ConfigNode> items = node.child(list).items();
  if (index < items.size()) items[index].fail(message);
  node.fail_at(list, message);
}

Planar axle_at(const CoursePlan& plan, double t_s) {
  Planar p;
  p.s = plan.speed.at(t_s);
  const PlanarPath::Point point = plan.path.at(p.s.f);
  p.heading = chain(point.heading, p.s);
  p.direction = sin_cos(p.heading);
  p.v_m_s = derivative(p.s);
  const Jet vx = p.v_m_s * p.direction.cos, vy = p.v_m_s * p.direction.sin;
  p.x_m = {point.x_m, vx.f, vx.d1, vx.d2};
  p.y_m = {point.y_m, vy.f, vy.d1, vy.d2};
  return p;
}

std::unique_ptr<const Course> make_axle_course(CoursePlan plan) {
  return std::make_unique<AxleCourse>(std::move(plan));
}

CoursePlan plan_course(const ConfigNode& node, const CourseOptions& options, double end_s, double beyond_s,
                       std::uint64_t seed) {
  if (options.path.empty()) {
    node.fail_at("path", "a drive needs at least one piece, such as {straight_m: 100} or {turn_deg: 90, radius_m: 8}");
  }
  check_waves(node, "jitter", options.jitter.min_wavelength_m, options.jitter.max_wavelength_m);
  check_waves(node, "wander", options.wander.min_wavelength_m, options.wander.max_wavelength_m);
  const WanderOptions& w = options.wander;
  const JitterOptions& j = options.jitter;
  const Waves wander(w.lateral_rms_m, w.min_wavelength_m, w.max_wavelength_m, 3, RandomStream(seed, "motion/wander"));
  const Waves ripple =
      Waves(j.speed_fraction_rms, j.min_wavelength_m, j.max_wavelength_m, 4, RandomStream(seed, "motion/jitter"))
          .integral();
  std::vector<PlanarPath::Problem> path_problems;
  PlanarPath path(options.start, options.path, wander, path_problems);
  for (const auto& problem : path_problems) fail_at_item(node, "path", problem.piece, problem.message);
  std::vector<SpeedProfile::Problem> speed_problems;
  SpeedProfile speed(options.speed_plan(), path.length_m(), ripple, speed_problems);
  for (const auto& problem : speed_problems) {
    if (problem.event == options.speed.size()) {
      node.fail_at("stop_peak_m_s2", "the stop at the end of the path: " + problem.message);
    }
    fail_at_item(node, "speed", problem.event, problem.message);
  }
  path.tabulate(speed.at(end_s + beyond_s).f);
  return {std::move(path), std::move(speed), ripple};
}

}  // namespace tarmac::sim::truth
