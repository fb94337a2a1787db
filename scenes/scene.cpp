#include "scenes/scene.h"

namespace tarmac::scenes {

const char* name_of(Label label) {
  switch (label) {
    case Label::none:
      return "none";
    case Label::pavement:
      return "pavement";
    case Label::marking:
      return "marking";
    case Label::building:
      return "building";
    case Label::glass:
      return "glass";
    case Label::jet_bridge:
      return "jet_bridge";
    case Label::aircraft:
      return "aircraft";
    case Label::mast:
      return "mast";
    case Label::ground_equipment:
      return "ground_equipment";
    case Label::cone:
      return "cone";
    case Label::vehicle:
      return "vehicle";
    case Label::vegetation:
      return "vegetation";
    case Label::person:
      return "person";
    case Label::other:
      return "other";
    case Label::own_body:
      return "own_body";
    case Label::sign:
      return "sign";
    case Label::light:
      return "light";
    case Label::tree:
      return "tree";
    case Label::terrain:
      return "terrain";
  }
  return "unknown";
}

std::size_t Scene::triangle_count() const {
  std::size_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].triangles.size();
  return count;
}

}  // namespace tarmac::scenes
