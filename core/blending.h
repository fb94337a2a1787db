/// Weights of a B-spline's control points within one interval between knots, as polynomials.
///
/// Of a spline of order k (k = 4 is cubic) the interval [t_i, t_{i+1}) depends on k control points, and its weights on
/// the 2k - 2 knots t_{i-k+2} ... t_{i+k-1}. With u = (t - t_i)/(t_{i+1} - t_i), entry (m, j) of a blending matrix is
/// the coefficient of u^m in the weight of the interval's j-th control point. Source: the matrix form of de Boor's
/// recursion for any knots, Qin, The Visual Computer 16, 2000.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/time.h"

namespace tarmac::core {

inline constexpr int kMinSplineOrder = 4;
inline constexpr int kMaxSplineOrder = 6;

/// order x order
using BlendingMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxSplineOrder, kMaxSplineOrder>;

/// `knots`: the 2 order - 2 of the interval between the middle two. Any order from 1 to kMaxSplineOrder.
/// Throws InputError for another order, another number of knots, or knots that do not ascend.
BlendingMatrix blending_matrix(int order, std::span<const Time> knots);

/// Column j is the sum of the columns from j on: the weight of the step from control point j - 1 to j. The first column
/// is 1 exactly, since the weights add up to one.
BlendingMatrix cumulative(const BlendingMatrix& blending);

}  // namespace tarmac::core
