/// What one estimator's run leaves in its folder.
#pragma once

#include <filesystem>
#include <vector>

#include "core/estimate.h"
#include "estimators/run.h"
#include "io/sensor/tum.h"

namespace tarmac::tools {

/// The estimate's headline trajectory at every sweep's begin and end and at least every 10 ms between, where it is
/// covered; ascending. An instant that two sweeps share is given once, by the later one.
std::vector<io::StampedPose> dense_poses(const core::Estimate& estimate);
/// The reference poses of the sweeps that are `ok`.
std::vector<io::StampedPose> reference_poses(const core::Estimate& estimate);

/// Takes away an earlier run's trajectory.bin, whose presence says that a folder is whole. Creates the folder.
void begin_outputs(const std::filesystem::path& folder);
/// diagnostics.bin (where there are any), timing.json, trajectory.tum, reference.tum, and trajectory.bin last.
void write_outputs(const std::filesystem::path& folder, const estimators::RunResult& run);

}  // namespace tarmac::tools
