/// `tarmac describe KIND NAME -o FILE`: one picture, or a contact sheet of all of a kind.
#pragma once

#include "tools/tarmac/commands.h"

namespace tarmac::tools {

/// `arguments.kind` is singular; `name` may be "all" for scene, aircraft and equipment.
void draw_picture(const DescribeArguments& arguments);

}  // namespace tarmac::tools
