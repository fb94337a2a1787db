/// Rules for where the knots of a spline stand (spline_trajectory.h). Pure functions: each returns the knots that come
/// after `last`, until `beyond` of them lie after `until`. `last` is the newest knot there is, `beyond` what
/// missing_knots() says, at least 1.
///
/// A spline of order k covers a time when k knots lie after it, and knots never move once placed. So in a causal method
/// every rule acts ahead of what it knows: the newest sample decides about knots that lie up to k spacings later.
#pragma once

#include <span>
#include <vector>

#include "core/measurements.h"
#include "core/time.h"

namespace tarmac::core {

/// How many of `knots` (ascending) are missing for `order` of them to lie after `until`.
int missing_knots(std::span<const Time> knots, Time until, int order);

/// All knots of a spline of that order over [begin, end]: evenly spaced, the span beginning at `begin` exactly. Throws
/// InputError where spacing is not above zero or end before begin.
std::vector<Time> uniform_spline_knots(int order, Time begin, Time end, Duration spacing);
/// `inner` (ascending, at least two; the span runs from the first to just before the last) with order - 1 further knots
/// on either side, repeating the first and the last spacing.
std::vector<Time> with_margins(int order, std::span<const Time> inner);

/// Every `spacing`. Throws InputError where it is not above zero.
std::vector<Time> uniform_knots(Time last, Time until, int beyond, Duration spacing);

/// One a sweep, a nanosecond after its last firing, so that a sweep's newest control point is as well determined as the
/// others; knots further on at multiples of `period`. What would come closer to `last` than half a period is left out.
std::vector<Time> sweep_knots(Time last, Time sweep_end, int beyond, Duration period);

/// The density of Coco-LIC (Lang et al., RA-L 2023): time after `last` is cut into slots, each with one to four knots
/// at equal distances, the last at the slot's end. Both measures of excitation pick from the same three bounds, the
/// higher one counts.
struct ExcitationRule {
  Duration slot = Duration(100'000'000);
  double bounds[3] = {0.5, 1.0, 5.0};  ///< below the first: one knot; [rad/s] and [m/s^2]
  double gravity_m_s2 = 9.80665;
};
/// From 1 to 4, by the mean length of the angular rates and by how far the length of the mean specific force is from
/// gravity. At least one sample.
int knots_per_slot(std::span<const ImuSample> samples, const ExcitationRule& rule);
/// `samples` in order of time. A slot without any sample is as dense as the newest slot's length of samples before it
/// asks for; with none before it either, it has one knot.
std::vector<Time> excitation_knots(Time last, Time until, int beyond, std::span<const ImuSample> samples,
                                   const ExcitationRule& rule);

}  // namespace tarmac::core
