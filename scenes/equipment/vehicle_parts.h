/// Parts that several vehicles have.
#pragma once

#include <optional>

#include "scenes/equipment/equipment.h"

namespace tarmac::scenes {

/// Two wheels on one axle, their outer faces at +-`half_width_m`.
void add_axle(MeshBuilder& b, double x_m, double half_width_m, double radius_m, double width_m);

/// A cab over the front axle from `x0_m` forward to `x1_m`: body in the builder's material, with windscreen and side
/// windows in dark glass just off the body, and mirrors. `arch` leaves room for a wheel: its axle's x and radius.
struct WheelArch {
  double axle_x_m = 0, wheel_radius_m = 0;
};
void add_truck_cab(MeshBuilder& b, double x0_m, double x1_m, double half_width_m, double low_z_m, double high_z_m,
                   const std::optional<WheelArch>& arch = {});

/// Posts and rails around a platform, 1.1 m high.
void add_guard_rail(MeshBuilder& b, double x0_m, double x1_m, double half_width_m, double floor_z_m,
                    double height_m = 1.1);

/// Orange flashing light.
void add_beacon(MeshBuilder& b, double x_m, double y_m, double z_m);

/// A lying tank of rounded section between two heights; closed.
void add_tank(MeshBuilder& b, double x0_m, double x1_m, double half_width_m, double low_z_m, double high_z_m);

}  // namespace tarmac::scenes
