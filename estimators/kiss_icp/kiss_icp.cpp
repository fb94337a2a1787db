#include "estimators/kiss_icp/kiss_icp.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "estimators/blocks/stopwatch.h"
#include "estimators/kiss_icp/record.h"

namespace tarmac::estimators {
namespace {

KissIcpOptions checked(const KissIcpOptions& options) {
  if (options.min_range_m >= options.max_range_m) {
    throw core::InputError(fmt::format("min_range_m: {} must be below max_range_m ({}): no point would be left",
                                       options.min_range_m, options.max_range_m));
  }
  if (options.max_range_m / options.voxel_size_m > 1e8) {
    throw core::InputError(
        fmt::format("voxel_size_m: {} is too small for max_range_m {}: voxels are counted in 32 bits",
                    options.voxel_size_m, options.max_range_m));
  }
  return options;
}

KissIcpOptions without_deskew(const RigidIcpOptions& options) {
  KissIcpOptions rigid;
  static_cast<RigidIcpOptions&>(rigid) = options;
  rigid.deskew = false;
  return rigid;
}

}  // namespace

KissIcp::KissIcp(const KissIcpOptions& options, const EstimatorContext& context)
    : odometry_(checked(options)),
      level_(context.diagnostics),
      T_lidar_body_(context.rig.lidars.at(0).T_body_lidar.inverse()),
      arena_(std::max(1, context.threads)) {}

core::SweepStatus KissIcp::status(const KissOdometry::Step& step) const {
  if (odometry_.icp_sample().empty()) return core::SweepStatus::empty;
  return step.icp.solved ? core::SweepStatus::ok : core::SweepStatus::lost;
}

SweepOutcome KissIcp::add(const core::LidarSweep& sweep) {
  KissOdometry::Step step = arena_.execute([&] { return odometry_.add(sweep); });
  SweepOutcome outcome;
  outcome.stages_ms = std::move(step.stages_ms);
  Stopwatch stopwatch(outcome.stages_ms);

  // Stamps beyond the sweep's end are a fault of the sensor's; the reference stays inside.
  const core::Duration span = sweep.end - sweep.begin;
  const core::Duration last =
      sweep.empty() ? span : std::clamp(core::Duration(step.motion.last_ns()), core::Duration(0), span);
  const core::SE3 T_last_reference =
      last.count() == step.motion.last_ns() ? core::SE3::Identity() : step.motion.T_end_point(last.count());
  outcome.result = {.index = sweep.index,
                    .begin = sweep.begin,
                    .end = sweep.end,
                    .reference = sweep.begin + last,
                    .status = status(step),
                    .T_map_body = step.icp.T_map_lidar * T_last_reference * T_lidar_body_};
  outcome.motion = placed_by(sweep, step.motion, step.icp.T_map_lidar, T_lidar_body_);
  if (level_ != core::DiagnosticsLevel::none) {
    outcome.diagnostics = record_of(sweep, odometry_, step, T_lidar_body_, level_);
    stopwatch.lap("record");
  }
  outcome.diagnostics.index = sweep.index;
  return outcome;
}

RigidIcp::RigidIcp(const RigidIcpOptions& options, const EstimatorContext& context)
    : KissIcp(without_deskew(options), context) {}

extern const EstimatorEntry kiss_icp;
const EstimatorEntry kiss_icp{
    .name = "kiss-icp",
    .summary = "point-to-point ICP on a voxel map, constant-velocity deskewing and prediction",
    .source = "Vizzo et al., KISS-ICP, RA-L 8(2) 2023; as of upstream v1.2.3",
    .needs = Needs::lidar,
    .make = make_with<KissIcp, KissIcpOptions>,
    .describe = describe_with<KissIcpOptions>,
    .resolve = resolve_with<KissIcpOptions>};

extern const EstimatorEntry rigid_icp;
const EstimatorEntry rigid_icp{.name = "rigid-icp",
                               .summary = "kiss-icp without deskewing: every sweep is taken as rigid",
                               .source = "Vizzo et al., KISS-ICP, RA-L 8(2) 2023; as of upstream v1.2.3",
                               .needs = Needs::lidar,
                               .make = make_with<RigidIcp, RigidIcpOptions>,
                               .describe = describe_with<RigidIcpOptions>,
                               .resolve = resolve_with<RigidIcpOptions>};

}  // namespace tarmac::estimators
