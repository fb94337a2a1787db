/// What all beams of a sweep met, as arrays over its firings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/lidar/echo_train.h"
#include "sim/lidar/footprint.h"
#include "sim/raycast/tracer.h"

namespace tarmac::sim::lidar {

/// What the centre rays met.
struct CentreField {
  std::vector<double> t_m;        ///< relief included; 0 where nothing was met
  std::vector<float> relief_m;    ///< of that
  std::vector<float> x, y, z;     ///< where the macro surface was met, from the tracer's base, world axes [m]
  std::vector<float> nx, ny, nz;  ///< its normal
  std::vector<float> facing;      ///< cosine of incidence on the macro surface
  std::vector<float> cos_incidence;
  std::vector<std::uint32_t> instance;
  std::vector<std::uint16_t> material;  ///< 0 where nothing was met
  std::size_t size() const { return t_m.size(); }
  void resize(std::size_t n);
  /// Puts a batch's hits in at `first`.
  void keep(std::size_t first, const raycast::Rays& rays, const raycast::Hits& hits);
};

/// The echoes of every firing: the strongest one in arrays, the others in a list.
struct EchoField {
  std::vector<double> t_m;  ///< 0: no echo
  std::vector<float> signal, cos_incidence, nx, ny, nz;
  std::vector<std::uint32_t> instance;
  std::vector<ReturnKind> kind;
  struct Other {
    std::uint32_t firing, slot;  ///< slot: 1, 2, ... in the order of strength
    Echo echo;
  };
  std::vector<Other> others;  ///< by firing, then by slot
  std::size_t size() const { return t_m.size(); }
  void resize(std::size_t n);
  void put(std::size_t firing, const Echo& echo);
  Echo at(std::size_t firing) const;
};

/// Where a beam's surface may end or bend inside its footprint: towards neighbours that have met something else, or
/// that lie off its plane. Towards the others nothing can end that is wider than the way to them.
class Neighbours {
 public:
  /// `above` by channel.
  void set(const std::vector<Above>& above);
  /// open[i]: sides (bits of side::) on which firing i and its neighbour did not meet one plane, or both nothing. All
  /// of them on a material that `open_material` marks, and those on which the sweep has no neighbour.
  void look(const CentreField& field, const std::vector<std::uint8_t>& open_material,
            std::vector<std::uint8_t>& open) const;

 private:
  void look_up(const CentreField& field, std::vector<std::uint8_t>& open) const;
  std::vector<std::uint8_t> nothing_below_;  ///< by channel
  std::vector<Above> above_;
};

}  // namespace tarmac::sim::lidar
