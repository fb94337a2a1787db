/// Sums of residuals that look at the same unknowns, before they go into the whole system.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimators/window/banded_system.h"
#include "estimators/window/term.h"

namespace tarmac::estimators {

/// Normal equations of part of the residuals, in the order they came: neighbours in time mostly look at the same run of
/// the band and the same columns of the border, and are summed in a small dense matrix first. Parts are made in
/// parallel and added to the system one after the other, so that the sum's order is fixed.
class LocalSum {
 public:
  void clear();
  /// Adds a term with the weight that its loss gives (first order).
  void add(const Term& term);
  /// Adds y^T H y / 2 + g^T y with y = J_pose x[first...]; J has 6 rows.
  void add_pose(int first, const Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>& J, const core::Matrix6& H,
                const core::Vector6& g);
  void add_to(BandedSystem& system) const;
  double cost = 0;

 private:
  struct Part {
    int first = 0, count = 0;
    std::vector<int> columns;
    Eigen::MatrixXd H;  ///< lower triangle; has a few rows and columns more than g
    Eigen::VectorXd g;
  };
  Part& part(int first, int count, const Term* term);

  std::vector<Part> parts_;
};

}  // namespace tarmac::estimators
