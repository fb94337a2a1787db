/// The plane through a handful of points, and how plane they are.
#pragma once

#include <Eigen/Core>

#include "estimators/blocks/nearest_points.h"

namespace tarmac::estimators {

/// Eigenvalues of a symmetric 3x3 matrix in ascending order, with the unit eigenvector of the smallest.
struct SmallestEigen {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::UnitZ();
};

/// Closed form (trigonometric roots of the characteristic polynomial, the eigenvector as the largest cross product of
/// two rows; the smallest value once more as its Rayleigh quotient). Relative to the largest eigenvalue, values are
/// good to about 1e-8 and better where they are well apart; a vector is as good as its eigenvalue is apart from the
/// next. Equal eigenvalues give some unit vector of their space. Source: O. K. Smith, Eigenvalues of a symmetric 3x3
/// matrix, CACM 4(4) 1961.
SmallestEigen smallest_eigen(const Eigen::Matrix3d& symmetric);

struct PlaneFit {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();   ///< in the points' coordinates
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length, either way round
  double planarity = 0;  ///< a2D = (sqrt l2 - sqrt l3) / sqrt l1 in [0, 1], l1 >= l2 >= l3; 0 for coinciding points
};

/// Normal of the direction of least spread. Needs at least 3 points; fewer give planarity 0.
/// Source: Dellenbach et al., ICRA 2022, section III; Demantke et al. 2011 for the planarity.
PlaneFit fit_plane(const NearestPoints& points);

}  // namespace tarmac::estimators
