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

Time last_of(std::span<const Time> knots) {
  if (knots.empty()) throw InputError("knots are placed after others, but there are none");
  return knots.back();
}

/// New knots from next(the one before), until the last lies at or after `end` and `beyond` of all after it.
template <class Next>
std::vector<Time> place(std::span<const Time> knots, Time end, int beyond, const Next& next) {
  auto after = knots.end() - std::upper_bound(knots.begin(), knots.end(), end);
  std::vector<Time> added;
  for (Time last = last_of(knots); last < end || after < beyond;) {
    last = next(last);
    added.push_back(last);
    after += last > end;
  }
  return added;
}

int density(double excitation, const ExcitationRule& rule) {
  int knots = 1;
  for (const double bound : rule.bounds) knots += excitation >= bound;
  return knots;
}

}  // namespace

std::vector<Time> uniform_knots(Time begin, Time end, Duration spacing, int order) {
  check_spacing(spacing);
  if (end < begin) {
    throw InputError(
        fmt::format("knots over a span that ends ({} ns) before it begins ({} ns)", to_ns(end), to_ns(begin)));
  }
  const Time before[] = {begin - order * spacing};
  return uniform_knots_after(before, end, spacing, order);
}

std::vector<Time> with_margins(std::span<const Time> inner, int order) {
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

std::vector<Time> uniform_knots_after(std::span<const Time> knots, Time end, Duration spacing, int beyond) {
  check_spacing(spacing);
  return place(knots, end, beyond, [&](Time t) { return t + spacing; });
}

std::vector<Time> sweep_knots_after(std::span<const Time> knots, Time sweep_end, Duration period, int beyond) {
  check_spacing(period);
  const Time anchor = sweep_end + Duration(1);
  // The first of the anchor's multiples of a period that lies at least half a period after `last`; the anchor itself
  // where that is still to come.
  const auto next = [&](Time t) {
    const std::int64_t gap_ns = (t + period / 2 - anchor).count(), period_ns = period.count();
    const std::int64_t periods = gap_ns <= 0 ? 0 : (gap_ns + period_ns - 1) / period_ns;
    return anchor + periods * period;
  };
  return place(knots, sweep_end, beyond, next);
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

std::vector<Time> excitation_knots_after(std::span<const Time> knots, Time end, std::span<const ImuSample> samples,
                                         const ExcitationRule& rule, int beyond) {
  check_spacing(rule.slot);
  const auto at_or_after = [&](Time t) {
    return std::lower_bound(samples.begin(), samples.end(), t, [](const ImuSample& s, Time u) { return s.t < u; });
  };
  const auto within = [&](Time from, Time to) { return std::span(at_or_after(from), at_or_after(to)); };
  const auto density_of = [&](Time slot_begin) {
    const auto own = within(slot_begin, slot_begin + rule.slot);
    if (!own.empty()) return knots_per_slot(own, rule);
    const auto before = at_or_after(slot_begin);
    if (before == samples.begin()) return 1;
    const Time newest = std::prev(before)->t;
    return knots_per_slot(within(newest - rule.slot + Duration(1), newest + Duration(1)), rule);
  };
  Time slot_begin = last_of(knots);
  int placed = 0, count = density_of(slot_begin);
  return place(knots, end, beyond, [&](Time) {
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
