/// Rules for where the knots of a trajectory stand. Pure functions.
///
/// The `..._after` ones return what to add to `knots` (ascending, at least one; only the last is looked at, and how
/// many lie after `end`) until the last lies at or after `end` and `beyond` of all lie after it; nothing where that is
/// so already. A spline of order k covers `end` with k knots after it (spline_trajectory.h), a process between knots
/// with none.
///
/// Knots never move once placed. So with a spline whose data come as they are measured, every rule acts ahead of what
/// it knows: the newest sample decides about knots up to k spacings later.
#pragma once

#include <span>
#include <vector>

#include "core/measurements.h"
#include "core/time.h"

namespace tarmac::core {

/// All knots of a spline of that order over [begin, end]: evenly spaced, the span beginning at `begin` exactly. Throws
/// InputError where spacing is not above zero or end before begin.
std::vector<Time> uniform_knots(Time begin, Time end, Duration spacing, int order);
/// `inner` (at least two; the span runs from the first to just before the last) with order - 1 further knots on either
/// side, repeating the first and the last spacing. Throws InputError where they do not ascend.
std::vector<Time> with_margins(std::span<const Time> inner, int order);

/// Every `spacing`. Throws InputError where it is not above zero.
std::vector<Time> uniform_knots_after(std::span<const Time> knots, Time end, Duration spacing, int beyond);

/// One a sweep, a nanosecond after its last firing, so that a sweep's newest control point is as well determined as the
/// others; those of sweeps to come at multiples of `period` from there. What would come closer to the last knot than
/// half a period is left out.
std::vector<Time> sweep_knots_after(std::span<const Time> knots, Time sweep_end, Duration period, int beyond);

/// The density of Coco-LIC (Lang et al., RA-L 2023): time is cut into slots, each with one to four knots at equal
/// distances, the last at the slot's end. Both measures of excitation pick from the same three bounds, the higher
/// counts.
struct ExcitationRule {
  Duration slot = Duration(100'000'000);
  double bounds[3] = {0.5, 1.0, 5.0};  ///< below the first: one knot; [rad/s] and [m/s^2]
  double gravity_m_s2 = 9.80665;
};
/// From 1 to 4, by the mean length of the angular rates and by how far the length of the mean specific force is from
/// gravity. Throws InputError for no samples.
int knots_per_slot(std::span<const ImuSample> samples, const ExcitationRule& rule);
/// Slots begin at the last knot. `samples` in order of time. A slot without any sample is as dense as the newest slot's
/// length of samples before it asks for; with none before it either, it has one knot.
std::vector<Time> excitation_knots_after(std::span<const Time> knots, Time end, std::span<const ImuSample> samples,
                                         const ExcitationRule& rule, int beyond);

}  // namespace tarmac::core
