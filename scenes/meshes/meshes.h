/// Users' own meshes: `scene: {kind: ANY, meshes: [{file: hangar.ply, ...}]}`. Options: docs/scenes.md.
#pragma once

#include <string>
#include <vector>

#include "core/config.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// Reads the files that `list` (the scene's `meshes:` block; absent = none) names and adds each to the scene as a mesh
/// and an instance of its own. Throws core::InputError with the scenario's line and the mesh file's name.
void add_meshes(Scene& scene, const core::ConfigNode& list);

/// Checks everything but the files' content and writes the block out, indented by 2: absolute paths, and a hash of each
/// file's bytes by which a later run sees that it has changed. "" when there are no meshes.
std::string resolve_meshes(const core::ConfigNode& list);

/// For `tarmac describe scene`.
std::vector<core::OptionDescription> describe_meshes();

}  // namespace tarmac::scenes
