#include "estimators/kiss_icp/kiss_icp.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "estimators/kiss_icp/record.h"

namespace tarmac::estimators {

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

KissIcpOptions kiss_options(const RigidIcpOptions& options, bool deskew) {
  KissIcpOptions all;
  static_cast<RigidIcpOptions&>(all) = options;
  all.deskew = deskew;
  return all;
}

KissIcp::KissIcp(const KissIcpOptions& options, const EstimatorContext& context)
    : odometry_(checked(options)),
      level_(context.diagnostics),
      T_lidar_body_(context.rig.lidars.at(0).T_body_lidar.inverse()),
      arena_(std::max(1, context.threads)) {
  if (level_ == core::DiagnosticsLevel::full) odometry_.look_for_surfaces();
}

SweepOutcome KissIcp::add(const core::LidarSweep& sweep) {
  KissOdometry::Step step = arena_.execute([&] { return odometry_.add(sweep); });
  return outcome_of(sweep, odometry_, std::move(step), T_lidar_body_, level_);
}

RigidIcp::RigidIcp(const RigidIcpOptions& options, const EstimatorContext& context)
    : KissIcp(kiss_options(options, false), context) {}

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
