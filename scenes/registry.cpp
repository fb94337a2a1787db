#include "scenes/registry.h"

namespace tarmac::scenes {

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

}  // namespace tarmac::scenes
