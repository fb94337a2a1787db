#include "scenes/paving/paving.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "core/vector_loop.h"

namespace tarmac::scenes {

namespace {

constexpr double tau = 2 * std::numbers::pi;

/// Without the call that std::floor costs on a processor that is not known to round in one instruction.
inline int floor_to_int(double x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < truncated ? 1 : 0);
}

}  // namespace

WavyGround::WavyGround(const PavingSpec& spec, std::uint64_t seed)
    : crossfall_(spec.crossfall_percent / 100), crossfall_zero_y_m_(spec.crossfall_zero_y_m) {
  // Shorter waves are lower: roughly constant slope, as of a graded surface.
  constexpr std::array<double, 6> wavelength_m{90, 61, 38, 24, 14, 9};
  constexpr std::array<double, 6> share{1, 0.6, 0.3, 0.14, 0.05, 0.025};
  const core::RandomStream random(seed, spec.stream + "/ground");
  for (std::size_t k = 0; k < waves_.size(); ++k) {
    const double direction = tau * random.uniform(k, 0);
    const double wave_number = tau / wavelength_m[k];
    waves_[k] = {spec.undulation_mm * 1e-3 * share[k], wave_number * std::cos(direction),
                 wave_number * std::sin(direction), tau * random.uniform(k, 1)};
  }
}

double WavyGround::height_m(double x_m, double y_m, Eigen::Vector2d* gradient, Eigen::Vector3d* hessian) const {
  double height = crossfall_ * (y_m - crossfall_zero_y_m_);
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

GroundBounds WavyGround::bounds() const {
  GroundBounds bounds{std::abs(crossfall_), 0, 0};
  for (const Wave& w : waves_) {
    const double k = std::hypot(w.kx_per_m, w.ky_per_m);
    bounds.slope += w.amplitude_m * k;
    bounds.curvature_per_m += w.amplitude_m * k * k;
    bounds.third_per_m2 += w.amplitude_m * k * k * k;
  }
  return bounds;
}

SlabGrid::SlabGrid(const PavingSpec& spec)
    : origin_m(spec.low_m),
      size_m(spec.slab_size_m),
      cell_m(spec.cell_m),
      nx(static_cast<int>(std::ceil((spec.high_m - spec.low_m).x() / size_m - 1e-9))),
      ny(static_cast<int>(std::ceil((spec.high_m - spec.low_m).y() / size_m - 1e-9))) {}

SlabSurface::SlabSurface(const PavingSpec& spec, std::uint64_t seed, const Ground& ground)
    : ground_(&ground), grid_(spec) {
  const core::RandomStream random(seed, spec.stream + "/slabs");
  // A corner's deviation is offset + slope_x size/2 + slope_y size/2; each part carries a third of its variance.
  const double sigma_m = spec.slab_tilt_mm * 1e-3 / std::sqrt(3.0);
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

namespace {

/// Quintic interpolation between independent values that repeat after `period` nodes: C2, and with them at the nodes.
double octave(const core::RandomStream& random, std::uint32_t id, int period, double u, double v) {
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const double s = u - i, t = v - j;
  const auto value = [&](int a, int b) {
    return random.normal(static_cast<std::uint64_t>((b % period) * period + a % period), id);
  };
  const double ws = s * s * s * (s * (6 * s - 15) + 10), wt = t * t * t * (t * (6 * t - 15) + 10);
  const double low = value(i, j) + ws * (value(i + 1, j) - value(i, j));
  const double high = value(i, j + 1) + ws * (value(i + 1, j + 1) - value(i, j + 1));
  return low + wt * (high - low);
}

constexpr double groove_reach = 2.5;  ///< half widths from a joint's middle to where nothing is left of it
constexpr double node_m = 0.05;       ///< the finest grain of the texture
constexpr double turn_rad = 0.4;      ///< the lattice is parallel neither to joints nor to roads

}  // namespace

SlabRelief::SlabRelief(const PavingSpec& spec, std::uint64_t seed)
    : grid_(spec),
      slabs_per_m_(1 / grid_.size_m),
      joint_depth_m_(spec.joint_depth_mm * 1e-3),
      cos_per_m_(std::cos(turn_rad) / node_m),
      sin_per_m_(std::sin(turn_rad) / node_m),
      lattice_m_(static_cast<std::size_t>(lattice_size) * lattice_size) {
  // Grains of 0.05, 0.2 and 0.8 m. They are added up at the nodes once, so that a query interpolates one lattice.
  const core::RandomStream random(seed, spec.stream + "/relief");
  constexpr std::array<int, 3> nodes_a_grain{1, 4, 16};
  constexpr std::array<double, 3> share{1, 1, std::numbers::sqrt2};
  for (int b = 0; b < lattice_size; ++b) {
    for (int a = 0; a < lattice_size; ++a) {
      double sum = 0;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const int n = nodes_a_grain[k];
        sum += share[k] * octave(random, k, lattice_size / n, static_cast<double>(a) / n, static_cast<double>(b) / n);
      }
      lattice_m_[static_cast<std::size_t>(b * lattice_size + a)] = static_cast<float>(sum);
    }
  }
  // Scaled so that the interpolated texture, not its nodes, has the root mean square asked for.
  double squares = 0;
  int samples = 0;
  Eigen::Vector2d gradient;
  for (double x = 0; x < lattice_size * node_m; x += 2.3 * node_m) {
    for (double y = 0; y < lattice_size * node_m; y += 2.7 * node_m, ++samples) {
      gradient.setZero();
      const double h = texture_m(x, y, gradient);
      squares += h * h;
    }
  }
  const double scale = spec.relief_rms_mm * 1e-3 / std::sqrt(squares / samples);
  for (float& height : lattice_m_) height = static_cast<float>(height * scale);
}

double SlabRelief::texture_m(double x_m, double y_m, Eigen::Vector2d& gradient) const {
  const double u = cos_per_m_ * x_m + sin_per_m_ * y_m, v = cos_per_m_ * y_m - sin_per_m_ * x_m;
  const int i = floor_to_int(u), j = floor_to_int(v);
  const double s = u - i, t = v - j;
  constexpr int mask = lattice_size - 1;
  const float* row0 = lattice_m_.data() + ((j & mask) << lattice_bits);
  const float* row1 = lattice_m_.data() + (((j + 1) & mask) << lattice_bits);
  const double f00 = row0[i & mask], f10 = row0[(i + 1) & mask], f01 = row1[i & mask], f11 = row1[(i + 1) & mask];
  const double ws = s * s * s * (s * (6 * s - 15) + 10), wt = t * t * t * (t * (6 * t - 15) + 10);
  const double ds = 30 * s * s * (s - 1) * (s - 1), dt = 30 * t * t * (t - 1) * (t - 1);
  const double low = f00 + ws * (f10 - f00), high = f01 + ws * (f11 - f01);
  const double du = ds * ((1 - wt) * (f10 - f00) + wt * (f11 - f01)), dv = dt * (high - low);
  gradient.x() += cos_per_m_ * du - sin_per_m_ * dv;
  gradient.y() += sin_per_m_ * du + cos_per_m_ * dv;
  return low + wt * (high - low);
}

double SlabRelief::groove_m(double across_m, double along_m, double& d_across, double& d_along) const {
  const double cell = floor_to_int(across_m * slabs_per_m_ + 0.5);
  const double d = across_m - cell * grid_.size_m;
  const double w = grid_.joint_width_m / 2;
  d_across = d_along = 0;
  if (std::abs(d) > groove_reach * w) return 0;  // exp(-2.5^4) is 1e-17
  const double q = d / w, profile = std::exp(-q * q * q * q);
  constexpr double wander_per_m = 0.7;
  const double phase = wander_per_m * along_m + 1.7 * cell;
  const double depth_m = joint_depth_m_ * (1 + 0.8 * std::sin(phase));
  d_across = depth_m * profile * 4 * q * q * q / w;
  d_along = -profile * joint_depth_m_ * 0.8 * wander_per_m * std::cos(phase);
  return -depth_m * profile;
}

double SlabRelief::height_m(double x_m, double y_m, Eigen::Vector2d* gradient) const {
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  const double height = texture_m(x_m, y_m, g);

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

namespace {

/// The texture alone, and which points have a joint near enough to matter. Lattice coordinates are split into node and
/// fraction in double, so that single precision does the rest anywhere in the world.
TARMAC_VECTOR_LOOP void texture_of(std::size_t count, const double* x_m, const double* y_m, double cos_per_m,
                                   double sin_per_m, const float* __restrict lattice_m, int bits, double* __restrict u,
                                   double* __restrict v, float* __restrict height_m, float* __restrict slope_x,
                                   float* __restrict slope_y) {
  for (std::size_t k = 0; k < count; ++k) {
    u[k] = cos_per_m * x_m[k] + sin_per_m * y_m[k];
    v[k] = cos_per_m * y_m[k] - sin_per_m * x_m[k];
  }
  const int mask = (1 << bits) - 1;
  const float cos_f = static_cast<float>(cos_per_m), sin_f = static_cast<float>(sin_per_m);
  for (std::size_t k = 0; k < count; ++k) {
    const int i = floor_to_int(u[k]), j = floor_to_int(v[k]);
    const float s = static_cast<float>(u[k] - i), t = static_cast<float>(v[k] - j);
    const int row0 = (j & mask) << bits, row1 = ((j + 1) & mask) << bits, left = i & mask, right = (i + 1) & mask;
    const float f00 = lattice_m[row0 + left], f10 = lattice_m[row0 + right];
    const float f01 = lattice_m[row1 + left], f11 = lattice_m[row1 + right];
    const float ws = s * s * s * (s * (6 * s - 15) + 10), wt = t * t * t * (t * (6 * t - 15) + 10);
    const float ds = 30 * s * s * (s - 1) * (s - 1), dt = 30 * t * t * (t - 1) * (t - 1);
    const float low = f00 + ws * (f10 - f00), high = f01 + ws * (f11 - f01);
    const float du = ds * ((1 - wt) * (f10 - f00) + wt * (f11 - f01)), dv = dt * (high - low);
    height_m[k] = low + wt * (high - low);
    slope_x[k] = cos_f * du - sin_f * dv;
    slope_y[k] = sin_f * du + cos_f * dv;
  }
}

/// Slabs from the nearest joint's middle, of the joints at whole multiples.
inline double from_joint(double slabs) {
  return std::abs(slabs - floor_to_int(slabs + 0.5));
}

TARMAC_VECTOR_LOOP void mark_joints(std::size_t count, const double* x_m, const double* y_m, double west_m,
                                    double south_m, double slabs_per_m, double reach_slabs, int* near_joint) {
  for (std::size_t k = 0; k < count; ++k) {
    const double across = from_joint((x_m[k] - west_m) * slabs_per_m),
                 along = from_joint((y_m[k] - south_m) * slabs_per_m);
    near_joint[k] = (across < reach_slabs) | (along < reach_slabs);
  }
}

}  // namespace

void SlabRelief::heights_m(std::size_t count, const double* x_m, const double* y_m, float* heights, float* slope_x,
                           float* slope_y) const {
  constexpr std::size_t batch = 256;
  double u[batch], v[batch];
  int near_joint[batch];
  const double reach_slabs = groove_reach * grid_.joint_width_m / 2 * slabs_per_m_ + 1e-9;
  for (std::size_t first = 0; first < count; first += batch) {
    const std::size_t n = std::min(batch, count - first);
    texture_of(n, x_m + first, y_m + first, cos_per_m_, sin_per_m_, lattice_m_.data(), lattice_bits, u, v,
               heights + first, slope_x + first, slope_y + first);
    mark_joints(n, x_m + first, y_m + first, grid_.origin_m.x(), grid_.origin_m.y(), slabs_per_m_, reach_slabs,
                near_joint);
    for (std::size_t k = 0; k < n; ++k) {
      if (near_joint[k] == 0) continue;
      Eigen::Vector2d gradient;
      heights[first + k] = static_cast<float>(height_m(x_m[first + k], y_m[first + k], &gradient));
      slope_x[first + k] = static_cast<float>(gradient.x());
      slope_y[first + k] = static_cast<float>(gradient.y());
    }
  }
}

}  // namespace tarmac::scenes
