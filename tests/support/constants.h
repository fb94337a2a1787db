/// Numbers that many tests need.
#pragma once

#include <numbers>

namespace tarmac::tests {

inline constexpr double deg = 180 / std::numbers::pi;  ///< degrees a radian has
inline constexpr double rad = std::numbers::pi / 180;  ///< radians a degree has
inline constexpr double g = 9.80665;                   ///< standard gravity [m/s^2]

}  // namespace tarmac::tests
