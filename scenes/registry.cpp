#include "scenes/registry.h"

#include "scenes/actors/actors.h"
#include "scenes/meshes/meshes.h"

namespace tarmac::scenes {

const std::vector<std::string>& common_scene_keys() {
  static const std::vector<std::string> keys{"kind", "meshes", "actors"};
  return keys;
}

std::vector<core::OptionDescription> describe_common_options() {
  std::vector<core::OptionDescription> options = describe_meshes();
  options.push_back({"actors[]", "block", "", "", "what moves; kinds and their options: tarmac list actors"});
  return options;
}

const SceneEntry& scene_of(const core::ConfigNode& node) {
  const core::ConfigNode kind = node.child("kind");
  const std::string name = kind.scalar("kind");
  std::vector<std::string> names;
  for (const SceneEntry* entry : scenes()) {
    if (name == entry->name) return *entry;
    names.emplace_back(entry->name);
  }
  std::string message = "there is no scene '" + name + "'; allowed:";
  for (const std::string& known : names) message += " " + known;
  if (const std::string meant = core::did_you_mean(name, names); !meant.empty())
    message += "; did you mean " + meant + "?";
  kind.fail(message);
}

Scene make_scene(const core::ConfigNode& node, std::uint64_t seed) {
  Scene scene = scene_of(node).make(node, seed);
  add_meshes(scene, node.child("meshes"));
  add_actors(node, scene);
  return scene;
}

std::shared_ptr<const Ground> make_ground(const core::ConfigNode& node, std::uint64_t seed) {
  return scene_of(node).ground(node, seed);
}

std::string resolve_scene(const core::ConfigNode& node) {
  return scene_of(node).resolve(node) + resolve_meshes(node.child("meshes")) + resolve_actors(node);
}

}  // namespace tarmac::scenes
