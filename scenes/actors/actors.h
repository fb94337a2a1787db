/// What moves in a scene: the `actors:` list of any kind of scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/config.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

/// Adds the actors of the scenario's `scene:` block to the scene that its kind has made. Throws InputError (file, line)
/// for paths and timetables that cannot be.
void add_actors(const core::ConfigNode& scene_node, Scene& scene);
/// The list with every option written out, indented by 2; empty when there is none.
std::string resolve_actors(const core::ConfigNode& scene_node);

/// What `tarmac list actors` and `tarmac describe actor KIND` show.
struct ActorKindSummary {
  std::string name, summary;
};
std::vector<ActorKindSummary> actor_summaries();
/// Throws InputError for a kind that there is not.
std::vector<core::OptionDescription> describe_actor(const std::string& kind);

}  // namespace tarmac::scenes
