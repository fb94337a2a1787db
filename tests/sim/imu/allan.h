/// Allan variance: measured from samples, and in closed form for white noise with a first-order Gauss-Markov bias.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tarmac::tests {

/// Sums of the first 0, 1, ..., n values: all cluster means come of it.
std::vector<double> running_sum(std::span<const double> values);

/// Clusters of m samples, at every start (overlapped): mean of (y_{k+m} - y_k)^2 / 2 over cluster means y.
double overlapped_allan_variance(std::span<const double> sums, std::size_t m);
/// Clusters side by side.
double allan_variance(std::span<const double> sums, std::size_t m);

/// White noise of density N [unit/sqrt(Hz)] and a Gauss-Markov bias (sigma, tau), both sampled at `rate_hz`.
struct NoiseModel {
  double rate_hz = 100, density = 0, bias_sigma = 0, bias_tau_s = 1;

  /// Covariance of the means of two clusters of m samples that are `lag` clusters apart. With phi = exp(-dt / tau):
  ///   lag 0:   N^2 / (m dt) + (sigma / m)^2 [m (1 - phi^2) - 2 phi (1 - phi^m)] / (1 - phi)^2
  ///   lag l:   (sigma / m)^2 phi^((l - 1) m + 1) [(1 - phi^m) / (1 - phi)]^2
  double covariance(std::size_t m, std::size_t lag) const;
  /// (covariance at lag 0) - (covariance at lag 1).
  double allan_variance(std::size_t m) const;
  /// Within which the mean of `curves` measured (clusters side by side, n samples each) lies with `probability`: the
  /// scatter of a quadratic form of Gaussians, as chi-square of the same mean and variance.
  struct Band {
    double low, high;
  };
  Band band(std::size_t m, std::size_t n, std::size_t curves, double probability) const;
};

/// The same in continuous time: N^2 / T + 2 sigma^2 tau / T [1 - tau / (2 T) (3 - 4 exp(-T / tau) + exp(-2 T / tau))].
double continuous_allan_variance(const NoiseModel& model, double cluster_s);

}  // namespace tarmac::tests
