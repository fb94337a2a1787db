/// `tarmac export --format exr`.
#pragma once

#include "tools/tarmac/commands.h"
#include "tools/tarmac/console.h"

namespace tarmac::tools {

/// Writes sweeps as images: `to`/000000.exr and so on by their indices, or the one file `to` for one sweep. Returns 0.
int export_images(const TransferArguments& arguments, const Console& console);

}  // namespace tarmac::tools
