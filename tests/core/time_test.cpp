#include "core/time.h"

#include <gtest/gtest.h>

#include <limits>
#include <type_traits>

namespace tarmac::core {
namespace {

static_assert(!std::is_convertible_v<double, Time>, "a double has no room for a stamp");
static_assert(!std::is_convertible_v<std::int64_t, Time>, "a number without unit is no time");

TEST(Time, KeepsEveryNanosecondOfAWallClockStamp) {
  const std::int64_t t_ns = 1'700'000'000'123'456'789;  // a double would round this to 256 ns
  EXPECT_EQ(to_ns(time_from_ns(t_ns)), t_ns);
  EXPECT_EQ((time_from_ns(t_ns) - time_from_ns(t_ns - 1)).count(), 1);
}

TEST(Time, SecondsRoundToTheNearestNanosecond) {
  EXPECT_EQ(duration_from_s(1.4e-9).count(), 1);
  EXPECT_EQ(duration_from_s(1.6e-9).count(), 2);
  EXPECT_EQ(duration_from_s(-1.6e-9).count(), -2);
  EXPECT_EQ(to_ns(time_from_s(0.1)), 100'000'000);
  EXPECT_DOUBLE_EQ(to_s(Duration(1'500'000'000)), 1.5);
  EXPECT_DOUBLE_EQ(to_s(time_from_ns(-250'000'000)), -0.25);
}

TEST(Time, RatioIsExactAtBothEndsAndBetween) {
  const Time begin = time_from_ns(1'700'000'000'000'000'000), end = begin + Duration(100'000'001);
  EXPECT_EQ(ratio(begin, begin, end), 0);
  EXPECT_EQ(ratio(end, begin, end), 1);
  EXPECT_EQ(ratio(begin + Duration(25), begin, begin + Duration(100)), 0.25);
  EXPECT_EQ(ratio(begin, begin, begin), 0) << "an empty span has no inside";
}

}  // namespace
}  // namespace tarmac::core
