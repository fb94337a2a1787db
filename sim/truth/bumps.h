/// Single obstacles under the wheels: kerbs, drains, ramps, sills.
#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "sim/truth/paths.h"

namespace tarmac::sim::truth {

struct BumpOptions {
  std::string kind = "joint";
  double at_m = 0;
  double height_mm = 0;  ///< 0 until complete_bump() has filled in the kind's own
  double length_m = 0;   ///< the same
  std::string tracks = "both";
  void visit(core::OptionVisitor& v);
};

/// The names that `kind` takes.
std::vector<std::string> bump_kinds();
/// Fills in the kind's height and length where they are 0.
void complete_bump(BumpOptions& bump);

/// Heights under the left and the right track as functions of the distance. A bump is cos^4 over its length and the
/// tyre's contact patch, and a step (a kerb, a faulted joint) changes the level by smooth_step over the same; both have
/// continuous derivatives up to the third.
class Bumps {
 public:
  struct Heights {
    Jet left_m, right_m;  ///< with derivatives by distance
  };

  Bumps() = default;
  Bumps(const std::vector<BumpOptions>& bumps, double contact_m);
  bool empty() const { return bumps_.empty(); }
  /// Under an axle that has come to s.
  Heights at(double s_m) const;

 private:
  struct Bump {
    double at_m, height_m, length_m;
    bool step, left, right;
  };
  std::vector<Bump> bumps_;
};

}  // namespace tarmac::sim::truth
