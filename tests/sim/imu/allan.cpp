#include "tests/sim/imu/allan.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

namespace tarmac::tests {

std::vector<double> running_sum(std::span<const double> values) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) sums[k + 1] = sums[k] + values[k];
  return sums;
}

namespace {

double by_step(std::span<const double> sums, std::size_t m, std::size_t step) {
  double total = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k + 2 * m < sums.size(); k += step, ++count) {
    const double difference = (sums[k + 2 * m] - 2 * sums[k + m] + sums[k]) / static_cast<double>(m);
    total += difference * difference;
  }
  return total / (2 * static_cast<double>(count));
}

}  // namespace

double overlapped_allan_variance(std::span<const double> sums, std::size_t m) {
  return by_step(sums, m, 1);
}
double allan_variance(std::span<const double> sums, std::size_t m) {
  return by_step(sums, m, m);
}

double NoiseModel::covariance(std::size_t m, std::size_t lag) const {
  const double n = static_cast<double>(m), x = 1 / (rate_hz * bias_tau_s);
  const double one_minus_phi = -std::expm1(-x), one_minus_phi_m = -std::expm1(-n * x);
  const double scale = std::pow(bias_sigma / (n * one_minus_phi), 2);
  if (lag > 0) return scale * std::exp(-x * (static_cast<double>(lag - 1) * n + 1)) * one_minus_phi_m * one_minus_phi_m;
  const double phi = std::exp(-x);
  return density * density * rate_hz / n + scale * (n * one_minus_phi * (1 + phi) - 2 * phi * one_minus_phi_m);
}

double NoiseModel::allan_variance(std::size_t m) const {
  return covariance(m, 0) - covariance(m, 1);
}

NoiseModel::Band NoiseModel::band(std::size_t m, std::size_t n, std::size_t curves, double probability) const {
  const std::size_t differences = n / m - 1;
  std::vector<double> r(differences + 2);
  for (std::size_t lag = 0; lag < r.size(); ++lag) r[lag] = covariance(m, lag);
  // Of neighbours' differences d_k: the variance of sum d^2 is 2 sum over k, l of cov(d_k, d_l)^2.
  const double c0 = 2 * (r[0] - r[1]);
  double squares = static_cast<double>(differences) * c0 * c0;
  for (std::size_t lag = 1; lag < differences; ++lag) {
    const double c = 2 * r[lag] - r[lag - 1] - r[lag + 1];
    squares += 2 * static_cast<double>(differences - lag) * c * c;
  }
  const double count = static_cast<double>(differences);
  const double freedom = static_cast<double>(curves) * count * count * c0 * c0 / squares;
  const boost::math::chi_squared chi2(freedom);
  const double outside = (1 - probability) / 2, mean = allan_variance(m);
  return {mean * boost::math::quantile(chi2, outside) / freedom,
          mean * boost::math::quantile(boost::math::complement(chi2, outside)) / freedom};
}

double continuous_allan_variance(const NoiseModel& s, double T) {
  const double tau = s.bias_tau_s;
  return s.density * s.density / T + 2 * s.bias_sigma * s.bias_sigma * tau / T *
                                         (1 - tau / (2 * T) * (3 - 4 * std::exp(-T / tau) + std::exp(-2 * T / tau)));
}

}  // namespace tarmac::tests
