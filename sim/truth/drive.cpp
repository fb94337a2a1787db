#include "sim/truth/drive.h"

#include <utility>

#include "sim/truth/drive_options.h"
#include "sim/truth/suspension.h"
#include "sim/truth/vehicle_body.h"

namespace tarmac::sim::truth {

std::shared_ptr<const core::SmoothTrajectory> make_drive(const core::ConfigNode& node, core::Duration duration,
                                                         std::shared_ptr<const scenes::Ground> ground,
                                                         std::uint64_t seed) {
  const DriveOptions options = read_drive_options(node);
  // The suspension's last interval ends up to two nodes after the motion does.
  CoursePlan plan = plan_course(node, options, core::to_s(duration), 2 * Suspension::node_spacing_s, seed);
  return make_vehicle_body(node, make_axle_course(std::move(plan)),
                           {options.road, options.bumps, options.suspension, options.vibration}, duration,
                           std::move(ground), seed);
}

}  // namespace tarmac::sim::truth
