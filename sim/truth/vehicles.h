/// Vehicles by name: how their bodies answer the road and the driver.
#pragma once

#include <string>
#include <vector>

#include "sim/truth/drive_options.h"

namespace tarmac::sim::truth {

std::vector<std::string> vehicle_names();
/// Sets suspension and vibration to the vehicle's; leaves everything alone for a name that is not known.
void set_vehicle(const std::string& name, SuspensionOptions& suspension, VibrationOptions& vibration);

}  // namespace tarmac::sim::truth
