/// Sensors of the user's own, from files.
#pragma once

#include <filesystem>
#include <string>

#include "sim/lidar/profile.h"

namespace tarmac::sim::lidar {

/// True where the text can only be a path: it has a slash or ends with .yaml, .yml, .json or .csv.
bool is_profile_path(const std::string& model);

/// A sensor from a file; its name is the file's without the extension.
///   NAME.yaml  the keys of Profile::visit, as in profiles/. `channels: FILE` (relative to the YAML) takes the values
///   of
///              the channels from a table (channel_table.h), or from an Ouster metadata JSON all that this tells
///              (ouster_metadata.h); what else the YAML says has precedence, and a channel's values stand in one place.
///   NAME.json  an Ouster metadata file.
/// Throws InputError with file, line and field.
Profile load_profile(const std::filesystem::path& file);

}  // namespace tarmac::sim::lidar
