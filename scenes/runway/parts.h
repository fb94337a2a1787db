/// Parts of the runway crossing in world coordinates.
#pragma once

#include "scenes/primitives/mesh_builder.h"
#include "scenes/runway/layout.h"

namespace tarmac::scenes {

Mesh make_runway_markings(const RunwayLayout& layout, const Ground& ground);

}  // namespace tarmac::scenes
