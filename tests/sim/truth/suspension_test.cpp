#include "sim/truth/suspension.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <thread>
#include <vector>

#include "sim/truth/block_table.h"

namespace tarmac::sim::truth {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;
const std::array<Suspension::Oscillator, 3> modes{{{1.4, 0.3}, {1.6, 0.3}, {4.75, 0.07}}};

/// Steady answer of one mode to F = A sin(W t): imaginary part of A exp(iWt) / (w^2 - W^2 + 2 i zeta w W).
Jet steady_answer(const Suspension::Oscillator& mode, double amplitude, double W, double t) {
  using Complex = std::complex<double>;
  const double w = two_pi * mode.frequency_hz;
  const Complex i(0, 1);
  const Complex q = amplitude * std::exp(i * W * t) / (w * w - W * W + 2.0 * i * mode.damping * w * W);
  return {q.imag(), (i * W * q).imag(), (i * W * i * W * q).imag(), (i * W * i * W * i * W * q).imag()};
}

TEST(Suspension, MatchesTheClosedFormUnderAConstantFrequency) {
  for (const double hz : {0.7, 6.0, 40.0}) {
    const double W = two_pi * hz;
    const auto forcing = [&](double t) {
      const Jet F{3 * std::sin(W * t), 3 * W * std::cos(W * t), 0, 0};
      return std::array<Jet, 3>{F, F, F};
    };
    std::array<double, 3> q, q_dot;
    for (int m = 0; m < 3; ++m) {
      q[m] = steady_answer(modes[m], 3, W, 0).f;
      q_dot[m] = steady_answer(modes[m], 3, W, 0).d1;
    }
    const Suspension suspension(modes, forcing, 20, q, q_dot);
    for (double t = 0; t < 20; t += 0.01237) {
      const auto got = suspension.at(t);
      for (int m = 0; m < 3; ++m) {
        const Jet want = steady_answer(modes[m], 3, W, t);
        ASSERT_NEAR(got[m].f, want.f, 1e-10) << hz << " Hz, mode " << m << ", t = " << t;  // wanted: 1e-6
        ASSERT_NEAR(got[m].d1, want.d1, 1e-8) << hz << " Hz, mode " << m << ", t = " << t;
        ASSERT_NEAR(got[m].d2, want.d2, 1e-5) << hz << " Hz, mode " << m << ", t = " << t;
      }
    }
  }
}

TEST(Suspension, FreeDecayMatchesTheClosedForm) {
  const auto nothing = [](double) { return std::array<Jet, 3>{}; };
  const Suspension suspension(modes, nothing, 5, {0.01, 0.01, 0.01}, {0, 0, 0});
  for (double t = 0; t < 5; t += 0.0173) {
    for (int m = 0; m < 3; ++m) {
      const double w = two_pi * modes[m].frequency_hz, z = modes[m].damping, wd = w * std::sqrt(1 - z * z);
      const double want = 0.01 * std::exp(-z * w * t) * (std::cos(wd * t) + z * w / wd * std::sin(wd * t));
      ASSERT_NEAR(suspension.at(t)[m].f, want, 1e-15) << t;
    }
  }
}

/// Joints are cos^4 dips: their fourth derivative jumps, wherever the nodes happen to be.
TEST(Suspension, CrossesAJointAsTenMicrosecondRungeKuttaDoes) {
  const double w = two_pi * modes[0].frequency_hz, damping = 2 * modes[0].damping * w;
  const auto joint = [&](double t) {
    const double k = std::numbers::pi / 0.16, x = 7 * (t - 0.05037);
    if (std::abs(x) > 0.08) return Jet{};
    const double c = std::cos(k * x), s = std::sin(k * x);
    const Jet dip =
        -0.0015 * Jet{c * c * c * c, -4 * k * c * c * c * s, k * k * (12 * c * c * s * s - 4 * c * c * c * c), 0};
    return Jet{dip.f, 7 * dip.d1, 49 * dip.d2, 0};
  };
  const auto force = [&](double t) { return w * w * joint(t) + damping * derivative(joint(t)); };
  const Suspension suspension({modes[0], modes[0], modes[0]},
                              [&](double t) {
                                return std::array<Jet, 3>{force(t), force(t), force(t)};
                              },
                              0.5, {0, 0, 0}, {0, 0, 0});
  const auto acceleration = [&](double t, double q, double v) { return force(t).f - damping * v - w * w * q; };
  constexpr double h = 1e-5;
  double q = 0, v = 0;
  for (int k = 0; k < 50000; ++k) {
    const double t = k * h;
    const auto got = suspension.at(t)[0];
    ASSERT_NEAR(got.f, q, 1e-9) << t;
    ASSERT_NEAR(got.d1, v, 1e-7) << t;
    const double a1 = acceleration(t, q, v), a2 = acceleration(t + h / 2, q + h / 2 * v, v + h / 2 * a1);
    const double a3 = acceleration(t + h / 2, q + h / 2 * v + h * h / 4 * a1, v + h / 2 * a2);
    const double a4 = acceleration(t + h, q + h * v + h * h / 2 * a2, v + h * a3);
    q += h * v + h * h / 6 * (a1 + a2 + a3);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
}

TEST(Suspension, DerivativesAreContinuousAcrossNodes) {
  const auto forcing = [](double t) {
    const double W = two_pi * 20;
    const Jet F{0.1 * std::sin(W * t * t), 0.2 * W * t * std::cos(W * t * t), 0, 0};
    return std::array<Jet, 3>{F, F, F};
  };
  const Suspension suspension(modes, forcing, 2, {1e-3, 1e-3, 1e-3}, {0, 0, 0});
  for (int k = 100; k < 1900; k += 7) {
    const double node = k * Suspension::node_spacing_s;
    const auto before = suspension.at(node - 1e-12), after = suspension.at(node + 1e-12);
    for (int m = 0; m < 3; ++m) {
      ASSERT_NEAR(before[m].f, after[m].f, 1e-11);
      ASSERT_NEAR(before[m].d1, after[m].d1, 1e-9);
      ASSERT_NEAR(before[m].d2, after[m].d2, 1e-9);
    }
  }
}

/// Blocks that were dropped are made again, to the last bit: forwards, backwards and from four threads at once.
TEST(Suspension, AnswersTheSameInWhateverOrderItIsAsked) {
  const auto forcing = [](double t) {
    const Jet F{std::sin(3 * t) + std::cos(17 * t), 3 * std::cos(3 * t) - 17 * std::sin(17 * t), 0, 0};
    return std::array<Jet, 3>{F, 0.5 * F, -2 * F};
  };
  const Suspension suspension(modes, forcing, 200, {0, 0, 0}, {0, 0, 0});
  constexpr int count = 500;
  const auto ask = [&](int i) {
    std::vector<double> values;
    for (const Jet& q : suspension.at(0.4 * i + 0.0371)) values.insert(values.end(), {q.f, q.d1, q.d2, q.d3});
    return values;
  };
  std::vector<std::vector<double>> forwards;
  for (int i = 0; i < count; ++i) forwards.push_back(ask(i));
  for (int i = count - 1; i >= 0; --i) ASSERT_EQ(ask(i), forwards[static_cast<std::size_t>(i)]) << i;
  std::vector<int> wrong(4, 0);
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread)
      threads.emplace_back([&, thread] {
        for (int i = 0; i < count; ++i) {
          const int k = (i * (2 * thread + 7)) % count;
          wrong[static_cast<std::size_t>(thread)] += ask(k) != forwards[static_cast<std::size_t>(k)];
        }
      });
  }
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(Suspension, ShowsEveryNodeAsItIsSolved) {
  const auto forcing = [](double t) { return std::array<Jet, 3>{Jet{std::sin(t), std::cos(t), 0, 0}, Jet{}, Jet{}}; };
  std::vector<std::pair<double, std::array<Jet, 3>>> seen;
  const Suspension suspension(modes, forcing, 1, {1e-3, 0, 0}, {0, 0, 0},
                              [&](double t_s, const std::array<Jet, 3>& q) { seen.emplace_back(t_s, q); });
  ASSERT_EQ(seen.size(), 1001u);
  for (const auto& [t_s, q] : seen) {
    const std::array<Jet, 3> table = suspension.at(t_s);
    for (int m = 0; m < 3; ++m) {
      ASSERT_NEAR(q[m].f, table[m].f, 1e-15) << t_s;
      ASSERT_NEAR(q[m].d2, table[m].d2, 1e-9) << t_s;
    }
  }
}

TEST(BlockTable, KeepsWhatItHasRoomForAndMakesTheRestAgain) {
  std::vector<std::size_t> made;
  const BlockTable<std::size_t> table(4, [&](std::size_t index) {
    made.push_back(index);
    return 10 * index;
  });
  for (const std::size_t index : {0u, 1u, 2u, 3u, 0u, 3u, 4u, 1u, 0u}) EXPECT_EQ(*table.get(index), 10 * index);
  EXPECT_EQ(made, (std::vector<std::size_t>{0, 1, 2, 3, 4, 0}));
  table.put(5, std::make_shared<const std::size_t>(50));
  EXPECT_EQ(*table.get(5), 50u);
  EXPECT_EQ(made.size(), 6u);
}

TEST(BlockTable, HasMoreRoomForWhoGoesThroughItAgainAndAgain) {
  std::size_t made = 0;
  const BlockTable<std::size_t> table(4, [&](std::size_t index) {
    ++made;
    return 10 * index;
  });
  const auto pass = [&] {
    const std::size_t before = made;
    for (std::size_t index = 0; index < 16; ++index) EXPECT_EQ(*table.get(index), 10 * index);
    return made - before;
  };
  for (int k = 0; k < 6; ++k) EXPECT_EQ(pass(), 16u) << "a few times cost no memory";
  for (int k = 0; k < 24; ++k) pass();
  EXPECT_EQ(pass(), 0u);
}

}  // namespace
}  // namespace tarmac::sim::truth
