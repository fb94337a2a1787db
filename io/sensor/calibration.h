/// calibration.yaml of the plain format: the rig data sheet of one LiDAR and at most one IMU.
#pragma once

#include <filesystem>
#include <string>

#include "core/rig.h"

namespace tarmac::io {

/// YAML text with every value written out. Throws core::InputError when the rig has more sensors than the format holds.
std::string calibration_text(const core::Rig& rig);
/// `with_imu`: the folder holds imu.csv, so the IMU's block and its extrinsic must be there; without, there is no IMU
/// in the rig, whatever the file says. Throws core::InputError (file, line, field) for unknown keys, wrong values,
/// missing extrinsics.
core::Rig read_calibration(const std::filesystem::path& file, bool with_imu);

}  // namespace tarmac::io
