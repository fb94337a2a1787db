/// Time on the recording's clock: integer nanoseconds in a strong type.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace tarmac::core {

using Duration = std::chrono::nanoseconds;

/// The clock that a recording's stamps are read on. It has no now(): nothing here drifts and nothing reads the wall.
struct RecordingClock {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<RecordingClock>;
  static constexpr bool is_steady = false;
};

/// An instant; differences are Duration. Never a double: a stamp keeps all its digits.
using Time = RecordingClock::time_point;

constexpr Time time_from_ns(std::int64_t t_ns) {
  return Time(Duration(t_ns));
}
constexpr std::int64_t to_ns(Time t) {
  return t.time_since_epoch().count();
}

/// Seconds as a double, for arithmetic on short spans (motion models, interpolation ratios).
constexpr double to_s(Duration d) {
  return static_cast<double>(d.count()) * 1e-9;
}
constexpr double to_s(Time t) {
  return to_s(t.time_since_epoch());
}

/// Nearest nanosecond.
inline Duration duration_from_s(double seconds) {
  return Duration(std::llround(seconds * 1e9));
}
inline Time time_from_s(double seconds) {
  return Time(duration_from_s(seconds));
}

/// Where t lies in [begin, end]: 0 at begin, 1 at end. An empty span gives 0.
inline double ratio(Time t, Time begin, Time end) {
  return end > begin ? static_cast<double>((t - begin).count()) / static_cast<double>((end - begin).count()) : 0.0;
}

}  // namespace tarmac::core
