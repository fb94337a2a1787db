/// Pavement relief: a height field over a macro surface, met after tracing.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace tarmac::sim::raycast {

struct ReliefHit {
  double t_m = 0;            ///< where the ray meets the relief
  double cos_incidence = 0;  ///< with the relief's own normal
};

/// Rays that have met a macro surface with relief, as arrays of equal length. The ray o + t d (world axes, |d| = 1)
/// meets the macro plane at t_macro in p; n is the plane's unit normal, turned towards the sensor. With h the height
/// over the plane along that normal, what is sought is a root of
///   f(s) = s n'd - h(x(s), y(s))          f'(s) = n'd - grad h' (dx, dy)          s = t - t_macro
/// One Newton step from t_macro settles smooth texture seen from above. Where the step leaves more than 50 micrometres
/// of height it is repeated, inside a bracket, so that the result always lies on the relief. Steps are taken for all
/// rays at once, in single precision: s is centimetres long and counts from p, which is double.
///
/// At grazing incidence a ray may cross the relief several times; the crossing found is near t_macro and need not be
/// the first, for crests do not shade the troughs behind them. Below |n'd| = 0.01 (0.6 degrees) that question has no
/// useful answer within a millimetre of height, and the macro surface is kept.
class ReliefBatch {
 public:
  static bool applies(double nd) { return nd <= -0.01; }

  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }
  void reserve(std::size_t count);
  /// Needs reserve() beforehand; n'd as applies() wants it.
  void push_back(double px_m, double py_m, float dx, float dy, float nx, float ny, float nz, float nd) {
    px_m_[size_] = px_m, py_m_[size_] = py_m;
    dx_[size_] = dx, dy_[size_] = dy;
    nx_[size_] = nx, ny_[size_] = ny, nz_[size_] = nz, nd_[size_] = nd;
    ++size_;
  }
  /// A ray that a Newton step moves by less than `settled_m` is taken to be there, without another look: with texture
  /// that bends by less than 20 per metre, 1 mm leaves 10 micrometres of height. 0: every ray is looked at again.
  void solve(const scenes::Relief& relief, float settled_m = 0);
  /// Results, ray by ray: s [m], and the cosine of incidence with the relief's own normal.
  const float* s_m() const { return s_out_.data(); }
  const float* cos_incidence() const { return cosine_.data(); }

 private:
  void solve_block(const scenes::Relief& relief, float settled_m, std::size_t first, std::size_t count);
  std::size_t compact(std::size_t first, std::size_t count, std::size_t active);

  std::size_t size_ = 0;
  std::vector<double> px_m_, py_m_;
  std::vector<float> dx_, dy_, nx_, ny_, nz_, nd_;
  std::vector<float> s_out_, slope_x_out_, slope_y_out_, cosine_;
  // Of one block: the rays that still iterate, moved up as others finish.
  std::vector<std::uint32_t> ray_, done_, kept_;
  std::vector<double> ax_m_, ay_m_, x_m_, y_m_;
  std::vector<float> adx_, ady_, and_, s_, above_, below_, highest_m_, retreat_, height_m_, slope_x_, slope_y_;
};

/// One ray, as above, with the macro surface where the relief does not apply.
ReliefHit meet_relief(const scenes::Relief& relief, const Eigen::Vector3d& p_macro_world,
                      const Eigen::Vector3d& direction, const Eigen::Vector3d& normal, double t_macro_m);

}  // namespace tarmac::sim::raycast
