#include "sim/imu/imu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/config.h"
#include "core/error.h"
#include "sim/truth/constant_twist.h"

namespace tarmac::sim {
namespace {

using namespace core;
using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

constexpr double g = 9.80665;
constexpr double two_pi = 2 * std::numbers::pi;

std::shared_ptr<const SmoothTrajectory> twist(const Vector3d& v, const Vector3d& omega, const SE3& start) {
  return truth::make_constant_twist({start, v, omega}, duration_from_s(10));
}

SE3 make_pose(const Vector3d& xyz, const Vector3d& rotation) {
  SE3 T = SE3::Identity();
  T.linear() = so3::exp(rotation);
  T.translation() = xyz;
  return T;
}

ImuOptions perfect(const std::string& sampling) {
  ImuOptions options;
  options.sampling = sampling;
  options.noise = false;
  return options;
}

/// Shakes along x and about z at one frequency, standing otherwise.
class Shaker final : public SmoothTrajectory {
 public:
  Shaker(double hz, double accel_m_s2, double rate_rad_s) : W_(two_pi * hz), accel_(accel_m_s2), rate_(rate_rad_s) {}
  Time begin() const override { return Time(); }
  Time end() const override { return time_from_s(10); }
  Kinematics at(Time t) const override {
    const double phase = W_ * to_s(t) + 0.7;
    Kinematics k;
    k.T_world_body = make_pose({-accel_ / (W_ * W_) * std::sin(phase), 0, 0}, {0, 0, -rate_ / W_ * std::cos(phase)});
    k.v_world.x() = -accel_ / W_ * std::cos(phase);
    k.a_world.x() = accel_ * std::sin(phase);
    k.omega_body.z() = rate_ * std::sin(phase);
    k.alpha_body.z() = rate_ * W_ * std::cos(phase);
    return k;
  }

 private:
  double W_, accel_, rate_;
};

TEST(Imu, LeverArmOnASteadyRotationFeelsOmegaSquaredTimesItsLength) {
  // The body's origin turns on the spot at 1 rad/s; 0.5 m away that is 0.5 m/s^2 towards the axis.
  const auto motion = twist(Vector3d::Zero(), {0, 0, 1}, SE3::Identity());
  for (const char* sampling : {"point", "interval-mean"}) {
    ImuOptions options = perfect(sampling);
    options.T_body_imu = make_pose({0.3, 0.4, 0.2}, Vector3d::Zero());
    for (const ImuSample& s : ideal_imu(*motion, options, g, Time(), time_from_s(1))) {
      EXPECT_LT((s.accel_m_s2 - Vector3d(-0.3, -0.4, g)).norm(), 1e-12) << sampling;
      EXPECT_LT((s.gyro_rad_s - Vector3d(0, 0, 1)).norm(), 1e-14) << sampling;
    }
  }
}

TEST(Imu, TangentialAccelerationOfTheLeverArmIsThere) {
  // About z with angular acceleration A W cos: at l = (0.5, 0, 0) the force along y is alpha * 0.5.
  const Shaker motion(2, 0, 0.4);
  ImuOptions options = perfect("point");
  options.T_body_imu = make_pose({0.5, 0, 0}, Vector3d::Zero());
  for (const ImuSample& s : ideal_imu(motion, options, g, Time(), time_from_s(0.5))) {
    const Kinematics k = motion.at(s.t);
    EXPECT_NEAR(s.accel_m_s2.y(), 0.5 * k.alpha_body.z(), 1e-12);
    EXPECT_NEAR(s.accel_m_s2.x(), -0.5 * k.omega_body.z() * k.omega_body.z(), 1e-12);
  }
}

TEST(Imu, MountingRotatesWhatIsFeltAndATiltedBodyFeelsGravityFromAbove) {
  const SE3 tilted = make_pose(Vector3d::Zero(), {0.3, -0.2, 1.0});
  const auto motion = twist(Vector3d::Zero(), {0.1, 0.2, 0.3}, tilted);
  ImuOptions options = perfect("point");
  options.T_body_imu = make_pose(Vector3d::Zero(), {0.5, 1.0, -2.0});
  const Eigen::Matrix3d R_imu_body = options.T_body_imu.linear().transpose();
  const ImuSample first = ideal_imu(*motion, options, g, Time(), time_from_s(1)).front();
  EXPECT_LT((first.gyro_rad_s - R_imu_body * Vector3d(0.1, 0.2, 0.3)).norm(), 1e-14);
  EXPECT_LT((first.accel_m_s2 - R_imu_body * tilted.linear().transpose() * Vector3d(0, 0, g)).norm(), 1e-13);
}

TEST(Imu, AMeanIsTheIntegralOverTheIntervalBeforeTheStamp) {
  // Along x, a = A sin(W t + p): the mean over [t - dt, t] is A (cos(W (t - dt) + p) - cos(W t + p)) / (W dt).
  const double hz = 37, W = two_pi * hz, dt = 0.005;
  const Shaker motion(hz, 2, 0);
  const auto samples = ideal_imu(motion, perfect("interval-mean"), g, Time(), time_from_s(1));
  ASSERT_EQ(samples.size(), 200u);
  EXPECT_EQ(to_ns(samples.front().t), 5'000'000) << "the stamp is the interval's end";
  for (const ImuSample& s : samples) {
    const double t = to_s(s.t);
    EXPECT_NEAR(s.accel_m_s2.x(), 2 * (std::cos(W * (t - dt) + 0.7) - std::cos(W * t + 0.7)) / (W * dt), 1e-6) << t;
  }
}

TEST(Imu, ALineAtTheSampleRateIsABiasForPointSamplesOnly) {
  const Shaker motion(200, 3, 0.2);
  const auto mean_x = [&](const char* sampling) {
    const auto samples = ideal_imu(motion, perfect(sampling), g, Time(), time_from_s(2));
    Vector3d sum = Vector3d::Zero();
    for (const ImuSample& s : samples) sum += Vector3d(s.accel_m_s2.x(), s.accel_m_s2.y(), s.gyro_rad_s.z());
    return Vector3d(sum / static_cast<double>(samples.size()));
  };
  EXPECT_NEAR(mean_x("point").x(), 3 * std::sin(0.7), 1e-3);
  EXPECT_NEAR(mean_x("point").z(), 0.2 * std::sin(0.7), 1e-6);
  EXPECT_NEAR(mean_x("interval-mean").x(), 0, 1e-4);
  EXPECT_NEAR(mean_x("interval-mean").z(), 0, 1e-5);
}

TEST(Imu, StampsDoNotDriftAtRatesThatDivideNoNanosecond) {
  const auto motion = twist(Vector3d::Zero(), Vector3d::Zero(), SE3::Identity());
  ImuOptions options = perfect("point");
  options.rate_hz = 300;
  const auto samples = ideal_imu(*motion, options, g, Time(), time_from_s(10));
  ASSERT_EQ(samples.size(), 3001u);
  EXPECT_EQ(to_ns(samples[1].t), 3'333'333);
  EXPECT_EQ(to_ns(samples.back().t), 10'000'000'000);
}

std::vector<ImuSample> standing(const std::string& name, std::uint64_t seed) {
  const auto motion = twist(Vector3d::Zero(), Vector3d::Zero(), SE3::Identity());
  return synthesize_imu(*motion, ImuOptions{}, g, Time(), time_from_s(2), seed, name);
}

bool same_bytes(const std::vector<ImuSample>& a, const std::vector<ImuSample>& b) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].t != b[k].t || std::memcmp(a[k].gyro_rad_s.data(), b[k].gyro_rad_s.data(), 24) != 0 ||
        std::memcmp(a[k].accel_m_s2.data(), b[k].accel_m_s2.data(), 24) != 0) {
      return false;
    }
  }
  return a.size() == b.size();
}

TEST(Imu, SameSeedAndNameSameBytesAndASecondImuChangesNothing) {
  const auto first = standing("imu0", 7);
  const auto second = standing("imu1", 7);
  EXPECT_TRUE(same_bytes(first, standing("imu0", 7)));
  EXPECT_FALSE(same_bytes(first, second));
  EXPECT_FALSE(same_bytes(first, standing("imu0", 8)));
}

TEST(Imu, EachEffectHasItsOwnDraws) {
  // Without bias walk and turn-on bias the white noise is what it was: the difference is a pure bias.
  ImuModel full = imu_model("bmi088"), white = full;
  white.gyro.random_walk = white.gyro.turn_on_sigma = 0;
  std::vector<ImuSample> a(500), b(500);
  add_imu_errors(a, full, 200, 3, "imu0");
  add_imu_errors(b, white, 200, 3, "imu0");
  const Vector3d bias = a[0].gyro_rad_s - b[0].gyro_rad_s;
  EXPECT_GT(bias.norm(), 1e-4);
  const double walk = full.gyro.random_walk * std::sqrt(500 / 200.0);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_LT((a[k].gyro_rad_s - b[k].gyro_rad_s - bias).norm(), 6 * walk);
    EXPECT_EQ(a[k].accel_m_s2, b[k].accel_m_s2);
  }
}

TEST(Imu, SaturatesAtItsRange) {
  std::vector<ImuSample> samples(3);
  samples[0].accel_m_s2 = {100, -100, 0};
  samples[0].gyro_rad_s = {-50, 50, 0};
  const ImuModel& model = imu_model("ouster-iam-20680ht");  // 2 g, 250 deg/s
  add_imu_errors(samples, model, 100, 1, "imu0");
  EXPECT_EQ(samples[0].accel_m_s2.x(), 2 * g);
  EXPECT_EQ(samples[0].accel_m_s2.y(), -2 * g);
  EXPECT_DOUBLE_EQ(samples[0].gyro_rad_s.x(), -250 * std::numbers::pi / 180);
  EXPECT_NE(samples[0].accel_m_s2.z(), 0);
}

TEST(Imu, SheetSaysWhatAnEngineerWouldKnow) {
  ImuOptions options;
  options.model = "stim300";
  options.rate_hz = 250;
  const ImuSheet sheet = imu_sheet(options);
  EXPECT_EQ(sheet.model, "stim300");
  EXPECT_EQ(sheet.delay.count(), 2'000'000) << "half of 4 ms";
  EXPECT_EQ(sheet.gyro_noise_density_rad_s_rthz, imu_model("stim300").gyro.noise_density);
  EXPECT_NEAR(sheet.accel_range_m_s2, 10 * g, 1e-12);
  options.sampling = "point";
  EXPECT_EQ(imu_sheet(options).delay.count(), 0);
}

TEST(Imu, CatalogueHoldsElevenDifferentGradesWithAllFigures) {
  ASSERT_EQ(imu_models().size(), 11u);
  for (const ImuModel& model : imu_models()) {
    for (const TriadModel& triad : {model.gyro, model.accel}) {
      EXPECT_GT(std::min({triad.noise_density, triad.random_walk, triad.turn_on_sigma, triad.range}), 0) << model.name;
    }
    EXPECT_EQ(&imu_model(std::string(model.name)), &model);
    EXPECT_THAT(describe_imu_model(model), HasSubstr(std::string(model.title)));
  }
  // ARW [deg/sqrt(h)] = 60 * density [deg/s/sqrt(Hz)]: 0.84 and 0.002 are printed in the sheets.
  const auto arw = [](const char* name) { return imu_model(name).gyro.noise_density * 180 / std::numbers::pi * 60; };
  EXPECT_NEAR(arw("bmi088"), 0.84, 0.005);
  EXPECT_NEAR(arw("hg9900"), 0.00198, 2e-5);
}

TEST(Imu, ErrorsNameTheFieldAndWhatIsAllowed) {
  const auto error_of = [](const std::string& yaml) -> std::string {
    try {
      ImuOptions options;
      ConfigNode::parse(yaml, "rig.yaml").read(options);
      imu_sheet(options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of("model: adis16740"), AllOf(HasSubstr("rig.yaml:1"), HasSubstr("model"), HasSubstr("adis16470")));
  EXPECT_THAT(error_of("{model: adis16448, rate_hz: 1000}"), AllOf(HasSubstr("rate_hz"), HasSubstr("819")));
  EXPECT_THAT(error_of("rate_hz: -5"), AllOf(HasSubstr("rate_hz"), HasSubstr("above 0")));
  EXPECT_THAT(error_of("samplng: point"), HasSubstr("sampling"));
  EXPECT_THROW(imu_model("bmi088x"), InputError);
}

}  // namespace
}  // namespace tarmac::sim
