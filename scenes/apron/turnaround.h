/// What stands around an aircraft on its stand: chocks, cones, loaders at the hold doors, trains of carts, ground
/// power, fuel, catering; on a remote stand stairs, a bus, people and the pushback tractor too.
#pragma once

#include <cstdint>
#include <string>

#include "core/random.h"
#include "scenes/aircraft/aircraft.h"
#include "scenes/apron/props.h"

namespace tarmac::scenes {

struct Turnaround {
  StandFrame frame;
  double half_width_m = 21;  ///< of the stand
  double density = 1;        ///< 1: a usual turnaround; 0: nothing but chocks; 2: whatever can be there is
  bool remote = false;       ///< stairs and bus in place of a bridge
  std::uint64_t stand = 0;   ///< number of the stand: the draws' index
};

void add_turnaround(Props& props, const AircraftType& type, const Turnaround& turnaround,
                    const core::RandomStream& random);
/// Equipment parked on a stand without an aircraft.
void add_empty_stand(Props& props, const Turnaround& turnaround, const core::RandomStream& random);

}  // namespace tarmac::scenes
