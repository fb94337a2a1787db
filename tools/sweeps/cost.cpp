#include "tools/sweeps/cost.h"

#include <map>

namespace tarmac::tools {
namespace {

constexpr double kSimulate_s_per_ray = 0.55e-6;
constexpr double kScore_s_per_ray = 1.2e-6;  // of sensors whose channels fire one after the other; less of others
constexpr double kStart_s = 0.3;             // processes, reading and writing
constexpr double kRecordingBytesPerRay = 7.9;
constexpr double kCellFiles_mb = 0.5;
constexpr double kFullDiagnosticsBytesPerRay = 5.0;

/// Methods by their measured time a ray; one that is not here (a foreign one) is taken for a middling one.
double estimate_s_per_ray(const std::string& estimator) {
  static const std::map<std::string, double> measured = {{"kiss-icp", 0.5e-6},
                                                         {"rigid-icp", 0.45e-6},
                                                         {"kiss-icp-imu", 0.4e-6},
                                                         {"ct-icp", 1.3e-6},
                                                         {"dead-reckoning", 0.06e-6}};
  const auto found = measured.find(estimator);
  return found == measured.end() ? 0.5e-6 : found->second;
}

}  // namespace

CellCost estimate_cost(const SweepPlan& plan, const PlannedCell& cell) {
  const double rays = plan.worlds[cell.world].rays;
  const bool full = plan.file.diagnostics == "full";
  CellCost cost;
  cost.simulate_s = kStart_s + kSimulate_s_per_ray * rays;
  cost.run_s =
      kStart_s + (estimate_s_per_ray(cell.request.name) * (full ? 3 : 1) + kScore_s_per_ray * (full ? 2 : 1)) * rays;
  cost.recording_mb = 1e-6 * kRecordingBytesPerRay * rays;
  cost.files_mb = kCellFiles_mb;
  if (plan.file.keep == "everything" && full) cost.files_mb += 1e-6 * kFullDiagnosticsBytesPerRay * rays;
  return cost;
}

double cost_of_world(const SweepPlan& plan, const PlannedWorld& world) {
  double sum_s = 0;
  for (const std::size_t c : world.cells) {
    const CellCost cost = estimate_cost(plan, plan.cells[c]);
    if (sum_s == 0) sum_s = cost.simulate_s;
    sum_s += cost.run_s;
  }
  return sum_s;
}

}  // namespace tarmac::tools
