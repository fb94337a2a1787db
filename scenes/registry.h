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

/// Adding one: its own options alone (read_scene_options); what every kind has is added by the functions below.
struct SceneEntry {
  const char* name;  ///< kebab-case: "stand"
  const char* summary;
  Scene (*make)(const core::ConfigNode& options, std::uint64_t seed);
  /// The smooth base alone: what a motion needs, without building any mesh.
  std::shared_ptr<const Ground> (*ground)(const core::ConfigNode& options, std::uint64_t seed);
  std::vector<core::OptionDescription> (*describe)();
  std::string (*resolve)(const core::ConfigNode& options);  ///< all options written out as YAML, indented by 2
};

std::span<const SceneEntry* const> scenes();
/// The keys of a `scene:` block that every kind has.
const std::vector<std::string>& common_scene_keys();

/// A kind's own options from the scenario's `scene:` block {kind: NAME, ...options}. Throws InputError.
template <class Options>
Options read_scene_options(const core::ConfigNode& node) {
  Options options;
  node.read(options, common_scene_keys());
  return options;
}

/// The options that every kind has: `meshes:` and `actors:`.
std::vector<core::OptionDescription> describe_common_options();

/// `node` is the scenario's `scene:` block. Throws InputError (file, line, field) for unknown kinds or options.
const SceneEntry& scene_of(const core::ConfigNode& node);
Scene make_scene(const core::ConfigNode& node, std::uint64_t seed);
/// What a motion needs of it: no mesh is built.
std::shared_ptr<const Ground> make_ground(const core::ConfigNode& node, std::uint64_t seed);
/// The block with every option written out, indented by 2.
std::string resolve_scene(const core::ConfigNode& node);

}  // namespace tarmac::scenes
