#include "core/gp_prior.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using WideMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

struct AxisCase {
  GpModel model;
  double rate;
};

/// Singer's rates from none to very fast: with the spans below, a d runs over the switch at 1 from 1e-7 to 1e4.
std::vector<AxisCase> every_axis() {
  std::vector<AxisCase> cases = {{GpModel::wnoa, 0}, {GpModel::wnoj, 0}, {GpModel::singer, 0}};
  for (int k = -8; k <= 8; ++k) cases.push_back({GpModel::singer, std::pow(10.0, 0.5 * k)});
  return cases;
}
constexpr double kSpans[] = {1e-3, 0.01, 0.099, 0.1, 0.101, 0.5, 1 - 1e-9, 1, 1 + 1e-9, 3, 10};

/// Phi and Q by the matrix exponential of Van Loan's block matrix, in long double: knows nothing of either closed form.
void van_loan(const AxisCase& c, double d, WideMatrix& Phi, WideMatrix& Q) {
  const int n = gp_order(c.model);
  WideMatrix M = WideMatrix::Zero(2 * n, 2 * n);
  for (int i = 0; i + 1 < n; ++i) M(i, i + 1) = 1;
  if (c.model == GpModel::singer) M(n - 1, n - 1) = -c.rate;
  M.bottomRightCorner(n, n) = -M.topLeftCorner(n, n).transpose();
  M(n - 1, 2 * n - 1) = 1;
  // exp(M d) = [[Phi, Q Phi^-T], [0, Phi^-T]], by halving until the series is short.
  int halvings = 0;
  long double h = d;
  while (h * (1 + c.rate) > 0.25L) {
    h /= 2;
    ++halvings;
  }
  WideMatrix term = WideMatrix::Identity(2 * n, 2 * n), sum = term;
  for (int k = 1; k < 30; ++k) {
    term = (term * M * (h / static_cast<long double>(k))).eval();
    sum += term;
  }
  Phi = sum.topLeftCorner(n, n);
  Q = sum.topRightCorner(n, n) * Phi.transpose();
  for (; halvings > 0; --halvings) {
    Q = (Phi * Q * Phi.transpose() + Q).eval();
    Phi = (Phi * Phi).eval();
  }
}

/// Largest difference of two matrices, each entry in units of the geometric mean of its diagonal entries.
double scaled_difference(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  double worst = 0;
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      worst = std::max(worst, std::abs(A(i, j) - B(i, j)) / std::sqrt(B(i, i) * B(j, j)));
    }
  }
  return worst;
}

TEST(GpAxis, TransitionAndNoiseAreThoseOfTheDifferentialEquation) {
  for (const AxisCase& c : every_axis()) {
    for (const double d : kSpans) {
      WideMatrix Phi, Q;
      van_loan(c, d, Phi, Q);
      const GpBlock noise = gp_noise(c.model, c.rate, d);
      EXPECT_LT(scaled_difference(noise, Q.cast<double>()), 1e-13) << "rate " << c.rate << " d " << d;
      const Eigen::MatrixXd difference = gp_transition(c.model, c.rate, d) - Phi.cast<double>();
      EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-14 * (1 + d * d)) << "rate " << c.rate << " d " << d;
    }
  }
}

TEST(GpAxis, NoiseComposesAcrossTheSwitch) {
  for (const AxisCase& c : every_axis()) {
    for (const double d1 : kSpans) {
      for (const double d2 : kSpans) {
        const GpBlock Phi = gp_transition(c.model, c.rate, d2);
        const GpBlock composed = Phi * gp_noise(c.model, c.rate, d1) * Phi.transpose() + gp_noise(c.model, c.rate, d2);
        EXPECT_LT(scaled_difference(composed, gp_noise(c.model, c.rate, d1 + d2)), 1e-13)
            << "rate " << c.rate << " d1 " << d1 << " d2 " << d2;
        const GpBlock steps = gp_transition(c.model, c.rate, d2) * gp_transition(c.model, c.rate, d1);
        const GpBlock whole = gp_transition(c.model, c.rate, d1 + d2);
        EXPECT_LT((steps - whole).cwiseAbs().maxCoeff(), 1e-13 * whole.cwiseAbs().maxCoeff());
      }
    }
  }
}

TEST(GpAxis, NoiseIsPositiveDefiniteAndItsInverseIsItsInverse) {
  for (const AxisCase& c : every_axis()) {
    for (const double d : kSpans) {
      const GpBlock Q = gp_noise(c.model, c.rate, d);
      // In units of its own standard deviations: the bound of Hilbert's 3 x 3 matrix is 1e-3 or so.
      const Eigen::VectorXd unit = Q.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::MatrixXd correlation = unit.asDiagonal() * Q * unit.asDiagonal();
      EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation).eigenvalues()[0], 1e-3)
          << "rate " << c.rate << " d " << d;
      const GpBlock I = gp_noise_inverse(c.model, c.rate, d);
      EXPECT_EQ((I - I.transpose()).norm(), 0);
      const Eigen::MatrixXd product =
          unit.asDiagonal() * (Q * I) * unit.cwiseInverse().asDiagonal();  // units cancel, too
      EXPECT_LT((product - Eigen::MatrixXd::Identity(Q.rows(), Q.rows())).norm(), 1e-9) << c.rate << " d " << d;
    }
  }
}

TEST(GpAxis, SlowForgettingIsWnoj) {
  for (const double d : kSpans) {
    EXPECT_LT(scaled_difference(gp_noise(GpModel::singer, 0, d), gp_noise(GpModel::wnoj, 0, d)), 1e-15) << d;
    EXPECT_LT(scaled_difference(gp_noise(GpModel::singer, 1e-9 / d, d), gp_noise(GpModel::wnoj, 0, d)), 2e-9) << d;
    EXPECT_LT((gp_transition(GpModel::singer, 0, d) - gp_transition(GpModel::wnoj, 0, d)).norm(), 1e-15) << d;
  }
}

/// White noise on acceleration of density qc is what an acceleration of density qc a^2 that forgets itself at once is.
TEST(GpAxis, FastForgettingIsWnoa) {
  for (const double d : {0.01, 0.1, 1.0}) {
    const double rate = 1e7 / d;
    const Eigen::Matrix2d limit = gp_noise(GpModel::wnoa, 0, d);
    const Eigen::Matrix2d singer = rate * rate * gp_noise(GpModel::singer, rate, d).topLeftCorner(2, 2);
    EXPECT_LT(scaled_difference(singer, limit), 1e-6) << d;
    const GpBlock Phi = gp_transition(GpModel::singer, rate, d);
    EXPECT_LT((Phi.topLeftCorner(2, 2) - gp_transition(GpModel::wnoa, 0, d)).norm(), 1e-15);
    EXPECT_LT(Phi.topRightCorner(2, 1).norm() * rate, 1 + d);
  }
}

TEST(GpPrior, HasOneBlockAnAxisInItsOwnUnits) {
  GpPrior prior;
  prior.model = GpModel::singer;
  prior.qc << 1, 2, 3, 4, 5, 6;
  prior.rate << 0, 1e-3, 0.5, 3, 20, 400;
  const double d = 0.1;
  const Eigen::MatrixXd Q = prior.noise(d), I = prior.information(d), Phi = prior.transition(d);
  ASSERT_EQ(Q.rows(), 18);
  for (int a = 0; a < 6; ++a) {
    const GpBlock axis = prior.qc[a] * gp_noise(GpModel::singer, prior.rate[a], d);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        EXPECT_EQ(Q(6 * i + a, 6 * j + a), axis(i, j));
        EXPECT_EQ(Phi(6 * i + a, 6 * j + a), gp_transition(GpModel::singer, prior.rate[a], d)(i, j));
        for (int b = 0; b < 6; ++b) {
          if (b != a) {
            EXPECT_EQ(Q(6 * i + a, 6 * j + b), 0);
            EXPECT_EQ(I(6 * i + a, 6 * j + b), 0);
          }
        }
      }
    }
  }
  const Eigen::VectorXd sigma = Q.diagonal().cwiseSqrt();
  const Eigen::MatrixXd product = sigma.cwiseInverse().asDiagonal() * (Q * I) * sigma.asDiagonal();
  EXPECT_LT((product - Eigen::MatrixXd::Identity(18, 18)).norm(), 1e-9);
}

TEST(GpPrior, RefusesWhatIsNoNoise) {
  GpPrior prior;
  EXPECT_NO_THROW(prior.check());
  prior.qc[3] = -1;
  EXPECT_THAT(tests::message_of<InputError>([&] { prior.check(); }), ::testing::HasSubstr("must be positive"));
  prior.qc[3] = std::nan("");
  EXPECT_THROW(prior.check(), InputError);
  prior.qc[3] = 1;
  prior.rate[2] = -0.1;
  EXPECT_NO_THROW(prior.check()) << "a rate means nothing to wnoa";
  prior.model = GpModel::singer;
  EXPECT_THROW(prior.check(), InputError);
}

/// The mean between knots by its definition, Psi = Q(d) Phi(T - d)^T Q(T)^-1, Lambda = Phi(d) - Psi Phi(T).
TEST(GpAxis, WeightsAreTheDefinitionsAlsoForTheClosedForms) {
  for (const AxisCase& c : every_axis()) {
    for (const double T : {0.01, 0.1, 1.0}) {
      const int n = gp_order(c.model);
      const GpAxis axis(c.model, c.rate, T);
      WideMatrix Phi_T, Q_T, Phi_d, Q_d, Phi_rest, Q_rest;
      van_loan(c, T, Phi_T, Q_T);
      for (const double r : {0.001, 0.1, 0.5, 0.77, 0.999}) {
        const double d = r * T;
        van_loan(c, d, Phi_d, Q_d);
        van_loan(c, T - d, Phi_rest, Q_rest);
        const WideMatrix Psi = Q_d * Phi_rest.transpose() * Q_T.ldlt().solve(WideMatrix::Identity(n, n));
        const WideMatrix Lambda = Phi_d - Psi * Phi_T;
        const GpWeights w = axis.weights(d);
        for (int i = 0; i < n; ++i) {
          for (int j = 0; j < n; ++j) {
            const auto row = static_cast<std::size_t>(i), column = static_cast<std::size_t>(j);
            const double unit = std::pow(T, j - i);
            EXPECT_NEAR(w.Psi[row][column] / unit, static_cast<double>(Psi(i, j)) / unit, 2e-12)
                << "rate " << c.rate << " T " << T << " r " << r << " " << i << j;
            EXPECT_NEAR(w.Lambda[row][column] / unit, static_cast<double>(Lambda(i, j)) / unit, 2e-12)
                << "rate " << c.rate << " T " << T << " r " << r << " " << i << j;
          }
        }
        // What is left over between both knots, by the textbook; next to the second knot that is a difference of equal
        // numbers to fifteen digits, also in long double.
        if (r > 0.9) continue;
        const WideMatrix left = Q_d - Psi * Phi_rest * Q_d;
        EXPECT_LT(scaled_difference(axis.conditional_noise(d), left.cast<double>()), 1e-9)
            << "rate " << c.rate << " T " << T << " r " << r;
      }
    }
  }
}

/// A bridge pinned at both ends runs backwards as well as forwards where nothing is forgotten: with accelerations'
/// signs and odd rows' turned around, what is left at d is what is left at T - d.
TEST(GpAxis, WhatIsLeftBetweenKnotsIsTheSameFromBothSides) {
  for (const GpModel model : {GpModel::wnoa, GpModel::wnoj}) {
    const GpAxis axis(model, 0, 0.1);
    for (const double d : {1e-5, 1e-3, 0.02, 0.05}) {
      GpBlock other = axis.conditional_noise(0.1 - d);
      for (int i = 0; i < other.rows(); ++i) {
        for (int j = 0; j < other.cols(); ++j) other(i, j) *= (i + j) % 2 == 0 ? 1 : -1;
      }
      EXPECT_LT(scaled_difference(axis.conditional_noise(d), other), 1e-10) << d;
    }
  }
}

TEST(GpAxis, WeightsRowsAreDerivativesOfTheRowsBefore) {
  for (const AxisCase& c : every_axis()) {
    const double T = 0.1;
    const GpAxis axis(c.model, c.rate, T);
    const int n = gp_order(c.model);
    for (const double r : {0.11, 0.5, 0.9}) {
      const double h = 1e-4 * T;
      const auto at = [&](double d) { return axis.weights(d); };
      const GpWeights low = at(r * T - h), high = at(r * T + h), low2 = at(r * T - 2 * h), high2 = at(r * T + 2 * h),
                      here = at(r * T);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < static_cast<std::size_t>(n); ++j) {
          const double unit = std::pow(T, static_cast<double>(j) - static_cast<double>(i) - 1);
          const auto slope = [&](auto member) {
            return (8 * ((high.*member)[i][j] - (low.*member)[i][j]) - ((high2.*member)[i][j] - (low2.*member)[i][j])) /
                   (12 * h);
          };
          // Fast forgetting makes layers of 1/rate at the knots: what is lost to differences grows with (rate T)^3.
          const double bound = 1e-7 * std::max(1.0, std::pow(c.rate * T, 3));
          EXPECT_NEAR(slope(&GpWeights::Psi) / unit, here.Psi[i + 1][j] / unit, bound) << "rate " << c.rate;
          if (j > 0) {
            EXPECT_NEAR(slope(&GpWeights::Lambda) / unit, here.Lambda[i + 1][j] / unit, bound) << "rate " << c.rate;
          }
        }
      }
    }
  }
}

TEST(SingerCurve, IsTheMeansFirstRow) {
  for (int k = -8; k <= 8; ++k) {
    const double rate = k == -8 ? 0 : std::pow(10.0, 0.5 * k);
    for (const double T : {0.01, 0.1, 1.0, 2 - 1e-9, 2 + 1e-9}) {
      const GpAxis axis(GpModel::singer, rate, T);
      const SingerCurve curve(rate, T);
      const Eigen::Vector3d first(0, 0.8, -0.6), second(0.3, -0.7, 0.9);  // already times T^0, T, T^2
      const SingerCurve::Coefficients c = curve.fit(first, second);
      for (const double r : {0.0, 0.001, 0.3, 0.5, 0.9, 1.0}) {
        double C, S;
        const double s = r - 0.5;
        curve.basis(s, C, S);
        const double value = c[0] + s * (c[1] + s * (c[2] + s * c[3])) + c[4] * C + c[5] * S;
        const GpWeights w = axis.weights(r * T);
        double expected = w.Psi[0][0] * second[0];
        for (std::size_t j = 1; j < 3; ++j) {
          const auto i = static_cast<Eigen::Index>(j);
          expected += (w.Lambda[0][j] * first[i] + w.Psi[0][j] * second[i]) / std::pow(T, j);
        }
        EXPECT_NEAR(value, expected, 1e-12) << "rate " << rate << " T " << T << " r " << r;
      }
    }
  }
}

}  // namespace
}  // namespace tarmac::core
