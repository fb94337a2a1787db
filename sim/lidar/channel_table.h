/// A table of channels as CSV: what a profile's `channels: table.csv` names.
#pragma once

#include <filesystem>

#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {

/// Reads lists of one value a channel: a header of names from channel_columns() in any order (elevation_deg and
/// azimuth_offset_cw_deg must be there), then one line a channel in firing order; lines that begin with # are comments.
/// Throws InputError (file, line, column) for anything else.
void read_channel_table(const std::filesystem::path& file, Profile& profile);

}  // namespace tarmac::sim::lidar
