#include "core/knots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace tarmac::core {
namespace {

void check_spacing(Duration spacing) {
  if (spacing.count() <= 0) {
    throw InputError(fmt::format("knots need a spacing above 0 ns, not {} ns", spacing.count()));
  }
}

/// Appends knots from `next` (called with the last knot) until `beyond` lie after `until`.
template <class Next>
std::vector<Time> place(Time last, Time until, int beyond, const Next& next) {
  std::vector<Time> knots;
  for (int after = 0; after < beyond;) {
    last = next(last);
    knots.push_back(last);
    after += last > until;
  }
  return knots;
}

int density(double excitation, const ExcitationRule& rule) {
  int knots = 1;
  for (const double bound : rule.bounds) knots += excitation >= bound;
  return knots;
}

}  // namespace

int missing_knots(std::span<const Time> knots, Time until, int order) {
  const auto after = knots.end() - std::upper_bound(knots.begin(), knots.end(), until);
  return std::max(0, order - static_cast<int>(after));
}

std::vector<Time> uniform_spline_knots(int order, Time begin, Time end, Duration spacing) {
  check_spacing(spacing);
  if (end < begin) {
    throw InputError(
        fmt::format("knots over a span that ends ({} ns) before it begins ({} ns)", to_ns(end), to_ns(begin)));
  }
  return uniform_knots(begin - order * spacing, end, order, spacing);
}

std::vector<Time> with_margins(int order, std::span<const Time> inner) {
  if (inner.size() < 2) throw InputError(fmt::format("a spline needs two knots or more, not {}", inner.size()));
  for (std::size_t i = 1; i < inner.size(); ++i) {
    if (inner[i] <= inner[i - 1]) {
      throw InputError(fmt::format("knot {} at {} ns does not come after the one before at {} ns", i, to_ns(inner[i]),
                                   to_ns(inner[i - 1])));
    }
  }
  const Duration first = inner[1] - inner[0], last = inner.back() - inner[inner.size() - 2];
  std::vector<Time> knots;
  for (int i = order - 1; i > 0; --i) knots.push_back(inner.front() - i * first);
  knots.insert(knots.end(), inner.begin(), inner.end());
  for (int i = 1; i < order; ++i) knots.push_back(inner.back() + i * last);
  return knots;
}

std::vector<Time> uniform_knots(Time last, Time until, int beyond, Duration spacing) {
  check_spacing(spacing);
  return place(last, until, beyond, [&](Time t) { return t + spacing; });
}

std::vector<Time> sweep_knots(Time last, Time sweep_end, int beyond, Duration period) {
  check_spacing(period);
  const Time anchor = sweep_end + Duration(1);
  // The first of the anchor's multiples of a period that lies at least half a period after `last`; the anchor itself
  // where that is still to come.
  const auto next = [&](Time t) {
    const std::int64_t gap_ns = (t + period / 2 - anchor).count(), period_ns = period.count();
    const std::int64_t periods = gap_ns <= 0 ? 0 : (gap_ns + period_ns - 1) / period_ns;
    return anchor + periods * period;
  };
  return place(last, sweep_end, beyond, next);
}

int knots_per_slot(std::span<const ImuSample> samples, const ExcitationRule& rule) {
  if (samples.empty()) throw InputError("the excitation of a slot without IMU samples is unknown");
  double gyro_rad_s = 0;
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  for (const ImuSample& sample : samples) {
    gyro_rad_s += sample.gyro_rad_s.norm();
    accel_m_s2 += sample.accel_m_s2;
  }
  const double n = static_cast<double>(samples.size());
  const double accel_excess_m_s2 = std::abs((accel_m_s2 / n).norm() - rule.gravity_m_s2);
  return std::max(density(gyro_rad_s / n, rule), density(accel_excess_m_s2, rule));
}

std::vector<Time> excitation_knots(Time last, Time until, int beyond, std::span<const ImuSample> samples,
                                   const ExcitationRule& rule) {
  check_spacing(rule.slot);
  const auto at_or_after = [&](Time t) {
    return std::lower_bound(samples.begin(), samples.end(), t, [](const ImuSample& s, Time u) { return s.t < u; });
  };
  const auto within = [&](Time begin, Time end) { return std::span(at_or_after(begin), at_or_after(end)); };
  const auto density_of = [&](Time slot_begin) {
    const auto own = within(slot_begin, slot_begin + rule.slot);
    if (!own.empty()) return knots_per_slot(own, rule);
    const auto before = at_or_after(slot_begin);
    if (before == samples.begin()) return 1;
    const Time newest = std::prev(before)->t;
    return knots_per_slot(within(newest - rule.slot + Duration(1), newest + Duration(1)), rule);
  };
  Time slot_begin = last;
  int placed = 0, count = density_of(last);
  return place(last, until, beyond, [&](Time) {
    if (placed == count) {
      slot_begin += rule.slot;
      placed = 0;
      count = density_of(slot_begin);
    }
    ++placed;
    return slot_begin + rule.slot * placed / count;
  });
}

}  // namespace tarmac::core
