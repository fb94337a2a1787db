#include "scenes/stand/ground.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "scenes/stand/layout.h"

namespace tarmac::scenes {

namespace {

constexpr double tau = 2 * std::numbers::pi;

/// Without the call that std::floor costs on a processor that is not known to round in one instruction.
inline int floor_to_int(double x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < truncated ? 1 : 0);
}

}  // namespace

StandGround::StandGround(const StandOptions& options, std::uint64_t seed)
    : crossfall_(options.crossfall_percent / 100) {
  // Shorter waves are lower: roughly constant slope, as of a graded surface.
  constexpr std::array<double, 6> wavelength_m{90, 61, 38, 24, 14, 9};
  constexpr std::array<double, 6> share{1, 0.6, 0.3, 0.14, 0.05, 0.025};
  const core::RandomStream random(seed, "scenes/stand/ground");
  for (std::size_t k = 0; k < waves_.size(); ++k) {
    const double direction = tau * random.uniform(k, 0);
    const double wave_number = tau / wavelength_m[k];
    waves_[k] = {options.undulation_mm * 1e-3 * share[k], wave_number * std::cos(direction),
                 wave_number * std::sin(direction), tau * random.uniform(k, 1)};
  }
}

double StandGround::height_m(double x_m, double y_m, Eigen::Vector2d* gradient, Eigen::Vector3d* hessian) const {
  double height = crossfall_ * (y_m - layout::corridor_north_y_m);
  Eigen::Vector2d g(0, crossfall_);
  Eigen::Vector3d h = Eigen::Vector3d::Zero();
  for (const Wave& w : waves_) {
    const double phase = w.kx_per_m * x_m + w.ky_per_m * y_m + w.phase_rad;
    const double s = w.amplitude_m * std::sin(phase);
    height += s;
    if (gradient) g += w.amplitude_m * std::cos(phase) * Eigen::Vector2d(w.kx_per_m, w.ky_per_m);
    h -= s * Eigen::Vector3d(w.kx_per_m * w.kx_per_m, w.kx_per_m * w.ky_per_m, w.ky_per_m * w.ky_per_m);
  }
  if (gradient) *gradient = g;
  if (hessian) *hessian = h;
  return height;
}

GroundBounds StandGround::bounds() const {
  GroundBounds bounds{std::abs(crossfall_), 0, 0};
  for (const Wave& w : waves_) {
    const double k = std::hypot(w.kx_per_m, w.ky_per_m);
    bounds.slope += w.amplitude_m * k;
    bounds.curvature_per_m += w.amplitude_m * k * k;
    bounds.third_per_m2 += w.amplitude_m * k * k * k;
  }
  return bounds;
}

SlabGrid::SlabGrid(const StandOptions& options)
    : origin_m(layout::apron_west_m, layout::apron_south_m),
      size_m(options.slab_size_m),
      nx(static_cast<int>(std::ceil((layout::apron_east_m - layout::apron_west_m) / size_m - 1e-9))),
      ny(static_cast<int>(std::ceil((layout::apron_north_m - layout::apron_south_m) / size_m - 1e-9))) {}

SlabSurface::SlabSurface(const StandOptions& options, std::uint64_t seed, const Ground& ground)
    : ground_(&ground), grid_(options) {
  const core::RandomStream random(seed, "scenes/stand/slabs");
  // A corner's deviation is offset + slope_x size/2 + slope_y size/2; each part carries a third of its variance.
  const double sigma_m = options.slab_tilt_mm * 1e-3 / std::sqrt(3.0);
  const double sigma_slope = sigma_m / (grid_.size_m / 2);
  for (int k = 0; k < grid_.nx * grid_.ny; ++k) {
    const auto draw = [&](std::uint32_t j) {
      return std::clamp(random.normal(static_cast<std::uint64_t>(k), j), -2.0, 2.0);
    };
    tilts_.push_back({sigma_m * draw(0), sigma_slope * draw(1), sigma_slope * draw(2)});
  }
}

double SlabSurface::height_m(int i, int j, double x_m, double y_m) const {
  const Tilt& tilt = tilts_[static_cast<std::size_t>(j * grid_.nx + i)];
  return ground_->height_m(x_m, y_m) + tilt.offset_m +
         tilt.slope_x * (x_m - grid_.origin_m.x() - (i + 0.5) * grid_.size_m) +
         tilt.slope_y * (y_m - grid_.origin_m.y() - (j + 0.5) * grid_.size_m);
}

StandRelief::StandRelief(const StandOptions& options, std::uint64_t seed)
    : grid_(options), slabs_per_m_(1 / grid_.size_m), joint_depth_m_(options.joint_depth_mm * 1e-3) {
  const core::RandomStream random(seed, "scenes/stand/relief");
  for (std::size_t k = 0; k < lattice_.size(); ++k) lattice_[k] = random.normal(k);
  // Quintic interpolation of independent values has standard deviation 2*181/462 of theirs (square of the integral of
  // w^2 + (1-w)^2 in each direction, rooted).
  constexpr double interpolation_gain = 2.0 * 181 / 462;
  constexpr std::array<double, 3> cell_m{0.05, 0.19, 0.83};
  constexpr std::array<double, 3> variance_share{0.25, 0.25, 0.5};
  for (std::size_t k = 0; k < octaves_.size(); ++k) {
    const double turn =
        0.4 + 0.7 * static_cast<double>(k);  // no octave's lattice is parallel to another's or the joints
    octaves_[k] = {options.relief_rms_mm * 1e-3 * std::sqrt(variance_share[k]) / interpolation_gain,
                   std::cos(turn) / cell_m[k], std::sin(turn) / cell_m[k], lattice_size * random.uniform(k, 1),
                   lattice_size * random.uniform(k, 2)};
  }
}

double StandRelief::add_octave(const Octave& o, double x_m, double y_m, Eigen::Vector2d& gradient) const {
  const double u = o.cos_per_m * x_m + o.sin_per_m * y_m + o.shift_u;
  const double v = o.cos_per_m * y_m - o.sin_per_m * x_m + o.shift_v;
  const int i = floor_to_int(u), j = floor_to_int(v);
  const double s = u - i, t = v - j;
  constexpr int mask = lattice_size - 1;
  const int column = i & mask, next_column = (i + 1) & mask;
  const double* row = &lattice_[static_cast<std::size_t>((j & mask) << lattice_bits)];
  const double* next_row = &lattice_[static_cast<std::size_t>(((j + 1) & mask) << lattice_bits)];
  const double f00 = row[column], f10 = row[next_column], f01 = next_row[column], f11 = next_row[next_column];
  const double ws = s * s * s * (s * (6 * s - 15) + 10), wt = t * t * t * (t * (6 * t - 15) + 10);
  const double ds = 30 * s * s * (s - 1) * (s - 1), dt = 30 * t * t * (t - 1) * (t - 1);
  const double low = f00 + ws * (f10 - f00), high = f01 + ws * (f11 - f01);
  const double du = o.amplitude_m * ds * ((1 - wt) * (f10 - f00) + wt * (f11 - f01));
  const double dv = o.amplitude_m * dt * (high - low);
  gradient.x() += o.cos_per_m * du - o.sin_per_m * dv;
  gradient.y() += o.sin_per_m * du + o.cos_per_m * dv;
  return o.amplitude_m * (low + wt * (high - low));
}

double StandRelief::groove_m(double across_m, double along_m, double& d_across, double& d_along) const {
  const double cell = floor_to_int(across_m * slabs_per_m_ + 0.5);
  const double d = across_m - cell * grid_.size_m;
  const double w = grid_.joint_width_m / 2;
  d_across = d_along = 0;
  if (std::abs(d) > 2.5 * w) return 0;  // exp(-2.5^4) is 1e-17
  const double q = d / w, profile = std::exp(-q * q * q * q);
  constexpr double wander_per_m = 0.7;
  const double phase = wander_per_m * along_m + 1.7 * cell;
  const double depth_m = joint_depth_m_ * (1 + 0.8 * std::sin(phase));
  d_across = depth_m * profile * 4 * q * q * q / w;
  d_along = -profile * joint_depth_m_ * 0.8 * wander_per_m * std::cos(phase);
  return -depth_m * profile;
}

double StandRelief::height_m(double x_m, double y_m, Eigen::Vector2d* gradient) const {
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  double height = 0;
  for (const Octave& octave : octaves_) height += add_octave(octave, x_m, y_m, g);

  // Where two joints cross, the groove is as deep as their product form says: a + b - ab/max, never the sum.
  const double x = x_m - grid_.origin_m.x(), y = y_m - grid_.origin_m.y();
  double a_x, a_y, b_y, b_x;
  const double a = groove_m(x, y, a_x, a_y), b = groove_m(y, x, b_y, b_x);
  const double deepest_m = 1.8 * joint_depth_m_;
  const double share = deepest_m > 0 ? 1 / deepest_m : 0;
  if (gradient) {
    *gradient = g + Eigen::Vector2d(a_x * (1 + b * share) + b_x * (1 + a * share),
                                    a_y * (1 + b * share) + b_y * (1 + a * share));
  }
  return height + a + b + a * b * share;
}

}  // namespace tarmac::scenes
