#include "tools/tarmac/world.h"

#include "core/options.h"
#include "scenes/registry.h"
#include "sim/truth/motion.h"

namespace tarmac::tools {
namespace {

/// The top level as options, so that its text is quoted like any other.
struct TopLevel {
  scenarios::Scenario scenario;
  void visit(core::OptionVisitor& v) {
    v("name", scenario.name, "");
    v("why", scenario.why, "");
    v("surprise", scenario.surprise, "");
    v("seed", scenario.seed, "");
    v("duration_s", scenario.duration_s, "");
  }
};

}  // namespace

void check_world(const scenarios::Scenario& scenario) {
  scenes::resolve_scene(scenario.scene);
  sim::truth::resolve_motion(scenario.motion);
  sim::resolve_rig(scenario.rig);
  sim::resolve_faults(scenario.faults, scenario.rig);
}

std::string resolve_scenario(const scenarios::Scenario& scenario, std::uint64_t seed,
                             const std::vector<EstimatorRequest>& estimators) {
  TopLevel top{scenario};
  top.scenario.seed = static_cast<std::int64_t>(seed);
  std::string text = core::write_options(top);
  text += "scene:\n" + scenes::resolve_scene(scenario.scene);
  text += "motion:\n" + sim::truth::resolve_motion(scenario.motion);
  text += "rig:\n" + sim::resolve_rig(scenario.rig);
  if (const std::string faults = sim::resolve_faults(scenario.faults, scenario.rig); !faults.empty())
    text += "faults:\n" + faults;
  // Only where it is asked for: the resolved text is what tells one simulated world from another.
  if (scenario.truth.per_point) text += "truth:\n  per_point: true\n";
  if (!estimators.empty()) text += "estimators:\n";
  for (const EstimatorRequest& request : estimators) {
    const std::string options = resolved_options(request);
    text += "  " + request.name + (options.empty() ? ": {}\n" : ":\n" + options);
  }
  return text;
}

sim::SimulationInput build_world(const scenarios::Scenario& scenario, std::uint64_t seed, const std::string& resolved) {
  sim::SimulationInput input;
  input.scenario_name = scenario.name;
  input.seed = seed;
  input.duration = scenario.duration();
  input.scene = std::make_shared<const scenes::Scene>(scenes::make_scene(scenario.scene, seed));
  input.motion = sim::truth::make_motion(scenario.motion, scenario.duration(), input.scene->ground, seed);
  input.body = sim::truth::body_box(scenario.motion);
  input.rig = scenario.rig;
  input.faults = scenario.faults;
  input.point_truth = scenario.truth.per_point;
  input.resolved_scenario = resolved;
  input.resolved_motion = sim::truth::resolve_motion(scenario.motion);
  return input;
}

}  // namespace tarmac::tools
