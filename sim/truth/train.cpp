#include "sim/truth/train.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scenes/paths/hermite7.h"
#include "scenes/paths/quadrature.h"
#include "sim/truth/block_table.h"

namespace tarmac::sim::truth {

namespace {

constexpr double largest_fold_rad = 80 * std::numbers::pi / 180;
constexpr double certified_rad = 1e-10;

/// Butcher's matrix of Gauss-Legendre collocation with three stages.
struct Gauss6 {
  std::array<std::array<double, 3>, 3> a;
  Gauss6() {
    const double r = std::sqrt(15.0);
    a = {{{5.0 / 36, 2.0 / 9 - r / 15, 5.0 / 36 - r / 30},
          {5.0 / 36 + r / 24, 2.0 / 9, 5.0 / 36 - r / 24},
          {5.0 / 36 + r / 30, 2.0 / 9 + r / 15, 5.0 / 36}}};
  }
};
const Gauss6 gauss;

using Angles = std::array<double, Train::max_links>;

constexpr std::size_t block_nodes = 128;
/// 164 m: a good while at any speed that a train drives at.
constexpr std::size_t blocks_in_memory = 64;

using Block = std::vector<std::array<scenes::Hermite7, Train::max_links>>;

}  // namespace

class Train::Solution {
 public:
  Solution(const std::vector<Link>& links, Heading heading, double s_max_m, Problem& problem)
      : links_(links),
        heading_(std::move(heading)),
        count_(static_cast<std::size_t>(std::ceil(std::max(0.0, s_max_m) / node_spacing_m)) + 1),
        blocks_(blocks_in_memory, [this](std::size_t index) { return block(index); }) {
    Angles coarse;
    coarse.fill(heading_(0).f);
    Angles fine = coarse;
    for (std::size_t k = 0; k <= count_; ++k) {
      if (k % block_nodes == 0) kept_.push_back(fine);
      for (std::size_t i = 0; i < links_.size(); ++i)
        certificate_rad_ = std::max(certificate_rad_, std::abs(fine[i] - coarse[i]));
      if (problem.message.empty()) watch_folds(static_cast<double>(k) * node_spacing_m, fine, problem);
      coarse = step(k, node_spacing_m, coarse);
      fine = next(k, fine);
    }
    if (certificate_rad_ > certified_rad && problem.message.empty()) {
      problem = {
          0, fmt::format("the train's equations are solved only to {:.1e} rad on this path: turns are too sudden for "
                         "links this short; lengthen blend_m or the links",
                         certificate_rad_)};
    }
  }

  const std::vector<Link>& links() const { return links_; }
  double certificate_rad() const { return certificate_rad_; }

  std::array<Jet, max_links> headings(double s_m) const {
    const auto wanted = static_cast<std::size_t>(std::max(0.0, s_m / node_spacing_m));
    const std::size_t k = std::min(wanted, count_ - 1);
    const double x = s_m / node_spacing_m - static_cast<double>(k);
    const std::shared_ptr<const Block> block = blocks_.get(k / block_nodes);
    std::array<Jet, max_links> result{};
    for (std::size_t link = 0; link < links_.size(); ++link)
      result[link] = scenes::evaluate((*block)[k % block_nodes][link], x, 1 / node_spacing_m);
    return result;
  }

 private:
  void watch_folds(double s_m, const Angles& theta, Problem& problem) const {
    double before = heading_(s_m).f;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const double fold = std::abs(before - theta[i]);
      if (fold > largest_fold_rad && problem.message.empty()) {
        problem = {s_m,
                   fmt::format("link {} folds by {:.0f} deg at {:.1f} m along the tug's path (more than 80 deg: it "
                               "jack-knifes): wider turns, or shorter links",
                               i + 1, fold * 180 / std::numbers::pi, s_m)};
      }
      before = theta[i];
    }
  }

  Angles slopes(const Jet& tug, const Angles& theta) const {
    Angles slope{};
    double psi = tug.f, turn = tug.d1, v = 1;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const auto [a, L] = links_[i];
      const double s = std::sin(psi - theta[i]), c = std::cos(psi - theta[i]);
      slope[i] = (v * s - a * turn * c) / L;
      v = v * c + a * turn * s;
      psi = theta[i], turn = slope[i];
    }
    return slope;
  }

  /// The k-th step of this length.
  Angles step(std::size_t k, double step_m, const Angles& from) const {
    std::array<Jet, 3> tug;
    std::array<Angles, 3> slope;
    for (int j = 0; j < 3; ++j) {
      tug[j] = heading_((static_cast<double>(k) + scenes::Gauss3::node[j]) * step_m);
      slope[j] = slopes(tug[j], from);
    }
    // Each round gains a factor of step / length: a dozen leave nothing but rounding.
    for (int round = 0; round < 12; ++round) {
      for (int j = 0; j < 3; ++j) {
        Angles stage = from;
        for (std::size_t i = 0; i < links_.size(); ++i)
          for (int l = 0; l < 3; ++l) stage[i] += step_m * gauss.a[j][l] * slope[l][i];
        slope[j] = slopes(tug[j], stage);
      }
    }
    Angles theta = from;
    for (std::size_t i = 0; i < links_.size(); ++i)
      for (int j = 0; j < 3; ++j) theta[i] += step_m * scenes::Gauss3::weight[j] * slope[j][i];
    return theta;
  }

  /// From node k to the node after it, in two steps.
  Angles next(std::size_t k, const Angles& from) const {
    return step(2 * k + 1, node_spacing_m / 2, step(2 * k, node_spacing_m / 2, from));
  }

  std::array<Jet, max_links> complete(const Jet& tug, const Angles& theta) const {
    std::array<Jet, max_links> jets{};
    Jet psi = tug, v{1};
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const auto [a, L] = links_[i];
      Jet& angle = jets[i];
      angle.f = theta[i];
      const Jet turn = derivative(psi);
      SinCos fold;
      // Each pass gives one derivative more.
      for (int pass = 0; pass < 3; ++pass) {
        fold = sin_cos(psi - angle);
        const Jet slope = (1 / L) * (v * fold.sin - a * (turn * fold.cos));
        angle.d1 = slope.f;
        if (pass > 0) angle.d2 = slope.d1;
        if (pass > 1) angle.d3 = slope.d2;
      }
      fold = sin_cos(psi - angle);
      v = v * fold.cos + a * (turn * fold.sin);
      psi = angle;
    }
    return jets;
  }

  Block block(std::size_t index) const {
    const std::size_t first = index * block_nodes, end = std::min(first + block_nodes, count_);
    const auto node = [&](std::size_t k, const Angles& theta) {
      return complete(heading_(static_cast<double>(k) * node_spacing_m), theta);
    };
    Block result(end - first);
    Angles theta = kept_[index];
    std::array<Jet, max_links> before = node(first, theta);
    for (std::size_t k = first; k < end; ++k) {
      theta = next(k, theta);
      const std::array<Jet, max_links> after = node(k + 1, theta);
      for (std::size_t i = 0; i < links_.size(); ++i)
        result[k - first][i] =
            scenes::hermite7(scenes::extended(before[i]), scenes::extended(after[i]), node_spacing_m);
      before = after;
    }
    return result;
  }

  std::vector<Link> links_;
  Heading heading_;
  std::size_t count_;         ///< of intervals
  std::vector<Angles> kept_;  ///< at the first node of every block
  double certificate_rad_ = 0;
  BlockTable<Block> blocks_;
};

Train::Train(const std::vector<Link>& links, Heading heading, double s_max_m, Problem& problem)
    : solution_(std::make_shared<const Solution>(links, std::move(heading), s_max_m, problem)) {}

const std::vector<Train::Link>& Train::links() const {
  return solution_->links();
}

double Train::certificate_rad() const {
  return solution_->certificate_rad();
}

std::array<Jet, Train::max_links> Train::headings(double s_m) const {
  return solution_->headings(s_m);
}

Jet Train::speed_ratio(const Jet& tug_heading, const std::array<Jet, max_links>& headings) const {
  Jet psi = tug_heading, v{1};
  for (std::size_t i = 0; i < links().size(); ++i) {
    const SinCos fold = sin_cos(psi - headings[i]);
    v = v * fold.cos + links()[i].hitch_m * (derivative(psi) * fold.sin);
    psi = headings[i];
  }
  return v;
}

}  // namespace tarmac::sim::truth
