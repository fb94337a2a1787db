/// `tarmac describe KIND NAME -o FILE`: one picture, or a contact sheet of all of a kind.
#pragma once

#include "tools/tarmac/commands.h"

namespace tarmac::tools {

/// Throws core::InputError where the arguments ask for no possible picture (cheap: nothing is built).
void check_picture(const DescribeArguments& arguments);
/// `arguments.kind` is singular; `name` may be "all" for scene, aircraft and equipment.
void draw_picture(const DescribeArguments& arguments);

}  // namespace tarmac::tools
