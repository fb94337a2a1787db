#include "scenes/open_apron/clutter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "core/random.h"

namespace tarmac::scenes {

using Eigen::Vector2d;

namespace {

/// Items by square cells, so that neighbours are found without asking all.
class Neighbours {
 public:
  explicit Neighbours(double reach_m) : cell_m_(reach_m) {}

  void add(const ClutterItem& item, double radius_m) {
    cells_[cell(item.x_m, item.y_m)].push_back({Vector2d(item.x_m, item.y_m), radius_m});
  }
  bool clear(const Vector2d& p, double radius_m, double gap_m) const {
    for (const double dx : {-cell_m_, 0.0, cell_m_}) {
      for (const double dy : {-cell_m_, 0.0, cell_m_}) {
        const auto found = cells_.find(cell(p.x() + dx, p.y() + dy));
        if (found == cells_.end()) continue;
        for (const Circle& c : found->second) {
          if ((p - c.centre).norm() < radius_m + c.radius_m + gap_m) return false;
        }
      }
    }
    return true;
  }

 private:
  struct Circle {
    Vector2d centre;
    double radius_m;
  };
  std::int64_t cell(double x, double y) const {
    return static_cast<std::int64_t>(std::floor(x / cell_m_)) * 1'000'003 +
           static_cast<std::int64_t>(std::floor(y / cell_m_));
  }
  double cell_m_;
  std::unordered_map<std::int64_t, std::vector<Circle>> cells_;
};

std::size_t pick(const std::vector<double>& weight, double share) {
  double left = share * std::accumulate(weight.begin(), weight.end(), 0.0);
  for (std::size_t k = 0; k < weight.size(); ++k) {
    if (left < weight[k]) return k;
    left -= weight[k];
  }
  return weight.size() - 1;
}

}  // namespace

std::vector<ClutterItem> scatter(const ClutterField& field, double per_m2, std::uint64_t seed, const char* stream) {
  const core::RandomStream random(seed, stream);
  const Vector2d size = field.high_m - field.low_m;
  const auto wanted = static_cast<std::uint64_t>(std::llround(per_m2 * size.prod()));
  Neighbours taken(2 * *std::ranges::max_element(field.radius_m) + field.gap_m);
  std::vector<ClutterItem> items;
  // Candidates come in a fixed order, whatever the density. One that falls where nothing may stand has had its turn: so
  // the density beside the lane does not depend on how much of the field the lane takes. One that would touch another
  // is drawn again.
  for (std::uint64_t k = 0, turns = 0; turns < wanted && k < 40 * wanted; ++k) {
    const std::size_t kind = pick(field.weight, random.uniform(k, 0));
    const Vector2d p = field.low_m + size.cwiseProduct(Vector2d(random.uniform(k, 1), random.uniform(k, 2)));
    const double radius = field.radius_m[kind];
    if (field.free_m(p) < radius) {
      ++turns;
      continue;
    }
    if (!taken.clear(p, radius, field.gap_m)) continue;
    ++turns;
    items.push_back({kind, p.x(), p.y(), 2 * std::numbers::pi * random.uniform(k, 3)});
    taken.add(items.back(), radius);
  }
  return items;
}

}  // namespace tarmac::scenes
