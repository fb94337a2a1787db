/// From the names of materials in a mesh file to materials of the scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenes/meshes/mesh_file.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// One index into scene.materials for each of file.names (one alone when nothing is named). For a name, in this order:
/// what `materials:` says of it; `material:`; the material of the table that has this very name. A name that none of
/// them covers, an unknown material and a key of `materials:` that the file does not have are errors. Materials given
/// by values are appended to scene.materials.
std::vector<std::uint16_t> map_materials(const core::ConfigNode& entry, const MeshFile& file, Scene& scene,
                                         const std::filesystem::path& path);

/// Both keys written out with all values, `indent` spaces before each line; "" where neither is given.
std::string resolve_materials(const core::ConfigNode& entry, int indent);

}  // namespace tarmac::scenes
