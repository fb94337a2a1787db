#include "core/rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace tarmac::core {
namespace {

using tests::message_of;

Rig full_rig() {
  Rig rig;
  rig.calibrated = false;
  rig.gravity_m_s2 = 9.8123456789012345;
  rig.lidars.resize(2);
  rig.lidars[0] = {"ouster \"quoted\"",
                   se3::exp((Vector6() << 1, 2, 3, 0.1, -0.2, 0.3).finished()),
                   20,
                   0.3,
                   120,
                   Duration(-1234567),
                   "mid"};
  rig.imus.resize(1);
  rig.imus[0] = {"imu",  se3::exp((Vector6() << -1, 0, 1.0 / 3, 2, 0, 1).finished()),
                 400,    Duration(2500001),
                 1.1e-4, 2.2e-6,
                 35,     3.3e-3,
                 4.4e-5, 160};
  return rig;
}

TEST(Rig, JsonKeepsEveryField) {
  const std::string text = rig_to_json(full_rig());
  const Rig back = rig_from_json(text, "manifest.json");
  EXPECT_EQ(back.calibrated, false);
  EXPECT_EQ(back.gravity_m_s2, full_rig().gravity_m_s2);
  ASSERT_EQ(back.lidars.size(), 2u);
  ASSERT_EQ(back.imus.size(), 1u);
  const LidarSheet &l = back.lidars[0], l0 = full_rig().lidars[0];
  EXPECT_EQ(l.model, l0.model);
  EXPECT_LT((l.T_body_lidar.matrix() - l0.T_body_lidar.matrix()).norm(), 1e-15);
  EXPECT_EQ(l.sweep_rate_hz, l0.sweep_rate_hz);
  EXPECT_EQ(l.min_range_m, l0.min_range_m);
  EXPECT_EQ(l.max_range_m, l0.max_range_m);
  EXPECT_EQ(l.clock_offset, l0.clock_offset);
  EXPECT_EQ(l.stamp_convention, l0.stamp_convention);
  const ImuSheet &i = back.imus[0], i0 = full_rig().imus[0];
  EXPECT_EQ(i.model, i0.model);
  EXPECT_LT((i.T_body_imu.matrix() - i0.T_body_imu.matrix()).norm(), 1e-15);
  EXPECT_EQ(i.rate_hz, i0.rate_hz);
  EXPECT_EQ(i.delay, i0.delay);
  EXPECT_EQ(i.gyro_noise_density_rad_s_rthz, i0.gyro_noise_density_rad_s_rthz);
  EXPECT_EQ(i.gyro_random_walk_rad_s2_rthz, i0.gyro_random_walk_rad_s2_rthz);
  EXPECT_EQ(i.gyro_range_rad_s, i0.gyro_range_rad_s);
  EXPECT_EQ(i.accel_noise_density_m_s2_rthz, i0.accel_noise_density_m_s2_rthz);
  EXPECT_EQ(i.accel_random_walk_m_s3_rthz, i0.accel_random_walk_m_s3_rthz);
  EXPECT_EQ(i.accel_range_m_s2, i0.accel_range_m_s2);
}

TEST(Rig, EveryMissingFieldIsAnErrorThatNamesIt) {
  const std::string text = rig_to_json(full_rig());
  // Renames one field after the other; each must be missed, by its name and with the place.
  const std::regex field("\"([a-z_0-9A-Z]+)\":");
  int fields = 0;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), field); it != std::sregex_iterator(); ++it, ++fields) {
    std::string broken = text;
    broken.replace(static_cast<std::size_t>(it->position(1)), static_cast<std::size_t>(it->length(1)), "other");
    EXPECT_THAT(message_of<InputError>([&] { rig_from_json(broken, "manifest.json"); }),
                ::testing::AllOf(::testing::StartsWith("manifest.json: "), ::testing::HasSubstr((*it)[1].str())));
  }
  EXPECT_GT(fields, 30);
}

TEST(Rig, WrongTypesAndPosesAreErrors) {
  const std::string text = rig_to_json(full_rig());
  const auto error_with = [&](const std::string& from, const std::string& to) {
    EXPECT_NE(text.find(from), std::string::npos);
    std::string broken = text;
    broken.replace(broken.find(from), from.size(), to);
    return message_of<InputError>([&] { rig_from_json(broken, "manifest.json"); });
  };
  EXPECT_THAT(error_with("\"sweep_rate_hz\": 20.0", "\"sweep_rate_hz\": \"20\""),
              ::testing::StartsWith("manifest.json: "));
  EXPECT_THAT(error_with("\"calibrated\": false", "\"calibrated\": 0"), ::testing::StartsWith("manifest.json: "));
  EXPECT_THAT(error_with("\"quat_xyzw\": [", "\"quat_xyzw\": [1, "), ::testing::StartsWith("manifest.json: "));
  EXPECT_THAT(message_of<InputError>([] { rig_from_json("{", "manifest.json"); }),
              ::testing::StartsWith("manifest.json: "));
  EXPECT_THAT(message_of<InputError>([] { rig_from_json("[]", "manifest.json"); }),
              ::testing::StartsWith("manifest.json: "));
}

}  // namespace
}  // namespace tarmac::core
