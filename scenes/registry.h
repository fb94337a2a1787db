/// Scenes by name. Adding one: a folder, and one line in scenes/CMakeLists.txt.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

struct SceneEntry {
  const char* name;     ///< kebab-case: "stand"
  const char* summary;
  Scene (*make)(const core::ConfigNode& options, std::uint64_t seed);
  /// The smooth base alone: what a motion needs, without building any mesh.
  std::shared_ptr<const Ground> (*ground)(const core::ConfigNode& options, std::uint64_t seed);
  std::vector<core::OptionDescription> (*describe)();
  std::string (*resolve)(const core::ConfigNode& options);  ///< all options written out as YAML, indented by 2
};

std::span<const SceneEntry* const> scenes();
/// `node` is the scenario's `scene:` block: {kind: NAME, ...options}. Throws InputError for unknown kinds or options.
const SceneEntry& scene_of(const core::ConfigNode& node);
inline Scene make_scene(const core::ConfigNode& node, std::uint64_t seed) { return scene_of(node).make(node, seed); }

}  // namespace tarmac::scenes
