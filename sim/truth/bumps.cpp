#include "sim/truth/bumps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/paths/smooth_step.h"

namespace tarmac::sim::truth {

namespace {

struct Kind {
  const char* name;
  double height_mm, length_m;
  bool step;
};

/// Ordinary figures of aprons and service roads; heights and lengths from the middle of what is found there.
constexpr Kind kinds[] = {
    {"joint", -6, 0.04, false},  {"faulted-joint", 4, 0.02, true}, {"drain", -10, 0.18, false},
    {"manhole", 15, 0.7, false}, {"cable-ramp", 60, 0.5, false},   {"hump", 65, 0.8, false},
    {"kerb", -20, 0.05, true},   {"door-sill", 20, 0.1, false},    {"rail", -15, 0.06, false},
};

const Kind& kind_of(const BumpOptions& bump) {
  return *std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind& k) { return bump.kind == k.name; });
}

/// 0 at a distance of length / 2 from the middle, 1 in the middle.
Jet hill(double x_m, double length_m) {
  if (std::abs(x_m) >= length_m / 2) return {};
  const double k = std::numbers::pi / length_m, c = std::cos(k * x_m), s = std::sin(k * x_m);
  const double c2 = c * c, s2 = s * s;
  return {c2 * c2, -4 * k * c2 * c * s, k * k * (12 * c2 * s2 - 4 * c2 * c2),
          k * k * k * (40 * c2 * c * s - 24 * c * s2 * s)};
}

Jet step(double x_m, double length_m) {
  const Jet h = scenes::smooth_step(x_m / length_m + 0.5);
  return {h.f, h.d1 / length_m, h.d2 / (length_m * length_m), h.d3 / (length_m * length_m * length_m)};
}

}  // namespace

std::vector<std::string> bump_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) names.emplace_back(kind.name);
  return names;
}

void BumpOptions::visit(core::OptionVisitor& v) {
  v.choice("kind", kind, bump_kinds(), "what it is; kerb and faulted-joint change the level for good");
  v("at_m", at_m, "distance along the path at which the rear axle is in its middle", {.at_least = 0});
  v("height_mm", height_mm, "height, below 0 a dip (0: that of the kind)", {.at_least = -150, .at_most = 150});
  v("length_m", length_m, "length along the path, without the tyre's contact patch (0: that of the kind)",
    {.at_least = 0, .at_most = 20});
  v.choice("tracks", tracks, {"both", "left", "right"}, "which wheels meet it");
}

void complete_bump(BumpOptions& bump) {
  const Kind& kind = kind_of(bump);
  if (bump.height_mm == 0) bump.height_mm = kind.height_mm;
  if (bump.length_m == 0) bump.length_m = kind.length_m;
}

Bumps::Bumps(const std::vector<BumpOptions>& bumps, double contact_m) {
  for (BumpOptions bump : bumps) {
    complete_bump(bump);
    bumps_.push_back({bump.at_m, bump.height_mm / 1000, bump.length_m + contact_m, kind_of(bump).step,
                      bump.tracks != "right", bump.tracks != "left"});
  }
}

Bumps::Heights Bumps::at(double s_m) const {
  Heights sum;
  for (const Bump& bump : bumps_) {
    const double x_m = s_m - bump.at_m;
    if (x_m <= -bump.length_m / 2) continue;
    const Jet height = bump.height_m * (bump.step ? step(x_m, bump.length_m) : hill(x_m, bump.length_m));
    if (bump.left) sum.left_m = sum.left_m + height;
    if (bump.right) sum.right_m = sum.right_m + height;
  }
  return sum;
}

}  // namespace tarmac::sim::truth
