/// Vehicles by name: how their bodies answer the road and the driver.
#pragma once

#include <string>
#include <vector>

#include "sim/truth/body_box.h"
#include "sim/truth/drive_options.h"

namespace tarmac::sim::truth {

std::vector<std::string> vehicle_names();
/// Sets suspension and vibration to the vehicle's; leaves everything alone for a name that is not known.
void set_vehicle(const std::string& name, SuspensionOptions& suspension, VibrationOptions& vibration);
/// Its outline; a van's for a name that is not known.
BodyBox vehicle_box(const std::string& name);

}  // namespace tarmac::sim::truth
