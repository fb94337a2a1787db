/// Ground that follows a centre line: a cross-section, a longitudinal profile, a plane and long waves.
#pragma once

#include <memory>

#include "scenes/paving/centre_line.h"
#include "scenes/paving/paving.h"
#include "scenes/paving/profile.h"

namespace tarmac::scenes {

struct SectionSpec {
  RoundedProfile across;                            ///< by d: crown, shoulders, slopes, ditches
  RoundedProfile along;                             ///< by s: ramps
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< of the plane they lie on, by world x and y
  double undulation_mm = 0;                         ///< as PavingSpec::undulation_mm
  std::string stream = "scenes/section";            ///< names of random draws begin with it
};

/// h(p) = across(d) + along(s) + slope . p + waves(p), (s, d) = the centre line's coordinates of p. C-infinity, with
/// exact gradient and Hessian, wherever (s, d) are (CentreLine::project): around a bend, `across` should be flat and
/// `along` level beyond the bend's centre.
class SectionGround final : public Ground {
 public:
  SectionGround(CentreLine line, const SectionSpec& spec, std::uint64_t seed);
  double height_m(double x_m, double y_m, Eigen::Vector2d* gradient = nullptr,
                  Eigen::Vector3d* hessian = nullptr) const override;
  const CentreLine& line() const { return line_; }

 private:
  CentreLine line_;
  RoundedProfile across_, along_;
  Eigen::Vector2d slope_;
  WavyGround waves_;
};

}  // namespace tarmac::scenes
