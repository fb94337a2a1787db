/// What is left of states that have left the window: a Gaussian on those that remain.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace tarmac::estimators {

/// Eliminates the first `removed` unknowns of H x = -g: S = H_kk - H_kr H_rr^-1 H_rk, s = g_k - H_kr H_rr^-1 g_r.
/// H_rr is inverted on the space where its eigenvalues exceed 1e-12 of the largest. With threshold > 0, eigenvalues of S
/// below threshold x the largest are set to zero (and s projected). Source: Sibley, Matthies, Sukhatme, JFR 27(5) 2010.
struct Schur {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
};
Schur marginalise(const Eigen::Ref<const Eigen::MatrixXd>& H, const Eigen::Ref<const Eigen::VectorXd>& g, int removed,
                  double threshold);

}  // namespace tarmac::estimators
