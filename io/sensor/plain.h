/// The plain format (docs/formats.md): lidar/%06d.bin, lidar/%06d.ring, lidar/stamps.txt, imu.csv, calibration.yaml.
#pragma once

#include <filesystem>

#include "core/progress.h"
#include "core/recording.h"

namespace tarmac::io {

/// Writes a recording as a plain folder; `imu.csv` only where the rig has an IMU.
void export_plain(const core::Recording& recording, const std::filesystem::path& folder, const core::Progress& progress);
/// Reads a plain folder into a recording folder. Returns the recording's hash. Throws InputError with file and line:
/// a missing stamps.txt, a sweep file whose size is no multiple of 20, a missing sweep, malformed csv.
std::string import_plain(const std::filesystem::path& folder, const std::filesystem::path& recording_folder,
                         const core::Progress& progress);
/// True when the folder looks like the plain format.
bool is_plain(const std::filesystem::path& folder);

/// KITTI odometry layout: velodyne/%06d.bin (x y z reflectance), times.txt, poses are written by write_kitti_poses.
void export_kitti(const core::Recording& recording, const std::filesystem::path& folder, const core::Progress& progress);
/// KITTI clouds carry no point times: they are derived from azimuth (clockwise from the rear), and the log says so.
std::string import_kitti(const std::filesystem::path& folder, const std::filesystem::path& recording_folder,
                         const core::Progress& progress);

}  // namespace tarmac::io
