/// The command line of tarmac-estimate. It is a library so that a test can build the same program with something done
/// to the recording first.
#pragma once

#include <filesystem>
#include <functional>

#include "core/recording.h"

namespace tarmac::tools {

/// Takes the recording that was given and the folder of the results, and returns the recording to run on.
using RecordingChange =
    std::function<core::Recording(const core::Recording& recording, const std::filesystem::path& output)>;

/// Everything that main() does; returns the exit code. Without `change` the recording is taken as it is.
int estimate_program(int argc, char** argv, const RecordingChange& change = {});

}  // namespace tarmac::tools
