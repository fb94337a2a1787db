/// Panes: what they let through, what they mirror.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scenes/scene.h"
#include "sim/lidar/echo_train.h"
#include "sim/lidar/effects/echoes.h"
#include "sim/raycast/tracer.h"

namespace tarmac::sim::lidar {

/// Shares of energy of a pane at an angle of incidence.
struct PaneShares {
  double reflected = 0, transmitted = 0;
};
/// Unpolarised, both faces, of clear float glass (n = 1.52; Fresnel): R = 2 r / (1 + r) of each polarisation with the
/// face's r, T = 1 - R.
PaneShares clear_pane(double cos_incidence);
/// Of a material with transmission > 0. Square on it reflects R0 = 2 F0 / (1 + F0), two faces of its specular_f0, and
/// lets `transmission` through; with the angle both go as clear glass does:
///   R = R0 + (1 - R0) (Rc - Rc(0)) / (1 - Rc(0)),   T = transmission Tc / Tc(0).
PaneShares pane_shares(const scenes::Material& material, double cos_incidence);

/// Rays that have met a pane, and what comes back through it. Each is one of the rays of a beam.
struct PaneRays {
  raycast::Rays rays;
  std::vector<std::uint32_t> beam;  ///< the caller's number of the beam that the ray is part of
  std::vector<std::uint16_t> ray;   ///< of the footprint
  std::vector<double> weight;       ///< of the ray in the beam
  std::vector<double> t_m;          ///< where the pane was met
  std::vector<float> nx, ny, nz;    ///< of the pane, against the ray
  std::vector<std::uint16_t> material;
  std::size_t size() const { return beam.size(); }
  void clear();
};

struct PartOfBeam {
  std::uint32_t beam;
  Part part;
};

/// Follows rays beyond panes (straight on: a pane's thickness is not known, and it would shift them by millimetres) and
/// off them, and adds what they meet:
///   transmitted   from behind, weakened by T^2 of every pane on the way (up to three)
///   dirt, glint   of a second or third pane, weakened by the ones before
///   ghost         what the first pane mirrors, weakened by R^2: at the folded way's length, along the ray that left
/// A pane in the mirror shows its dirt and its glint only.
class Glass {
 public:
  Glass(const std::vector<scenes::Material>& materials, bool ghosts, const Reflectance& reflectance);
  bool is_pane(std::uint16_t material) const { return pane_[material] != 0; }
  /// Its own return: glint where its mirror gives more than the dirt on it.
  ReturnKind own_kind(std::uint16_t material, float signal, float cos_incidence) const;
  /// Returns how many rays it traced.
  std::size_t follow(const raycast::SweepTracer& tracer, const PaneRays& first, std::vector<PartOfBeam>& parts) const;

 private:
  struct Path;
  void meet(const raycast::SweepTracer& tracer, std::vector<Path>& paths, std::vector<PartOfBeam>& parts) const;

  std::vector<scenes::Material> materials_;
  std::vector<std::uint8_t> pane_;
  bool ghosts_;
  Reflectance reflectance_;
};

/// Materials as a beam of that width sees them, with panes that are not quite flat:
///   ggx_alpha^2 of panes + (divergence / 2)^2 + flatness^2.
std::vector<scenes::Material> seen_by_a_beam(std::vector<scenes::Material> materials, double divergence_rad,
                                             double flatness_rad);

}  // namespace tarmac::sim::lidar
