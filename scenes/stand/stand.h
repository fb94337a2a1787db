/// One airside stand with an A320 nosed in, its neighbours' markings and the buildings around. Layout: README.md.
#pragma once

#include "scenes/registry.h"
#include "scenes/stand/options.h"

namespace tarmac::scenes {

Scene make_stand(const StandOptions& options, std::uint64_t seed);

}  // namespace tarmac::scenes
