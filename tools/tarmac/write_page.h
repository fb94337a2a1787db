/// Gathers what runs left behind and has the report written.
#pragma once

#include <filesystem>
#include <vector>

#include "tools/tarmac/console.h"
#include "tools/tarmac/layout.h"

namespace tarmac::tools {

/// The page of one or several runs of one scenario. Throws InputError when they are of different scenarios.
void write_page(const std::vector<RunFolder>& runs, const std::filesystem::path& html_file, const Console& console);

}  // namespace tarmac::tools
