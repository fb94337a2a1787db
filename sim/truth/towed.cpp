#include "sim/truth/towed.h"

#include <utility>

#include "sim/truth/course.h"
#include "sim/truth/suspension.h"
#include "sim/truth/train.h"
#include "sim/truth/vehicle_body.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;

/// The last link's axle. Its place follows from the tug's and the headings in closed form.
class TowedCourse final : public Course {
 public:
  TowedCourse(std::shared_ptr<const CoursePlan> plan, Train train) : plan_(std::move(plan)), train_(std::move(train)) {
    for (const Train::Link& link : train_.links()) behind_m_ += link.hitch_m + link.length_m;
  }

  Planar at(double t_s) const override {
    const Planar tug = axle_at(*plan_, t_s);
    const std::array<Jet, Train::max_links> by_distance = train_.headings(tug.s.f);
    Planar p = tug;
    for (std::size_t i = 0; i < train_.links().size(); ++i) {
      const Train::Link& link = train_.links()[i];
      p.x_m = p.x_m - link.hitch_m * p.direction.cos;
      p.y_m = p.y_m - link.hitch_m * p.direction.sin;
      p.heading = chain(by_distance[i], tug.s);
      p.direction = sin_cos(p.heading);
      p.x_m = p.x_m - link.length_m * p.direction.cos;
      p.y_m = p.y_m - link.length_m * p.direction.sin;
    }
    const Jet ratio = train_.speed_ratio(plan_->path.heading(tug.s.f), by_distance);
    p.v_m_s = chain(ratio, tug.s) * tug.v_m_s;
    // What the road does to the trailer, the tug met the train's length before.
    p.s.f -= behind_m_;
    return p;
  }

 private:
  std::shared_ptr<const CoursePlan> plan_;
  Train train_;
  double behind_m_ = 0;
};

}  // namespace

/// A baggage dolly: no springs but its tyres, and no engine but the tug's through the hitch.
TowedOptions::TowedOptions() {
  suspension = {.wheelbase_m = 1.6,
                .track_m = 1.3,
                .centre_height_m = 0.5,
                .heave_hz = 4.2,
                .heave_damping = 0.08,
                .pitch_hz = 4.6,
                .pitch_damping = 0.08,
                .roll_hz = 3.8,
                .roll_damping = 0.08,
                .dive_deg_per_m_s2 = 0.05,
                .lean_deg_per_m_s2 = 0.15};
  vibration.engine_rms_m_s2 = 0.01;
  vibration.engine_rms_deg_s = 0.01;
  vibration.rolling_rms_m_s2 = 0.25;
  vibration.rolling_rms_deg_s = 0.2;
}

void LinkOptions::visit(OptionVisitor& v) {
  v("hitch_m", hitch_m, "how far behind the axle before it the link is hitched on", {.at_least = 0, .at_most = 5});
  v("length_m", length_m, "from the hitch to the link's own axle", {.above = 0.3, .at_most = 15});
}

void TowedOptions::visit(OptionVisitor& v) {
  v.group("tug", tug, "what pulls: the path and speeds of its rear axle");
  v.list("links", links, "one or two: a drawbar and a trailer, or a trailer alone; the sensor is on the last");
  v.group("road", road, "unevenness under the trailer's wheels");
  v.list("bumps", bumps, "single obstacles under the trailer's wheels; at_m is along the tug's path");
  v.group("suspension", suspension, "how the trailer's body answers");
  v.group("vibration", vibration, "what shakes it");
}

TowedOptions read_towed_options(const ConfigNode& node) {
  TowedOptions options;
  node.read(options, {"kind"});
  for (BumpOptions& bump : options.bumps) complete_bump(bump);
  if (options.links.empty() || options.links.size() > Train::max_links) {
    node.fail_at("links", "a train has one or two links, such as {hitch_m: 0.6, length_m: 2.2}");
  }
  return options;
}

std::shared_ptr<const SmoothTrajectory> make_towed(const ConfigNode& node, Duration duration,
                                                   std::shared_ptr<const scenes::Ground> ground, std::uint64_t seed) {
  const TowedOptions options = read_towed_options(node);
  constexpr double beyond_s = 2 * Suspension::node_spacing_s;
  const auto plan =
      std::make_shared<const CoursePlan>(plan_course(node.child("tug"), options.tug, to_s(duration), beyond_s, seed));
  std::vector<Train::Link> links;
  for (const LinkOptions& link : options.links) links.push_back({link.hitch_m, link.length_m});
  Train::Problem problem;
  const Train train(
      links, [plan](double s_m) { return plan->path.heading(s_m); }, plan->speed.at(to_s(duration) + beyond_s).f,
      problem);
  if (!problem.message.empty()) node.fail_at("links", problem.message);
  return make_vehicle_body(node, std::make_unique<TowedCourse>(plan, train),
                           {options.road, options.bumps, options.suspension, options.vibration}, duration,
                           std::move(ground), seed);
}

}  // namespace tarmac::sim::truth
