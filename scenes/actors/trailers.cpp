#include "scenes/actors/trailers.h"

#include <cmath>

namespace tarmac::scenes {
namespace {

struct Coupling {
  Jet x_m, y_m;
};

/// Derivatives of the heading `theta` that the law gives where the coupling moves like this.
Jet law(const Coupling& h, double length_m, double theta) {
  Jet result{theta};
  // Each pass knows one derivative more of the heading, and so gives one more.
  for (int pass = 0; pass < 3; ++pass) {
    const SinCos direction = sin_cos(result);
    const Jet rate = (1 / length_m) * (direction.cos * derivative(h.y_m) - direction.sin * derivative(h.x_m));
    result = {theta, rate.f, rate.d1, rate.d2};
  }
  return result;
}

Jet step(const Jet& from, const Coupling& h, double length_m, double spacing) {
  Jet to = law(h, length_m, from.f + spacing * from.d1);
  constexpr int most = 50;  // each pass gains two digits where the spacing is a fiftieth of the link
  for (int pass = 0; pass < most; ++pass) {
    const double theta = from.f + spacing / 2 * (from.d1 + to.d1) + spacing * spacing / 10 * (from.d2 - to.d2) +
                         spacing * spacing * spacing / 120 * (from.d3 + to.d3);
    const bool settled = std::abs(theta - to.f) < 1e-15;
    to = law(h, length_m, theta);
    if (settled) break;
  }
  return to;
}

}  // namespace

TrailerChain::TrailerChain(const Leader& leader, const std::vector<Link>& links, double end_m, double spacing_m)
    : links_(links), headings_(links.size(), HermiteTable(spacing_m)) {
  const auto nodes = static_cast<std::size_t>(std::ceil(end_m / spacing_m)) + 1;
  for (std::size_t k = 0; k < nodes; ++k) {
    const double s_m = std::min(end_m, static_cast<double>(k) * spacing_m);
    PlanarJets body = leader(static_cast<double>(k) * spacing_m);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const SinCos before = sin_cos(body.heading);
      const Coupling coupling{body.x_m - links_[i].hitch_m * before.cos, body.y_m - links_[i].hitch_m * before.sin};
      const double length_m = links_[i].length_m;
      const Jet heading =
          k == 0 ? law(coupling, length_m, body.heading.f) : step(headings_[i].back(), coupling, length_m, spacing_m);
      headings_[i].append(heading);
      if (const double bend = std::abs(std::remainder(heading.f - body.heading.f, 2 * std::numbers::pi));
          bend > sharpest_.angle_rad)
        sharpest_ = {bend, s_m, i};
      const SinCos direction = sin_cos(heading);
      body = {coupling.x_m - length_m * direction.cos, coupling.y_m - length_m * direction.sin, heading};
    }
  }
}

PlanarPose TrailerChain::pose(std::size_t link, double s_m, const PlanarPose& leader) const {
  PlanarPose body = leader;
  for (std::size_t i = 0; i <= link; ++i) {
    const double theta = heading(i, s_m).f;
    body = {body.x_m - links_[i].hitch_m * std::cos(body.heading_rad) - links_[i].length_m * std::cos(theta),
            body.y_m - links_[i].hitch_m * std::sin(body.heading_rad) - links_[i].length_m * std::sin(theta), theta};
  }
  return body;
}

}  // namespace tarmac::scenes
