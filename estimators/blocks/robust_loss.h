/// Robust losses on squared residuals.
#pragma once

#include <string>

namespace tarmac::estimators {

enum class Loss { standard, cauchy, huber, tolerant, truncated, geman_mcclure, dcs };

/// Throws std::invalid_argument for another name than standard, cauchy, huber, tolerant, truncated, geman-mcclure, dcs.
Loss loss_named(const std::string& name);

/// The cost of a residual r is rho(s) / 2 with s = r^2; a normal equation weights it by drho/ds.
///   standard   rho = s
///   cauchy     rho = c^2 log(1 + s / c^2)
///   huber      rho = s up to c^2, 2 c sqrt(s) - c^2 beyond
///   tolerant   rho = c log(1 + exp((s - t) / c)) less its value at 0: nearly flat below s = t, where c sets how
///   sharply
///              it turns; both are in the unit of s, as Ceres has it
///   truncated  rho = min(s, c^2)
///   geman-mcclure  rho = c^2 s / (c^2 + s)
///   dcs        rho = s up to c^2, 3 c^2 - 4 c^4 / (c^2 + s) beyond (dynamic covariance scaling)
struct RobustLoss {
  Loss kind = Loss::standard;
  double scale = 0.1;       ///< c, above 0
  double tolerance = 0.05;  ///< t, of tolerant only

  struct Value {
    double rho = 0, first = 1, second = 0;  ///< rho and its derivatives by s
  };
  Value operator()(double s) const;
};

}  // namespace tarmac::estimators
