/// The cross-section of a taxiway: crown, shoulders, graded grass, ditch.
#pragma once

#include <memory>
#include <vector>

#include "scenes/paving/section_ground.h"
#include "scenes/taxiway/code_letter.h"
#include "scenes/taxiway/options.h"

namespace tarmac::scenes {

/// Distances from the centre line [m].
struct TaxiwaySection {
  double edge_m;      ///< of the taxiway
  double shoulder_m;  ///< of its shoulder
  double graded_m;    ///< where the ditch begins
  double swale_m;     ///< the ditch's bottom
  double outer_m;     ///< from here on level: the same for a neighbour at the code's separation
};
TaxiwaySection taxiway_section(const TaxiwayCode& code);

/// Main taxiway on the centre line, the parallel one to its right.
class TaxiwayLayout {
 public:
  explicit TaxiwayLayout(const TaxiwayOptions& options);
  const TaxiwayCode& code() const { return *code_; }
  const TaxiwaySection& section() const { return section_; }
  const CentreLine& line() const { return line_; }
  /// Lateral places of the taxiways' centre lines.
  const std::vector<double>& taxiways_d_m() const { return taxiways_d_m_; }
  /// Where the bend begins and ends along the line; equal where there is none.
  double bend_begin_m() const { return bend_begin_m_; }
  double bend_end_m() const { return bend_end_m_; }
  std::shared_ptr<const SectionGround> ground(const TaxiwayOptions& options, std::uint64_t seed) const;

 private:
  const TaxiwayCode* code_;
  TaxiwaySection section_;
  std::vector<double> taxiways_d_m_;
  CentreLine line_;
  double bend_begin_m_, bend_end_m_;
};

}  // namespace tarmac::scenes
