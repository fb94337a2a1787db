#include "scenes/paving/section_ground.h"

#include <algorithm>
#include <utility>

namespace tarmac::scenes {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

PavingSpec waves_of(const SectionSpec& spec) {
  PavingSpec paving;
  paving.crossfall_percent = 0;
  paving.undulation_mm = spec.undulation_mm;
  paving.stream = spec.stream;
  return paving;
}

}  // namespace

SectionGround::SectionGround(CentreLine line, const SectionSpec& spec, std::uint64_t seed)
    : line_(std::move(line)),
      across_(spec.across),
      along_(spec.along),
      slope_(spec.slope),
      waves_(waves_of(spec), seed) {}

double SectionGround::height_m(double x_m, double y_m, Vector2d* gradient, Eigen::Vector3d* hessian) const {
  const Vector2d p(x_m, y_m);
  const CentreLine::Place place = line_.project(p);
  const RoundedProfile::Value across = across_.at(place.d_m), along = along_.at(place.s_m);
  const double waves = waves_.height_m(x_m, y_m, gradient, hessian);
  if (gradient != nullptr || hessian != nullptr) {
    //   grad d = n                  Hess d = -k/(1 - k d) t t'
    //   grad s = t / (1 - k d)      Hess s = [k (n t' + t n') + k' d/(1 - k d) t t'] / (1 - k d)^2
    // with t, n, the curvature k and its change k' at the foot of the perpendicular (Frenet's formulas).
    const Vector2d& t = place.foot.tangent;
    const Vector2d& n = place.foot.left;
    const double k = place.foot.curvature_per_m;
    const double stretch = std::max(1 - k * place.d_m, 0.02);  // at a bend's centre, where the profiles are flat
    const Vector2d grad_s = t / stretch;
    if (gradient != nullptr) *gradient += across.grade * n + along.grade * grad_s + slope_;
    if (hessian != nullptr) {
      const Matrix2d hess_d = -k / stretch * t * t.transpose();
      const Matrix2d hess_s = (k * (n * t.transpose() + t * n.transpose()) +
                               place.foot.curvature_change_per_m2 * place.d_m / stretch * t * t.transpose()) /
                              (stretch * stretch);
      const Matrix2d sum = across.curvature_per_m * n * n.transpose() + across.grade * hess_d +
                           along.curvature_per_m * grad_s * grad_s.transpose() + along.grade * hess_s;
      *hessian += Eigen::Vector3d(sum(0, 0), sum(0, 1), sum(1, 1));
    }
  }
  return across.z_m + along.z_m + slope_.dot(p) + waves;
}

}  // namespace tarmac::scenes
