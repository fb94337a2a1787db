/// An Ouster sensor from the metadata that it tells of itself (a JSON file beside every capture).
#pragma once

#include <filesystem>

#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {

/// Fills in what the metadata says: beams, modes, where a sweep begins, beam origins, column window, range step. Reads
/// the flat layout of older firmware and the nested one of newer (beam_intrinsics, lidar_intrinsics,
/// lidar_data_format, config_params, sensor_info). Other keys are left alone.
///   - The modes are lidar_mode and the usual ones; where column_window leaves columns out, lidar_mode alone, because
///     the window is counted in its columns.
///   - Beam i of N gets ring N - 1 - i: rings count from the lowest beam.
///   - Channels whose two angles are 0 are those that a sensor with fewer beams lacks; they are left out.
///   - Without beam_to_lidar_transform and lidar_origin_to_beam_origin_mm, and without lidar_to_sensor_transform, the
///     product line's usual values (Profile::source then says so).
/// Frames and formula of the maker: with n_x, n_z the translation of beam_to_lidar_transform,
///   p_lidar = (n_x cos e, n_x sin e, n_z) + (r - sqrt(n_x^2 + n_z^2)) d,  e = 2 pi (1 - column / columns),
///   p_sensor = lidar_to_sensor_transform p_lidar.
/// Throws InputError (file, line, field): angles missing or of unequal count, counts that contradict each other, a
/// transform that is not a turn about z and a height.
void read_ouster_beams(const std::filesystem::path& file, Profile& profile);

/// The sensor as a whole; range and noise are those of its product line, told by prod_line and the beam origin. Throws
/// InputError where they are not known (another prod_line or none): a profile with `channels: FILE.json` can then say
/// them.
Profile ouster_profile(const std::filesystem::path& file);

}  // namespace tarmac::sim::lidar
