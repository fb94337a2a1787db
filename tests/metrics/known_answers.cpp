// The derivations. World: N sweeps of M columns, d apart, each sweep P after the one before; reference instants are
// sweep ends, and times below count from the first of them: reference k at tau_k = k P, column c of sweep k at t = k P
// - (M-1-c) d. S = (M-1) d is a sweep's length. Every column sees the corners b of a box around mu_k (b has mean zero,
// B = mean of its horizontal |b|^2), and one moving point. Truths:
//   straight  p(t) = p_s + v t, constant attitude                          rho(t) = |p(t) - p_s| = v |t|
//   circle    yaw rate w, speed u, radius r = u/w, N P w = 2 pi (one turn) rho(t) = 2 r |sin(w t / 2)|
// m(a) = sin(M a d / 2) / (M sin(a d / 2)) is the mean of exp(i a t) over a sweep's columns, seen from mid-sweep.
//
// The controls place a point y of the world, seen at t, at x:
//   lever arm c      T^ = T C     x = y + R(t) c
//   yaw rate e       x = p_s + Rz(e t) (y - p_s)
//   shift s, sweep K x = y + v s (straight); x = O + Rz(w s) (y - O) about the circle's centre O; sweep K only
//   scale q          x = y + (q - 1) (p(t) - p_s)
//
//   metric            lever arm,     lever arm,            yaw rate                        shift            shift scale
//                     straight       circle                (rho as above)                  straight         circle (rho
//                     as above)
//   error at k (ATE)  0              2 c |sin(w tau/2)|    2 sin(e tau/2) rho              v s if k = K     2 r sin(w
//   s/2) if K  |q-1| rho rotation at k     0              0                     e tau                           0 w s
//   if k = K         0 RPE k -> k+n      0              2 c sin(w n P/2)      2 sin(e n P/2) rho_{k+n}        v s if K
//   is one  2 r sin(w s/2) ditto |q-1| |p_{k+n} - p_k|
//     rotation        0              0                     e n P                           0                w s ditto 0
//   point at t, y     0              2 c |sin(w t/2)|      2 sin(e t/2) |y - p_s|          v s in K         2 sin(w
//   s/2)|y-O|    |q-1| rho(t) reference at t    0              2 c sin(w (S-..)/2)   2 sin(e |t-tau|/2) |y - p_s|    0
//   0                    |q-1| |p(t) - p(tau)| deskew            0              c sqrt(1 - m(w)^2)    sqrt(|mu|^2
//   (1-m^2) + 2B(1-m))  0                0                    |q-1| std of p(t) shear             0              2 c
//   sin(w S/2)        2 sin(e S/2) rho(tau), e S      0                0                    |q-1| |p(end)-p(begin)|
// with c the horizontal part of the lever arm, and |y - p_s|, |mu - p_s| horizontal. Why, for the less obvious:
// - lever arm: A T^ = T_0 C^-1 D C with D = T_0^-1 T; C^-1 D C - D = (R_D - 1) c in translation and 0 in rotation.
// - lever arm, fits: body positions lie on a circle of radius r' = |(0,-r) + c|, turned, about the same axis; over a
// full
//   turn the best rigid fit undoes the turn and leaves |r' - r|; a scale undoes that too.
// - deskew: the box's corners are the same in every column, so a displacement that depends on t alone is uncorrelated
// with
//   them: no rotation can help, the residual is its spread. For the yaw rate, planar Procrustes in complex numbers with
//   y = mu + b, x = exp(iet) y: sum of |x~|^2 + |y~|^2 - 2 |sum conj(y~) x~| per point = |mu|^2 (1-m^2) + 2 B - 2 m B.
// Fits of the whole path (se3, sim3) and quantiles: planar Procrustes on complex numbers, and sorting, below.
#include "tests/metrics/known_answers.h"

#include <algorithm>
#include <complex>
#include <functional>

#include "metrics/statistics.h"

namespace tarmac::metrics::tests {

using namespace core;
using Complex = std::complex<double>;

namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;
constexpr int kN = 40, kM = 32;
constexpr double kP = 0.1, kD = 0.003, kS = (kM - 1) * kD;
constexpr double kSpeed = 4.7;
constexpr double kRate = 2 * std::numbers::pi / (kN * kP), kRadius = kSpeed / kRate;
const Eigen::Vector3d kHalf(12, 7, 3), kBoxOffset(3, 5, 1), kMovingOffset(20, 1, 2);
constexpr int kShiftedSweep = 17;

double reference_s(int k) {
  return k * kP;
}
double column_s(int k, int c) {
  return k * kP - (kM - 1 - c) * kD;
}

/// The path in the horizontal plane, from its position at the first reference instant.
struct PlanarTruth {
  TruthKind kind;
  std::shared_ptr<const ConstantTwist> motion;
  Complex p_start;
  Complex forward;  ///< heading at the first reference instant

  Complex position(double t) const {
    if (kind == TruthKind::straight) return p_start + kSpeed * t * forward;
    return centre() + (p_start - centre()) * std::polar(1.0, kRate * t);
  }
  Complex centre() const { return p_start + Complex(0, kRadius) * forward; }
  double rho(double t) const { return std::abs(position(t) - p_start); }
  /// Distance between two places of the path, `dt` apart.
  double chord(double dt) const {
    return kind == TruthKind::straight ? kSpeed * dt : 2 * kRadius * std::abs(std::sin(kRate * dt / 2));
  }
};

Complex planar(const Eigen::Vector3d& p) {
  return {p.x(), p.y()};
}

struct Setting {
  PlanarTruth truth;
  Drive drive;
  std::vector<Complex> mu;                    ///< a sweep
  std::vector<std::vector<Complex>> corners;  ///< a sweep
  std::vector<Complex> moving;                ///< a sweep
};

Setting make_setting(TruthKind kind) {
  const Time end = time_from_s(2 + kN * kP + 1);
  Vector6 xi = Vector6::Zero();
  SE3 T0;
  if (kind == TruthKind::straight) {  // tilted body, level path
    T0 = pose({40, -20, 3}, {0.1, -0.2, 0.6});
    xi.head<3>() = T0.linear().transpose() * (kSpeed * Eigen::Vector3d(std::cos(0.4), std::sin(0.4), 0));
  } else {
    T0 = pose({40, -20, 3}, {0, 0, 0.6});
    xi << kSpeed, 0, 0, 0, 0, kRate;
  }
  Setting s;
  s.truth.kind = kind;
  s.truth.motion = std::make_shared<ConstantTwist>(T0, xi, Time{}, end);
  DriveShape shape{.sweeps = kN, .columns = kM};
  const Kinematics start = s.truth.motion->at(shape.end(0));
  s.truth.p_start = planar(start.T_world_body.translation());
  s.truth.forward = planar(start.v_world) / kSpeed;
  s.drive = make_drive(s.truth.motion, shape, [&](int k) {
    const Eigen::Vector3d mu = s.truth.motion->pose(shape.end(k)).translation() + kBoxOffset;
    std::vector<Target> targets = box(mu, kHalf);
    std::vector<Complex> corners;
    for (const Target& t : targets) corners.push_back(planar(t.p_world));
    targets.push_back({mu + kMovingOffset, true});
    s.mu.push_back(planar(mu));
    s.corners.push_back(corners);
    s.moving.push_back(planar(mu + kMovingOffset));
    return targets;
  });
  return s;
}

double square(double x) {
  return x * x;
}
double mean_of(int n, const std::function<double(int)>& f) {
  double sum = 0;
  for (int k = 0; k < n; ++k) sum += f(k);
  return sum / n;
}
double rms_of(int n, const std::function<double(int)>& f) {
  return std::sqrt(mean_of(n, [&](int k) { return square(f(k)); }));
}
double median_of(int n, const std::function<double(int)>& f) {
  std::vector<double> values;
  for (int k = 0; k < n; ++k) values.push_back(f(k));
  return quantile(values, 0.5);
}
double max_of(int n, const std::function<double(int)>& f) {
  double largest = 0;
  for (int k = 0; k < n; ++k) largest = std::max(largest, f(k));
  return largest;
}
double mean_phasor(double rate) {
  return rate == 0 ? 1 : std::sin(kM * rate * kD / 2) / (kM * std::sin(rate * kD / 2));
}

/// The best planar fit of zh onto z: z ~ scale turn (zh - zh_mean) + z_mean.
struct PlanarFit {
  Complex z_mean, zh_mean, turn;
  double scale = 1;
  Complex operator()(Complex zh) const { return z_mean + scale * turn * (zh - zh_mean); }
};
PlanarFit procrustes(const std::vector<Complex>& z, const std::vector<Complex>& zh, bool with_scale) {
  PlanarFit fit;
  for (std::size_t k = 0; k < z.size(); ++k) {
    fit.z_mean += z[k] / static_cast<double>(z.size());
    fit.zh_mean += zh[k] / static_cast<double>(z.size());
  }
  Complex cross = 0;
  double spread = 0;
  for (std::size_t k = 0; k < z.size(); ++k) {
    cross += (z[k] - fit.z_mean) * std::conj(zh[k] - fit.zh_mean);
    spread += std::norm(zh[k] - fit.zh_mean);
  }
  fit.turn = cross / std::abs(cross);
  if (with_scale) fit.scale = std::abs(cross) / spread;
  return fit;
}

using Place = std::function<Complex(int k, double t, Complex y)>;

/// ATE after fits and point error after the SE(3) fit, from where the control places points (`x`).
void add_fits(const Setting& s, const Place& x, KnownAnswer& answer) {
  std::vector<Complex> z, zh;
  for (int k = 0; k < kN; ++k) {
    z.push_back(s.truth.position(reference_s(k)));
    zh.push_back(x(k, reference_s(k), z.back()));
  }
  const PlanarFit rigid = procrustes(z, zh, false), similar = procrustes(z, zh, true);
  const auto rigid_error = [&](int k) { return std::abs(rigid(zh[k]) - z[k]); };
  answer.rows["ate_se3_rmse_m"] = answer.rows["ate_yaw_pos_rmse_m"] = rms_of(kN, rigid_error);
  answer.rows["ate_se3_median_m"] = median_of(kN, rigid_error);
  answer.rows["ate_se3_max_m"] = max_of(kN, rigid_error);
  answer.rows["ate_sim3_rmse_m"] = rms_of(kN, [&](int k) { return std::abs(similar(zh[k]) - z[k]); });
  double sum = 0;
  for (int k = 0; k < kN; ++k)
    for (int c = 0; c < kM; ++c)
      for (const Complex y : s.corners[k]) sum += std::norm(rigid(x(k, column_s(k, c), y)) - y);
  answer.rows["point_error_se3_rms_m"] = std::sqrt(sum / (kN * kM * 8));
}

void add_ate(const std::function<double(int)>& error_m, const std::function<double(int)>& rotation_rad,
             KnownAnswer& answer) {
  answer.rows["ate_first_pose_rmse_m"] = rms_of(kN, error_m);
  answer.rows["ate_first_pose_median_m"] = median_of(kN, error_m);
  answer.rows["ate_first_pose_max_m"] = max_of(kN, error_m);
  answer.rows["ate_first_pose_rot_rmse_deg"] = rms_of(kN, rotation_rad) * kDegPerRad;
  const double path_m = kSpeed * reference_s(kN - 1);
  answer.rows["end_error_m"] = error_m(kN - 1);
  answer.rows["path_length_m"] = path_m;
  answer.rows["end_error_percent"] = 100 * error_m(kN - 1) / path_m;
}

using OverPair = std::function<double(int k, int n)>;
void add_rpe(const OverPair& trans_m, const OverPair& rot_rad, KnownAnswer& answer) {
  const int ten_metres = static_cast<int>(std::ceil(10 / (kSpeed * kP)));  // sweeps: 21.3 of them, so the 22nd
  for (const auto& [name, n] :
       std::map<std::string, int>{{"1sweep", 1}, {"10sweep", 10}, {"1s", 10}, {"10m", ten_metres}}) {
    const int steps = n;
    answer.rows["rpe_" + name + "_trans_rmse_m"] = rms_of(kN - n, [&](int k) { return trans_m(k, steps); });
    answer.rows["rpe_" + name + "_rot_rmse_deg"] =
        rms_of(kN - n, [&](int k) { return rot_rad(k, steps); }) * kDegPerRad;
  }
}

using AtPoint = std::function<double(int k, double t, Complex y)>;
/// Everything about point errors after first-pose alignment, from its formula.
void add_point_errors(const Setting& s, const AtPoint& error_m, KnownAnswer& answer) {
  std::vector<double> all, moving;
  std::vector<double> by_column(kM, 0);
  for (int k = 0; k < kN; ++k)
    for (int c = 0; c < kM; ++c) {
      for (const Complex y : s.corners[k]) {
        all.push_back(error_m(k, column_s(k, c), y));
        by_column[c] += square(all.back()) / (kN * 8);
      }
      moving.push_back(error_m(k, column_s(k, c), s.moving[k]));
    }
  for (double& value : by_column) value = std::sqrt(value);
  answer.rows["point_error_rms_m"] = rms(all);
  answer.rows["point_error_moving_rms_m"] = rms(moving);
  std::sort(all.begin(), all.end());  // N M 8 = 10240 points: ranks 5120 and 9728
  answer.rows["point_error_p50_m"] = all[all.size() / 2 - 1];
  answer.rows["point_error_p95_m"] = all[all.size() * 95 / 100 - 1];
  answer.rows["point_error_max_m"] = all.back();
  answer.phase["point_error_by_phase"] = by_column;
}

void add_shape(double deskew_m, double shear_m, double shear_rad, const std::function<double(int c)>& deskew_phase,
               const std::function<double(int c)>& reference_phase, KnownAnswer& answer) {
  answer.rows["deskew_error_rms_m"] = deskew_m;
  answer.rows["sweep_shear_rms_m"] = shear_m;
  answer.rows["sweep_shear_rot_rms_deg"] = shear_rad * kDegPerRad;
  for (int c = 0; c < kM; ++c) {
    answer.phase["deskew_error_by_phase"].push_back(deskew_phase(c));
    answer.phase["reference_error_by_phase"].push_back(reference_phase(c));
  }
  answer.rows["coverage_percent"] = answer.rows["point_coverage_percent"] = 100;
}

double from_reference_s(int c) {
  return (kM - 1 - c) * kD;
}
double from_middle_s(int c) {
  return (c - (kM - 1) / 2.0) * kD;
}
/// Spread of exp(i rate t) about its mean, at a column and over all.
double phasor_residual(double rate, int c) {
  return std::abs(std::polar(1.0, rate * from_middle_s(c)) - mean_phasor(rate));
}
double phasor_spread(double rate) {
  return std::sqrt(1 - square(mean_phasor(rate)));
}
/// Standard deviation of a sweep's column times.
double column_time_spread() {
  return kD * std::sqrt((square(kM) - 1) / 12.0);
}

}  // namespace

KnownAnswer lever_arm(TruthKind kind) {
  Setting s = make_setting(kind);
  const Eigen::Vector3d lever(0.4, -0.3, 0.2);
  KnownAnswer answer{"lever arm", {}, {.C_right = pose(lever, Eigen::Vector3d::Zero())}, {}, {}};
  const double w = kind == TruthKind::circle ? kRate : 0;  // turning alone makes a lever arm visible
  const double c = std::hypot(lever.x(), lever.y());
  const auto swing = [&](double dt) { return 2 * c * std::abs(std::sin(w * dt / 2)); };
  add_ate([&](int k) { return swing(reference_s(k)); }, [](int) { return 0.0; }, answer);
  add_rpe([&](int, int n) { return swing(n * kP); }, [](int, int) { return 0.0; }, answer);
  add_point_errors(
      s, [&](int, double t, Complex) { return swing(t); }, answer);
  add_shape(
      c * phasor_spread(w), swing(kS), 0, [&](int col) { return c * phasor_residual(w, col); },
      [&](int col) { return swing(from_reference_s(col)); }, answer);
  // On the straight line the arm is one shift of the world, whatever it is; on the circle it turns with the heading.
  const Complex arm = Complex(lever.x(), lever.y()) * s.truth.forward;
  add_fits(
      s, [&](int, double t, Complex y) { return y + arm * std::polar(1.0, w * t); }, answer);
  if (kind == TruthKind::circle) {
    const double change = std::abs(std::abs(Complex(lever.x(), lever.y() - kRadius)) - kRadius);
    for (const char* metric : {"ate_se3_rmse_m", "ate_se3_median_m", "ate_se3_max_m", "ate_yaw_pos_rmse_m"})
      answer.rows[metric] = change;
    answer.rows["ate_sim3_rmse_m"] = 0;
    answer.rows["point_error_rms_m"] = c * std::sqrt(2.0);  // mean of cos(w t) over a full turn is 0
  }
  answer.drive = std::move(s.drive);
  return answer;
}

KnownAnswer yaw_rate_error(TruthKind kind) {
  Setting s = make_setting(kind);
  const double e = 0.02;
  KnownAnswer answer{"yaw-rate error", {}, {.yaw_rate_error_rad_s = e}, {}, {}};
  const auto turn = [&](double dt) { return 2 * std::abs(std::sin(e * dt / 2)); };
  const auto rho = [&](int k) { return s.truth.rho(reference_s(k)); };
  add_ate([&](int k) { return turn(reference_s(k)) * rho(k); }, [&](int k) { return e * reference_s(k); }, answer);
  add_rpe([&](int k, int n) { return turn(n * kP) * rho(k + n); }, [&](int, int n) { return e * n * kP; }, answer);
  add_point_errors(
      s, [&](int, double t, Complex y) { return turn(t) * std::abs(y - s.truth.p_start); }, answer);
  const double B = square(kHalf.x()) + square(kHalf.y()), m = mean_phasor(e);
  const double mu = rms_of(kN, [&](int k) { return std::abs(s.mu[k] - s.truth.p_start); });
  const double corner = std::sqrt(mu * mu + B);
  add_shape(
      std::sqrt(mu * mu * (1 - m * m) + 2 * B * (1 - m)), rms_of(kN, [&](int k) { return turn(kS) * rho(k); }), e * kS,
      [&](int c) { return std::hypot(phasor_residual(e, c) * mu, turn(from_middle_s(c)) * std::sqrt(B)); },
      [&](int c) { return turn(from_reference_s(c)) * corner; }, answer);
  add_fits(
      s, [&](int, double t, Complex y) { return s.truth.p_start + std::polar(1.0, e * t) * (y - s.truth.p_start); },
      answer);
  answer.drive = std::move(s.drive);
  return answer;
}

KnownAnswer shifted_sweep(TruthKind kind) {
  Setting s = make_setting(kind);
  const double shift = 0.02;
  KnownAnswer answer{"shifted sweep", {}, {.shifted_sweep = kShiftedSweep, .shift = duration_from_s(shift)}, {}, {}};
  const bool turns = kind == TruthKind::circle;
  const double step = s.truth.chord(shift), angle = turns ? kRate * shift : 0;
  const auto hit = [](int k) { return k == kShiftedSweep ? 1.0 : 0.0; };
  add_ate([&](int k) { return step * hit(k); }, [&](int k) { return angle * hit(k); }, answer);
  add_rpe([&](int k, int n) { return step * (hit(k) + hit(k + n)); },
          [&](int k, int n) { return angle * (hit(k) + hit(k + n)); }, answer);
  add_point_errors(
      s,
      [&](int k, double, Complex y) {
        return hit(k) * (turns ? 2 * std::sin(angle / 2) * std::abs(y - s.truth.centre()) : step);
      },
      answer);
  const auto none = [](int) { return 0.0; };
  add_shape(0, 0, 0, none, none, answer);
  add_fits(
      s,
      [&](int k, double, Complex y) {
        if (k != kShiftedSweep) return y;
        return turns ? s.truth.centre() + std::polar(1.0, angle) * (y - s.truth.centre()) : y + step * s.truth.forward;
      },
      answer);
  answer.drive = std::move(s.drive);
  return answer;
}

KnownAnswer speed_scale(TruthKind kind) {
  Setting s = make_setting(kind);
  const double q = 1.01, excess = q - 1;
  KnownAnswer answer{"speed scale", {}, {.speed_scale = q}, {}, {}};
  const bool turns = kind == TruthKind::circle;
  add_ate([&](int k) { return excess * s.truth.rho(reference_s(k)); }, [](int) { return 0.0; }, answer);
  add_rpe([&](int, int n) { return excess * s.truth.chord(n * kP); }, [](int, int) { return 0.0; }, answer);
  add_point_errors(
      s, [&](int, double t, Complex) { return excess * s.truth.rho(t); }, answer);
  add_shape(
      excess * (turns ? kRadius * phasor_spread(kRate) : kSpeed * column_time_spread()), excess * s.truth.chord(kS), 0,
      [&](int c) {
        return excess * (turns ? kRadius * phasor_residual(kRate, c) : kSpeed * std::abs(from_middle_s(c)));
      },
      [&](int c) { return excess * s.truth.chord(from_reference_s(c)); }, answer);
  add_fits(
      s, [&](int, double t, Complex y) { return y + excess * (s.truth.position(t) - s.truth.p_start); }, answer);
  answer.rows["ate_sim3_rmse_m"] = 0;
  if (!turns) answer.rows["end_error_percent"] = 100 * excess;
  answer.drive = std::move(s.drive);
  return answer;
}

}  // namespace tarmac::metrics::tests
