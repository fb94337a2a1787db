#include "metrics/residual_sweep.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "metrics/statistics.h"

namespace tarmac::metrics {

using namespace core;

namespace {

using Vector19 = Eigen::Matrix<double, 19, 1>;
using Matrix19 = Eigen::Matrix<double, 19, 19>;
using Matrix18 = Eigen::Matrix<double, 18, 18>;
using Vector18 = Eigen::Matrix<double, 18, 1>;

constexpr int kSaw = 18;                          // the last column
constexpr std::size_t kFewestRows = 60;           // three a parameter
constexpr double kHuber = 1.345, kTukey = 4.685;  // both 95 % efficient for Gaussian residuals
constexpr double kPrior = 1;                      // [1/m^2, 1/rad^2]: what the rows leave free stays at 0 +- 1 m, 1 rad

/// A row as the fit wants it.
struct Equation {
  Vector19 a;
  double r = 0;
  bool level = false;  ///< the surface faces up or down
  double robust = 1;   ///< weight by the loss alone
  double weight = 1;   ///< and by the spread of its class
};

/// Spread of residuals, of level surfaces and of all others: pavement seen at a grazing angle hardly shows the noise of
/// ranges and is most of what a sweep sees. With one spread for all, walls would be outliers wherever they say most.
struct Spread {
  double level_m = 1, other_m = 1;
  double of(const Equation& e) const { return e.level ? level_m : other_m; }
};

/// J by the pose at mid-sweep: T(t) = T_mid C with C = Exp(tau twist), hence Exp(xi) at mid is Exp(Ad(C^-1) xi) at t;
/// to first order in tau, Ad(C^-1) = 1 - tau ad(twist).
Row6 at_mid(const Row6& J, const Vector6& twist, double tau_s) {
  const Eigen::Vector3d v = twist.head<3>(), w = twist.tail<3>();
  const Eigen::Vector3d n = J.head<3>(), m = J.tail<3>();
  // ad(twist) = [ [w]x  [v]x ; 0  [w]x ]
  Row6 moved;
  moved << (n - tau_s * n.cross(w)).transpose(), (m - tau_s * (n.cross(v) + m.cross(w))).transpose();
  return moved;
}

Equation equation(const ResidualRow& row, double s, double span_s, const SweepRates& rates, double place) {
  const Row6 J_time = Eigen::Map<const Eigen::Matrix<float, 1, 6>>(row.jacobian).cast<double>();
  const Vector6 J = at_mid(J_time, rates.twist, (s - 0.5) * span_s).transpose();
  const double linear = s - 0.5, square = linear * linear - 1.0 / 12;
  Equation e;
  e.a << J, linear * J, square * J, -(place - 0.5) * J.dot(rates.twist);
  e.r = row.value;
  e.level = std::abs(J_time[2]) > 0.8;
  return e;
}

struct Normal {
  Matrix19 H = Matrix19::Zero();
  Vector19 g = Vector19::Zero();
};

Normal normal_of(const std::vector<Equation>& equations) {
  Normal n;
  for (const Equation& e : equations) {
    if (!(e.weight > 0)) continue;
    n.H.selfadjointView<Eigen::Lower>().rankUpdate(e.a, e.weight);
    n.g += e.weight * e.r * e.a;
  }
  n.H = n.H.selfadjointView<Eigen::Lower>();
  return n;
}

/// Without the saw-tooth its column stays at 0.
Vector19 solve(const Normal& n, bool with_saw) {
  Vector19 x = Vector19::Zero();
  if (with_saw) return (n.H + kPrior * Matrix19::Identity()).ldlt().solve(n.g);
  x.head<18>() = (n.H.topLeftCorner<18, 18>() + kPrior * Matrix18::Identity()).ldlt().solve(n.g.head<18>());
  return x;
}

double residual(const Equation& e, const Vector19& x) {
  return e.r - e.a.dot(x);
}

/// Robust standard deviation about the shape, of those that `use` takes; 0 when there are none.
template <class Use>
double robust_sigma(const std::vector<Equation>& equations, const Vector19& x, const Use& use) {
  std::vector<double> off;
  for (const Equation& e : equations)
    if (use(e)) off.push_back(std::abs(residual(e, x)));
  return off.empty() ? 0 : std::max(1e-6, 1.4826 * quantile(std::move(off), 0.5));
}

Spread spread(const std::vector<Equation>& equations, const Vector19& x) {
  return {robust_sigma(equations, x, [](const Equation& e) { return e.level; }),
          robust_sigma(equations, x, [](const Equation& e) { return !e.level; })};
}

/// Huber's weight, which has one minimum, until the shape is about right; then Tukey's, which ignores outliers.
void weigh(std::vector<Equation>& equations, const Vector19& x, bool tukey) {
  const Spread sigma = spread(equations, x);
  for (Equation& e : equations) {
    const double s = sigma.of(e), u = std::abs(residual(e, x)) / s, v = u / kTukey;
    if (tukey)
      e.robust = v < 1 ? (1 - v * v) * (1 - v * v) : 0;
    else
      e.robust = u > kHuber ? kHuber / u : 1;
    e.weight = e.robust / (s * s);
  }
}

void keep_shape(const Normal& n, const Vector19& x, SweepShape& shape) {
  const Matrix18 H = n.H.topLeftCorner<18, 18>();
  const Matrix6 H0 = H.topLeftCorner<6, 6>() + kPrior * Matrix6::Identity();
  const Eigen::Matrix<double, 6, 12> coupling = H.topRightCorner<6, 12>();
  shape.value = x.segment<12>(6);
  shape.information = H.bottomRightCorner<12, 12>() - coupling.transpose() * H0.ldlt().solve(coupling);
}

void keep_saw(const Normal& n, SawTooth& saw) {
  const Matrix18 H = n.H.topLeftCorner<18, 18>() + kPrior * Matrix18::Identity();
  const Vector18 coupling = n.H.block<18, 1>(0, kSaw);
  saw.information = n.H(kSaw, kSaw) - coupling.dot(H.ldlt().solve(coupling));
  saw.score = n.g[kSaw] - coupling.dot(solve(n, false).head<18>());
}

void fit(std::vector<Equation>& equations, bool with_saw, SweepResiduals& sweep) {
  Vector19 x = Vector19::Zero();
  Normal n;
  for (int round = 0; round < 6; ++round) {
    weigh(equations, x, round >= 4);
    n = normal_of(equations);
    x = solve(n, with_saw);
  }
  sweep.sigma_m = robust_sigma(equations, x, [](const Equation&) { return true; });
  keep_shape(n, x, sweep.shape);
  if (with_saw) keep_saw(n, sweep.saw);
  sweep.fitted = true;
}

void fill_bins(const std::vector<ResidualRow>& rows, const std::vector<double>& phases,
               const std::vector<Equation>& equations, std::vector<PhaseBin>& bins) {
  const auto last = static_cast<double>(bins.size()) - 1;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double place = phases[i] * static_cast<double>(bins.size());
    PhaseBin& bin = bins[static_cast<std::size_t>(std::clamp(place, 0.0, last))];
    const Eigen::Vector3d n = Eigen::Map<const Eigen::Vector3f>(rows[i].jacobian).cast<double>();
    const double r = rows[i].value, w = equations.empty() ? 1 : equations[i].robust;
    if (!(w > 0)) continue;
    bin.n += w;
    bin.r += w * r;
    bin.rr += w * r * r;
    bin.nn += w * n * n.transpose();
    bin.nr += w * r * n;
  }
}

}  // namespace

void PhaseBin::add(const PhaseBin& other, double times) {
  n += times * other.n;
  r += times * other.r;
  rr += times * other.rr;
  nn += times * other.nn;
  nr += times * other.nr;
}

std::array<double, 2> phase_span_ns(std::span<const ResidualRow> rows, Duration duration) {
  const auto whole = static_cast<double>(duration.count());
  if (rows.empty()) return {0, whole};
  const auto [first, last] = std::minmax_element(
      rows.begin(), rows.end(), [](const ResidualRow& a, const ResidualRow& b) { return a.t_ns < b.t_ns; });
  const double lowest = first->t_ns, highest = last->t_ns;
  if (highest - lowest < whole / 3) return {lowest, highest};
  return {std::min(0.0, lowest), std::max(whole, highest)};
}

SweepResiduals reduce_sweep(const SweepDiagnostics& diagnostics, Duration duration, const SweepRates* rates,
                            std::span<const float> place, const ReduceSettings& settings) {
  SweepResiduals sweep;
  sweep.index = diagnostics.index;
  sweep.bins.resize(static_cast<std::size_t>(settings.phase_bins));
  std::vector<ResidualRow> rows;
  for (const ResidualRow& row : diagnostics.rows_are_surface ? diagnostics.rows : diagnostics.surface)
    if (std::abs(row.value) < settings.gate_m && row.weight > 0) rows.push_back(row);
  sweep.rows = rows.size();
  const auto [low_ns, high_ns] = phase_span_ns(rows, duration);
  sweep.span_s = 1e-9 * (high_ns - low_ns);
  if (rows.empty() || !(sweep.span_s > 0)) return sweep;

  std::vector<double> phases;
  for (const ResidualRow& row : rows) phases.push_back((row.t_ns - low_ns) / (high_ns - low_ns));
  std::vector<Equation> equations;
  if (rates && rows.size() >= kFewestRows) {
    sweep.rates = *rates;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double within = rows[i].point < place.size() ? place[rows[i].point] : 0.5;
      equations.push_back(equation(rows[i], phases[i], sweep.span_s, *rates, within));
    }
    fit(equations, !place.empty(), sweep);
  }
  fill_bins(rows, phases, equations, sweep.bins);
  return sweep;
}

}  // namespace tarmac::metrics
