/// What drives a vehicle's suspension: where the wheels would put the body, and how far accelerations tilt it.
#pragma once

#include <array>
#include <memory>

#include "scenes/scene.h"
#include "sim/truth/course.h"
#include "sim/truth/drive_options.h"
#include "sim/truth/road.h"
#include "sim/truth/suspension.h"

namespace tarmac::sim::truth {

class Excitation {
 public:
  Excitation(const SuspensionOptions& vehicle, Road road, std::shared_ptr<const scenes::Ground> ground);

  const std::array<Suspension::Oscillator, 3>& oscillators() const { return oscillators_; }

  struct Input {
    std::array<Jet, 3> wheels;  ///< per mode, with two derivatives by time
    std::array<Jet, 3> load;    ///< steady answer to accelerations, with one derivative
  };
  Input at(const Planar& p) const;

  /// F of the suspension: w^2 (wheels + load) + 2 zeta w d(wheels)/dt: spring and damper stand on the wheels.
  std::array<Jet, 3> forcing(const Planar& p) const;

 private:
  void add_ground(const Planar& p, std::array<Jet, 3>& wheels) const;

  SuspensionOptions vehicle_;
  Road road_;
  std::shared_ptr<const scenes::Ground> ground_;
  std::array<Suspension::Oscillator, 3> oscillators_;
};

/// Heave, pitch and roll over [0, end_s], in balance at t = 0. The answer goes on asking both when it is asked.
Suspension solve_suspension(std::shared_ptr<const Course> course, std::shared_ptr<const Excitation> excitation,
                            double end_s, const Suspension::Visitor& visit);

/// How the body moves forward on its wheels, mode 0 of what is returned (the others are nothing): x'' + 2 zeta w x' +
/// w^2 x = -a_forward. It is what jerks back when a hard stop ends.
Suspension solve_surge(std::shared_ptr<const Course> course, const Suspension::Oscillator& surge, double end_s);

}  // namespace tarmac::sim::truth
