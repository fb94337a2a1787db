#include "sim/imu/imu_model.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "core/config.h"
#include "core/error.h"

namespace tarmac::sim {

namespace {

constexpr double rad_s_per_dps = std::numbers::pi / 180;
constexpr double m_s2_per_g = 9.80665;

// Data-sheet figures; where a sheet gives a bias instability, random_walk is the density of a walk that has the same
// power as its first-order Gauss-Markov process. How well each figure is known is in sim/imu/README.md.
// Triads: noise density, random walk, turn-on sigma, range.
constexpr ImuModel models[] = {
    {.name = "bmi088",
     .title = "BMI088",
     .grade = "consumer/robotics MEMS",
     .max_rate_hz = 1600,
     .gyro = {0.0002443, 3.577e-06, 0.005236, 2000 * rad_s_per_dps},
     .accel = {0.001716, 3.618e-05, 0.06865, 24 * m_s2_per_g}},
    {.name = "icm-20948",
     .title = "ICM-20948",
     .grade = "consumer MEMS",
     .max_rate_hz = 1125,
     .gyro = {0.0002618, 1.095e-05, 0.02618, 2000 * rad_s_per_dps},
     .accel = {0.002256, 8.861e-05, 0.1471, 16 * m_s2_per_g}},
    {.name = "ouster-iam-20680ht",
     .title = "IAM-20680HT, built into Ouster sensors",
     .grade = "consumer/automotive MEMS",
     .max_rate_hz = 640,
     .gyro = {8.727e-05, 5.962e-06, 0.005236, 250 * rad_s_per_dps},
     .accel = {0.001324, 4.824e-05, 0.09807, 2 * m_s2_per_g}},
    {.name = "adis16448",
     .title = "ADIS16448",
     .grade = "industrial MEMS",
     .max_rate_hz = 819,
     .gyro = {0.0002356, 8.644e-06, 0.002618, 1000 * rad_s_per_dps},
     .accel = {0.002256, 0.0003015, 0.04903, 18 * m_s2_per_g}},
    {.name = "adis16470",
     .title = "ADIS16470",
     .grade = "industrial MEMS",
     .max_rate_hz = 2000,
     .gyro = {0.0001396, 4.13e-06, 0.001745, 2000 * rad_s_per_dps},
     .accel = {0.0009807, 1.358e-05, 0.01961, 40 * m_s2_per_g}},
    {.name = "xsens-mti-30",
     .title = "Xsens MTi-30",
     .grade = "industrial AHRS",
     .max_rate_hz = 400,
     .gyro = {0.0005236, 1.073e-05, 0.003491, 450 * rad_s_per_dps},
     .accel = {0.0005884, 1.809e-05, 0.02942, 20 * m_s2_per_g}},
    {.name = "xsens-mti-630",
     .title = "Xsens MTi-630",
     .grade = "industrial AHRS",
     .max_rate_hz = 2000,
     .gyro = {0.0001222, 4.13e-06, 0.001745, 2000 * rad_s_per_dps},
     .accel = {0.0005884, 1.253e-05, 0.01961, 10 * m_s2_per_g}},
    {.name = "adis16495-2",
     .title = "ADIS16495-2",
     .grade = "tactical MEMS",
     .max_rate_hz = 4250,
     .gyro = {3.491e-05, 5.224e-07, 0.0008727, 450 * rad_s_per_dps},
     .accel = {0.0001667, 2.114e-06, 0.01471, 8 * m_s2_per_g}},
    {.name = "stim300",
     .title = "STIM300, 10 g",
     .grade = "tactical MEMS",
     .max_rate_hz = 2000,
     .gyro = {4.363e-05, 1.633e-07, 0.0003491, 400 * rad_s_per_dps},
     .accel = {0.001, 3.302e-05, 0.007355, 10 * m_s2_per_g}},
    {.name = "kvh-1775",
     .title = "KVH 1750/1775",
     .grade = "tactical FOG",
     .max_rate_hz = 1000,
     .gyro = {3.491e-06, 8.605e-09, 8.727e-06, 490 * rad_s_per_dps},
     .accel = {0.001177, 1.741e-05, 0.009807, 10 * m_s2_per_g}},
    {.name = "hg9900",
     .title = "Honeywell HG9900 class",
     .grade = "navigation RLG",
     .max_rate_hz = 300,
     .gyro = {5.76e-07, 3.651e-10, 1.396e-08, 1000 * rad_s_per_dps},
     .accel = {9.807e-05, 2.462e-06, 0.0002452, 37 * m_s2_per_g}},
};

}  // namespace

std::span<const ImuModel> imu_models() {
  return models;
}

const ImuModel& imu_model(const std::string& name) {
  const auto found = std::find_if(std::begin(models), std::end(models), [&](const auto& m) { return m.name == name; });
  if (found != std::end(models)) return *found;
  std::vector<std::string> names;
  for (const ImuModel& model : models) names.emplace_back(model.name);
  const std::string near = core::did_you_mean(name, names);
  throw core::InputError(fmt::format("there is no IMU '{}'{}; there are {}", name,
                                     near.empty() ? "" : fmt::format(" (did you mean {}?)", near),
                                     fmt::join(names, ", ")));
}

std::string describe_imu_model(const ImuModel& model) {
  const auto triad = [](const char* what, const TriadModel& t, const char* unit) {
    return fmt::format(
        "{}\n  noise density   {:.4g} {u}/sqrt(Hz)\n  bias walk       {:.4g} {u}/s/sqrt(Hz)\n"
        "  turn-on bias    {:.4g} {u} (1 sigma)\n  range           +-{:.4g} {u}\n",
        what, t.noise_density, t.random_walk, t.turn_on_sigma, t.range, fmt::arg("u", unit));
  };
  return fmt::format("{}: {} ({})\noutput rate up to {} Hz\n{}{}", model.name, model.title, model.grade,
                     model.max_rate_hz, triad("gyroscope", model.gyro, "rad/s"),
                     triad("accelerometer", model.accel, "m/s^2"));
}

}  // namespace tarmac::sim
