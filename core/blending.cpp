#include "core/blending.h"

#include <fmt/format.h>

#include "core/error.h"

namespace tarmac::core {
namespace {

void check(int order, std::span<const Time> knots) {
  if (order < 1 || order > kMaxSplineOrder) {
    throw InputError(fmt::format("a spline's order is 1 to {}, not {}", kMaxSplineOrder, order));
  }
  const auto needed = static_cast<std::size_t>(2 * std::max(order, 2) - 2);
  if (knots.size() != needed) {
    throw InputError(
        fmt::format("an interval of a spline of order {} needs {} knots, not {}", order, needed, knots.size()));
  }
  for (std::size_t i = 1; i < knots.size(); ++i) {
    if (knots[i] <= knots[i - 1]) {
      throw InputError(fmt::format("knot {} at {} ns does not come after the one before at {} ns", i, to_ns(knots[i]),
                                   to_ns(knots[i - 1])));
    }
  }
}

/// Differences of knots are taken in nanoseconds, so that nothing is lost far from time zero.
double difference(Time later, Time earlier) {
  return static_cast<double>((later - earlier).count());
}

}  // namespace

/// M_q = [M_{q-1}; 0] A + [0; M_{q-1}] B with A and B bidiagonal, in d0 = (t_i - t_j)/(t_{j+q-1} - t_j) and
/// d1 = (t_{i+1} - t_i)/(t_{j+q-1} - t_j).
BlendingMatrix blending_matrix(int order, std::span<const Time> knots) {
  check(order, knots);
  BlendingMatrix M = BlendingMatrix::Ones(1, 1);
  if (order == 1) return M;
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(i)]; };
  const Time begin = knot(order - 2), end = knot(order - 1);
  for (int q = 2; q <= order; ++q) {
    BlendingMatrix next = BlendingMatrix::Zero(q, q);
    for (int r = 0; r < q - 1; ++r) {
      const int j = order - q + r;
      const double width = difference(knot(j + q - 1), knot(j));
      const double d0 = difference(begin, knot(j)) / width, d1 = difference(end, begin) / width;
      next.col(r).head(q - 1) += (1 - d0) * M.col(r);
      next.col(r + 1).head(q - 1) += d0 * M.col(r);
      next.col(r).tail(q - 1) -= d1 * M.col(r);
      next.col(r + 1).tail(q - 1) += d1 * M.col(r);
    }
    M = next;
  }
  return M;
}

BlendingMatrix cumulative(const BlendingMatrix& blending) {
  BlendingMatrix C = blending;
  for (Eigen::Index j = C.cols() - 2; j >= 0; --j) C.col(j) += C.col(j + 1);
  C.col(0).setZero();
  C(0, 0) = 1;
  return C;
}

}  // namespace tarmac::core
