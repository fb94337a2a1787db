/// The plain format (docs/formats.md): lidar/%06d.bin, lidar/%06d.ring, lidar/stamps.txt, imu.csv, calibration.yaml.
#pragma once

#include <filesystem>
#include <string>

#include "core/progress.h"
#include "core/recording.h"

namespace tarmac::io {

/// Writes a recording as a plain folder; `imu.csv` only where the rig has an IMU, `calibration.yaml` only where the rig
/// is calibrated. An earlier export in that folder is replaced; lidar/stamps.txt is written last, so a folder without
/// it was left half-way and is refused. Files are numbered by position: a hole in the sweeps' indices closes.
/// Point times become float32 seconds and lose up to 4 ns in a sweep of 0.1 s.
/// Several LiDARs are written as one, merged in the body's frame (core/merged_sweeps.h). Throws core::InputError when
/// the rig has several IMUs, which the format cannot hold.
void export_plain(const core::Recording& recording, const std::filesystem::path& folder,
                  const core::Progress& progress);
/// Reads a plain folder into a recording folder. Returns the recording's hash. Throws core::InputError with file and
/// line: a missing stamps.txt, a sweep file whose size is no multiple of 20, a missing sweep, malformed csv, a point
/// time that cannot be one. Empty sweeps, points that are not finite and stamps out of order are kept as they are.
/// Without ring files every ring is 0; without calibration.yaml Rig::calibrated is false and body = LiDAR frame.
std::string import_plain(const std::filesystem::path& folder, const std::filesystem::path& recording_folder,
                         const core::Progress& progress);
/// True when the folder looks like the plain format.
bool is_plain(const std::filesystem::path& folder);

/// KITTI odometry layout: velodyne/%06d.bin (x y z reflectance), times.txt (the middle of each sweep on the recording's
/// clock, seconds; written last); poses are written by write_kitti_poses. Point times, rings, IMU and calibration have
/// no place in it.
void export_kitti(const core::Recording& recording, const std::filesystem::path& folder,
                  const core::Progress& progress);
/// KITTI clouds carry no point times: they are derived from azimuth (clockwise from the rear, the stamp when the sensor
/// faces forward), and both the progress note and the data sheet's model say so. The benchmark's own clouds are already
/// motion-compensated: a method that deskews does it to them a second time.
std::string import_kitti(const std::filesystem::path& folder, const std::filesystem::path& recording_folder,
                         const core::Progress& progress);

}  // namespace tarmac::io
