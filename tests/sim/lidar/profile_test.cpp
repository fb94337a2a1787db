#include "sim/lidar/profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/error.h"

namespace tarmac::sim::lidar {
namespace {

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Profile, EverySensorCountsItsRingsFromTheLowestBeam) {
  for (const std::string& name : profile_names()) {
    const Profile& p = profile(name);
    std::vector<std::size_t> by_elevation(p.channels());
    for (std::size_t c = 0; c < p.channels(); ++c) by_elevation[c] = c;
    std::sort(by_elevation.begin(), by_elevation.end(),
              [&](std::size_t a, std::size_t b) { return p.elevation_deg[a] < p.elevation_deg[b]; });
    for (std::size_t k = 0; k < by_elevation.size(); ++k)
      EXPECT_EQ(p.ring[by_elevation[k]], static_cast<double>(k)) << name;
  }
}

TEST(Profile, NoiseChangesAtTheListedRanges) {
  const Profile& p = profile("ouster-os1-64-gen2");
  for (std::size_t k = 1; k < p.sigma_m.size(); ++k) {
    EXPECT_EQ(p.sigma_at_m(p.sigma_from_m[k]), p.sigma_m[k]);
    EXPECT_EQ(p.sigma_at_m(p.sigma_from_m[k] - 1e-9), p.sigma_m[k - 1]);
  }
}

TEST(Profile, UnknownSensorIsRefusedWithASuggestion) {
  const std::string message = message_of([] { profile("vlp16"); });
  EXPECT_NE(message.find("did you mean 'vlp-16'?"), std::string::npos) << message;
  EXPECT_NE(message.find("ouster-os1-64-gen2"), std::string::npos) << message;
}

TEST(Profile, ModeThatTheSensorLacksIsRefusedWithItsModes) {
  const Profile& ouster = profile("ouster-os1-64-gen2");
  EXPECT_EQ(mode_of(ouster, 0, 0).columns, 1024);
  EXPECT_EQ(mode_of(ouster, 512, 20).rate_hz, 20);
  const std::string message = message_of([&] { mode_of(ouster, 2048, 20); });
  EXPECT_NE(message.find("2048x10"), std::string::npos) << message;
  EXPECT_EQ(mode_of(profile("vlp-16"), 0, 0).rate_hz, 10);
  EXPECT_NE(message_of([] { mode_of(profile("vlp-16"), 0, 25); }), "");
  EXPECT_NE(message_of([] { mode_of(profile("vlp-16"), 1800, 10); }), "");
}

TEST(Profile, TableOfTheWrongLengthIsNamedWithItsLine) {
  std::string yaml;
  for (const EmbeddedProfile& file : embedded_profiles())
    if (std::string(file.name) == "vlp-16") yaml = file.yaml;
  const std::size_t at = yaml.find("\nring: [0, ");
  ASSERT_NE(at, std::string::npos);
  yaml.erase(at + std::string("\nring: [").size(), 3);
  const std::string message = message_of([&] { parse_profile("vlp-16", yaml); });
  EXPECT_NE(message.find("ring"), std::string::npos) << message;
  EXPECT_NE(message.find("16 were expected"), std::string::npos) << message;
}

}  // namespace
}  // namespace tarmac::sim::lidar
