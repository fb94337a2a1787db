#include "estimators/ct_icp/ct_icp.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "estimators/blocks/stopwatch.h"
#include "estimators/ct_icp/record.h"

namespace tarmac::estimators {
namespace {

CtIcpOptions checked(const CtIcpOptions& o) {
  if (o.min_range_m >= o.max_range_m) {
    throw core::InputError(fmt::format("min_range_m: {} must be below max_range_m ({}): no point would be left",
                                       o.min_range_m, o.max_range_m));
  }
  if (o.min_neighbours > o.max_neighbours) {
    throw core::InputError(
        fmt::format("min_neighbours: {} must not be above max_neighbours ({}): no plane would be "
                    "found",
                    o.min_neighbours, o.max_neighbours));
  }
  if (!(o.planarity_weight + o.neighbourhood_weight > 0)) {
    throw core::InputError("planarity_weight and neighbourhood_weight are both 0: set one of them above 0");
  }
  if (o.gauss_newton_quirk && o.solver != "gauss-newton") {
    throw core::InputError("gauss_newton_quirk: needs solver gauss-newton; the quirk is no gradient of any cost");
  }
  const double smallest_cell_m = std::min({o.sample_cell_m, o.startup_sample_cell_m, o.map_voxel_m});
  if (o.max_range_m / smallest_cell_m > 1e8) {
    throw core::InputError(fmt::format("max_range_m: {} is too large for cells of {} m: cells are counted in 32 bits",
                                       o.max_range_m, smallest_cell_m));
  }
  return o;
}

core::SweepStatus status_of(const core::LidarSweep& sweep, const CtOdometry::Step& step) {
  if (sweep.empty()) return core::SweepStatus::empty;
  return step.lost ? core::SweepStatus::lost : core::SweepStatus::ok;
}

/// What was unusual, for the log.
std::string note_of(const core::LidarSweep& sweep, const CtOdometry::Step& step) {
  std::string note;
  if (step.span.clipped() > 0) {
    note = fmt::format("{} stamps outside the sweep, moved to its begin or end", step.span.clipped());
  }
  if (!sweep.empty() && !step.span.elastic()) {
    note += note.empty() ? "" : "; ";
    note += "no two stamps differ: taken as rigid";
  }
  return note;
}

}  // namespace

CtIcp::CtIcp(const CtIcpOptions& options, const EstimatorContext& context)
    : odometry_(checked(options), context.rig.lidars.at(0).T_body_lidar),
      level_(context.diagnostics),
      arena_(std::max(1, context.threads)) {}

SweepOutcome CtIcp::add(const core::LidarSweep& sweep) {
  CtOdometry::Step step = arena_.execute([&] { return odometry_.add(sweep); });
  SweepOutcome outcome;
  outcome.stages_ms = std::move(step.stages_ms);
  Stopwatch stopwatch(outcome.stages_ms);
  outcome.result = {.index = sweep.index,
                    .begin = sweep.begin,
                    .end = sweep.end,
                    .reference = step.motion.t1,
                    .status = status_of(sweep, step),
                    .T_map_body = step.motion.poses.back()};
  outcome.note = note_of(sweep, step);
  if (level_ != core::DiagnosticsLevel::none) {
    outcome.diagnostics = record_of(sweep, odometry_, step, level_);
    stopwatch.lap(kRecordStage);
  }
  outcome.diagnostics.index = sweep.index;
  outcome.motion = {std::move(step.motion)};
  return outcome;
}

extern const EstimatorEntry ct_icp;
const EstimatorEntry ct_icp{.name = "ct-icp",
                            .summary = "two poses a sweep, interpolated between; point-to-plane on a voxel map",
                            .source = "Dellenbach et al., CT-ICP, ICRA 2022; as of upstream tags icra_2022 and d467813",
                            .needs = Needs::lidar,
                            .make = make_with<CtIcp, CtIcpOptions>,
                            .describe = describe_with<CtIcpOptions>,
                            .resolve = resolve_with<CtIcpOptions>};

}  // namespace tarmac::estimators
