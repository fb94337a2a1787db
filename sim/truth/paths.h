/// The path and speed classes that the ego motion shares with the scene's actors (scenes/paths), by their names here.
#pragma once

#include "scenes/paths/jet.h"
#include "scenes/paths/path_options.h"
#include "scenes/paths/planar_path.h"
#include "scenes/paths/speed_profile.h"
#include "scenes/paths/waves.h"

namespace tarmac::sim::truth {

using scenes::chain;
using scenes::derivative;
using scenes::Jet;
using scenes::JitterOptions;
using scenes::PathPiece;
using scenes::PlanarPath;
using scenes::radians;
using scenes::sin_cos;
using scenes::SinCos;
using scenes::SpeedEvent;
using scenes::SpeedPlan;
using scenes::SpeedProfile;
using scenes::StartOptions;
using scenes::WanderOptions;
using scenes::Waves;

}  // namespace tarmac::sim::truth
