/// Programs of somebody else's: how they are called, and how their TUM file becomes an estimate like any other.
#pragma once

#include <filesystem>
#include <string>

#include "core/estimate.h"
#include "core/recording.h"
#include "io/sensor/tum.h"
#include "tools/tarmac/child.h"
#include "tools/tarmac/estimator_run.h"

namespace tarmac::tools {

/// The command with {input} and {output} filled in; relative programs and scripts are looked up from where Tarmac runs.
ChildRequest foreign_command(const ForeignTool& tool, const std::filesystem::path& workplace);

/// Poses of a foreign program -> T_map_body over time, and a result at each sweep's end that they cover.
core::Estimate estimate_from_poses(const std::string& name, const ForeignTool& tool,
                                   const std::vector<io::StampedPose>& poses, const core::Recording& recording);

/// Writes trajectory.bin, trajectory.tum, reference.tum and timing.json into `output`, or puts into `outcome` why not.
void adopt_foreign_output(const std::string& name, const ForeignTool& tool,
                          const std::filesystem::path& recording_folder, const std::filesystem::path& output,
                          const ChildResult& child, Outcome& outcome);

}  // namespace tarmac::tools
