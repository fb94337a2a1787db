/// Gaussian processes to try things on.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "core/gp_trajectory.h"
#include "core/random.h"

namespace tarmac::tests {

struct GpCase {
  std::string name;
  core::GpModel model = core::GpModel::wnoa;
  core::Vector6 rate = core::Vector6::Zero();

  core::GpPrior prior() const {
    core::GpPrior p;
    p.model = model;
    p.qc << 2, 1, 0.5, 0.3, 0.7, 1.1;
    p.rate = rate;
    return p;
  }
};
inline void PrintTo(const GpCase& c, std::ostream* out) {
  *out << c.name;
}

inline std::vector<GpCase> every_gp() {
  core::Vector6 mixed;
  mixed << 0, 0, 0.3, 4, 100, 100;  // wnoj beside decay far below and far above the knots' spacing
  return {{"wnoa", core::GpModel::wnoa},
          {"wnoj", core::GpModel::wnoj},
          {"singer", core::GpModel::singer, core::Vector6::Constant(7)},
          {"singer_mixed", core::GpModel::singer, mixed}};
}

inline core::Vector6 random6(const core::RandomStream& stream, std::uint64_t i) {
  core::Vector6 v;
  for (std::uint32_t k = 0; k < 6; ++k) v[k] = stream.normal(i, k);
  return v;
}

/// Knots 0.1 s apart, each turned against its predecessor by that angle about a random axis; velocities of order one,
/// derivatives of order ten, nothing consistent.
inline core::GpTrajectory random_gp(const core::GpPrior& prior, std::uint64_t seed, int knots, double angle_rad) {
  const core::RandomStream stream(seed, "test/random_gp");
  std::vector<core::GpKnot> out;
  core::SE3 T = core::se3::exp(random6(stream, 1000));
  for (int i = 0; i < knots; ++i) {
    const auto j = static_cast<std::uint64_t>(i);
    core::GpKnot knot;
    knot.t = core::time_from_ns(100'000'000LL * i);
    knot.T_world_body = T;
    knot.varpi = 2 * random6(stream, 4 * j);
    knot.dvarpi = 10 * random6(stream, 4 * j + 1);
    out.push_back(knot);
    core::Vector6 xi = 0.3 * random6(stream, 4 * j + 2);
    xi.tail<3>() *= angle_rad / xi.tail<3>().norm();
    T = core::se3::normalized(T * core::se3::exp(xi));
  }
  return {prior, out};
}

}  // namespace tarmac::tests
