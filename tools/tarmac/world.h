/// A scenario brought to life: scene, motion and rig, checked as a whole before anything is written.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/simulate.h"
#include "tools/tarmac/estimator_run.h"

namespace tarmac::tools {

/// Validates scene, motion and rig options without building meshes; throws InputError.
void check_world(const scenarios::Scenario& scenario);

/// The scenario with every default written out, for this seed.
std::string resolve_scenario(const scenarios::Scenario& scenario, std::uint64_t seed,
                             const std::vector<EstimatorRequest>& estimators);

sim::SimulationInput build_world(const scenarios::Scenario& scenario, std::uint64_t seed, const std::string& resolved);

}  // namespace tarmac::tools
