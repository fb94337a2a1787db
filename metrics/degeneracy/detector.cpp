#include "metrics/degeneracy/detector.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace tarmac::metrics {

namespace {

constexpr double kZ95 = 1.959963984540054;

/// Samples [first, last).
struct Stretch {
  std::size_t first = 0, last = 0;
};

std::vector<Stretch> stretches(std::size_t n, const std::function<bool(std::size_t)>& holds) {
  std::vector<Stretch> found;
  for (std::size_t i = 0; i < n;) {
    if (!holds(i)) {
      ++i;
      continue;
    }
    Stretch s{i, i};
    while (s.last < n && holds(s.last)) ++s.last;
    found.push_back(s);
    i = s.last;
  }
  return found;
}

bool any_of(const Stretch& s, const std::function<bool(std::size_t)>& holds) {
  for (std::size_t i = s.first; i < s.last; ++i)
    if (holds(i)) return true;
  return false;
}

/// Mann-Whitney: share of pairs (positive, negative) in which the positive's value is smaller.
std::optional<double> area_under_curve(std::vector<double> positives, std::vector<double> negatives) {
  if (positives.empty() || negatives.empty()) return std::nullopt;
  std::sort(negatives.begin(), negatives.end());
  double won = 0;
  for (const double p : positives) {
    const auto [equal_from, equal_to] = std::equal_range(negatives.begin(), negatives.end(), p);
    won += static_cast<double>(negatives.end() - equal_to) + 0.5 * static_cast<double>(equal_to - equal_from);
  }
  return won / (static_cast<double>(positives.size()) * static_cast<double>(negatives.size()));
}

class Scorer {
 public:
  Scorer(std::span<const DetectorSample> samples, double threshold) : samples_(samples), threshold_(threshold) {}

  bool degenerate(std::size_t i) const { return samples_[i].oracle_lambda && *samples_[i].oracle_lambda < threshold_; }
  bool near(std::size_t i) const {
    const std::optional<double>& lambda = samples_[i].oracle_lambda;
    return lambda && *lambda > threshold_ / kNearThreshold && *lambda < threshold_ * kNearThreshold;
  }
  bool flagged(std::size_t i) const { return samples_[i].flag == DegeneracyClass::degenerate; }
  bool unknown(std::size_t i) const {
    return !samples_[i].oracle_lambda || !samples_[i].lambda || samples_[i].flag == DegeneracyClass::unknown;
  }

  void sweeps(DetectorScores& scores) const {
    std::size_t hits = 0, flags = 0;
    std::vector<double> positives, negatives;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (unknown(i)) {
        ++scores.unknown;
        continue;
      }
      if (near(i)) {
        ++scores.near_threshold;
        continue;
      }
      ++scores.scored;
      scores.positives += degenerate(i);
      flags += flagged(i);
      hits += degenerate(i) && flagged(i);
      (degenerate(i) ? positives : negatives).push_back(*samples_[i].lambda);
    }
    scores.precision = {hits, flags};
    scores.recall = {hits, scores.positives};
    if (flags + scores.positives > 0)
      scores.f1 = 2 * static_cast<double>(hits) / static_cast<double>(flags + scores.positives);
    scores.auc = area_under_curve(std::move(positives), std::move(negatives));
  }

  void events(DetectorScores& scores) const {
    const auto is_degenerate = [this](std::size_t i) { return degenerate(i); };
    const auto is_flagged = [this](std::size_t i) { return flagged(i); };
    const std::vector<Stretch> flags = stretches(samples_.size(), is_flagged);
    std::size_t free_since = 0;  // where the oracle's last event ended
    for (const Stretch& event : stretches(samples_.size(), is_degenerate)) {
      if (event.last - event.first >= kEventSweeps) {
        const bool found = any_of(event, is_flagged);
        ++scores.event_recall.n;
        scores.event_recall.k += found;
        if (found && event.first > 0) scores.lead_s.push_back(lead_s(event, flags, free_since));
      }
      free_since = event.last;
    }
    for (const Stretch& flag : flags) {
      if (flag.last - flag.first < kEventSweeps) continue;
      const bool right = any_of(flag, is_degenerate);
      if (!right && any_of(flag, [this](std::size_t i) { return near(i) || unknown(i); })) continue;
      ++scores.event_precision.n;
      scores.event_precision.k += right;
    }
  }

 private:
  double lead_s(const Stretch& event, const std::vector<Stretch>& flags, std::size_t free_since) const {
    const auto touching = std::find_if(flags.begin(), flags.end(),
                                       [&](const Stretch& f) { return f.first < event.last && f.last > event.first; });
    return samples_[event.first].t_s - samples_[std::max(touching->first, free_since)].t_s;
  }

  std::span<const DetectorSample> samples_;
  double threshold_;
};

/// Centre and half width of Wilson's interval.
std::pair<double, double> wilson(std::size_t k, std::size_t n) {
  const double count = static_cast<double>(n), p = static_cast<double>(k) / count, z2 = kZ95 * kZ95;
  const double centre = (p + z2 / (2 * count)) / (1 + z2 / count);
  const double half = kZ95 / (1 + z2 / count) * std::sqrt(p * (1 - p) / count + z2 / (4 * count * count));
  return {centre, half};
}

}  // namespace

std::optional<double> Proportion::value() const {
  return n ? std::optional(static_cast<double>(k) / static_cast<double>(n)) : std::nullopt;
}

double Proportion::low() const {
  if (n == 0 || k == 0) return 0;
  const auto [centre, half] = wilson(k, n);
  return std::max(0.0, centre - half);
}

double Proportion::high() const {
  if (n == 0 || k == n) return 1;
  const auto [centre, half] = wilson(k, n);
  return std::min(1.0, centre + half);
}

DetectorScores score_detector(std::span<const DetectorSample> samples, double oracle_threshold) {
  DetectorScores scores;
  const Scorer scorer(samples, oracle_threshold);
  scorer.sweeps(scores);
  scorer.events(scores);
  return scores;
}

}  // namespace tarmac::metrics
