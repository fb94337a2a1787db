#include "sim/imu/imu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/config.h"
#include "core/error.h"
#include "sim/truth/constant_twist.h"
#include "tests/support/constants.h"

namespace tarmac::sim {
namespace {

using namespace core;
using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

using tests::g;
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
  return synthesize_imu(*motion, ImuOptions{}, g, Time(), time_from_s(2), seed, name).samples;
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

struct Erroneous {
  std::vector<ImuSample> samples;
  RealisedImuErrors errors;
  Erroneous(std::vector<ImuSample> clean, const ImuModel& model, const ImuErrorOptions& options)
      : samples(std::move(clean)), errors(add_imu_errors(samples, model, options, {200, 0}, 3, "imu0")) {}
};

/// 500 samples of the same rates and forces.
std::vector<ImuSample> steady(const Vector3d& gyro, const Vector3d& accel) {
  return std::vector<ImuSample>(500, ImuSample{Time(), gyro, accel});
}

TEST(ImuErrors, EveryEffectIsASwitchOfItsOwnAndMovesNoOthersDraws) {
  // With one effect taken away, what is left is what was there without it: errors add up, but for scale, misalignment
  // and g-sensitivity, which are known matrices.
  const ImuModel& model = imu_model("bmi088");
  ImuErrorOptions all;
  all.bias_walk = true;
  all.saturation = all.quantisation = false;
  const Vector3d omega(0.3, -0.2, 0.5), force(1, 2, g);
  const Erroneous full(steady(omega, force), model, all);
  const struct {
    const char* name;
    bool ImuErrorOptions::*flag;
  } effects[] = {{"white_noise", &ImuErrorOptions::white_noise},
                 {"turn_on_bias", &ImuErrorOptions::turn_on_bias},
                 {"bias_instability", &ImuErrorOptions::bias_instability},
                 {"bias_walk", &ImuErrorOptions::bias_walk},
                 {"scale", &ImuErrorOptions::scale},
                 {"misalignment", &ImuErrorOptions::misalignment},
                 {"g_sensitivity", &ImuErrorOptions::g_sensitivity}};
  for (const auto& effect : effects) {
    ImuErrorOptions without = all, alone = ImuErrorOptions::none();
    without.*effect.flag = false;
    alone.*effect.flag = true;
    const Erroneous rest(steady(omega, force), model, without), one(steady(omega, force), model, alone);
    double changed = 0;
    for (std::size_t k = 0; k < full.samples.size(); ++k) {
      const Vector3d by_one = one.samples[k].gyro_rad_s - omega;
      changed = std::max(changed, by_one.norm());
      ASSERT_LT((full.samples[k].gyro_rad_s - rest.samples[k].gyro_rad_s - by_one).norm(), 1e-12) << effect.name;
      ASSERT_LT((full.samples[k].accel_m_s2 - rest.samples[k].accel_m_s2 - one.samples[k].accel_m_s2 + force).norm(),
                1e-12)
          << effect.name;
    }
    EXPECT_GT(changed, 1e-6) << effect.name << " does nothing";
  }
}

TEST(ImuErrors, ConstantErrorsAreTheRealisedMatricesAndBiases) {
  ImuErrorOptions constant;
  constant.white_noise = constant.bias_instability = constant.saturation = constant.quantisation = false;
  const Vector3d omega(0.3, -0.2, 0.5), force(1, 2, g);
  const Erroneous made(steady(omega, force), imu_model("icm-20948"), constant);
  const RealisedTriad &gyro = made.errors.gyro, &accel = made.errors.accel;
  EXPECT_GT((gyro.matrix - Eigen::Matrix3d::Identity()).norm(), 1e-3);
  EXPECT_TRUE(accel.g_sensitivity.isZero());
  for (const ImuSample& s : made.samples) {
    ASSERT_LT((s.gyro_rad_s - (gyro.matrix * omega + gyro.g_sensitivity * force + gyro.turn_on_bias)).norm(), 1e-14);
    ASSERT_LT((s.accel_m_s2 - (accel.matrix * force + accel.turn_on_bias)).norm(), 1e-14);
  }
}

TEST(ImuErrors, RealisedBiasIsWhatTheSamplesCarry) {
  ImuErrorOptions biases = ImuErrorOptions::none();
  biases.turn_on_bias = biases.bias_instability = biases.bias_walk = true;
  const Erroneous made(steady(Vector3d::Zero(), Vector3d::Zero()), imu_model("adis16448"), biases);
  ASSERT_EQ(made.errors.gyro.bias.size(), made.samples.size());
  for (std::size_t k = 0; k < made.samples.size(); ++k) {
    ASSERT_EQ(made.errors.gyro.bias[k], made.samples[k].gyro_rad_s);
    ASSERT_EQ(made.errors.accel.bias[k], made.samples[k].accel_m_s2);
  }
  EXPECT_NE(made.errors.gyro.bias.front(), made.errors.gyro.bias.back());
}

TEST(ImuErrors, SaturatesAtItsRangeAndCountsHowOften) {
  ImuErrorOptions options;
  options.quantisation = false;
  std::vector<ImuSample> samples(3);
  samples[0].accel_m_s2 = {100, -100, 0};
  samples[0].gyro_rad_s = {-50, 50, 0};
  const Erroneous made(samples, imu_model("ouster-iam-20680ht"), options);  // 2 g, 250 deg/s
  EXPECT_EQ(made.samples[0].accel_m_s2.x(), 2 * g);
  EXPECT_EQ(made.samples[0].accel_m_s2.y(), -2 * g);
  EXPECT_DOUBLE_EQ(made.samples[0].gyro_rad_s.x(), -250 * std::numbers::pi / 180);
  EXPECT_NE(made.samples[0].accel_m_s2.z(), 0);
  EXPECT_EQ(made.errors.accel.saturated, 2u);
  EXPECT_EQ(made.errors.gyro.saturated, 2u);
  options.saturation = false;
  EXPECT_GT(Erroneous(samples, imu_model("ouster-iam-20680ht"), options).samples[0].accel_m_s2.x(), 90);
}

TEST(ImuErrors, QuantisedValuesAreMultiplesOfTheStepInsideTheRangeAndHalfAStepFromTheExact) {
  const ImuModel& model = imu_model("adis16470");
  ImuErrorOptions exact, quantised;
  exact.quantisation = false;
  std::vector<ImuSample> clean = steady({0.1, -0.2, 0.3}, {0, 1, g});
  clean[0].gyro_rad_s = {100, -100, 0};
  const Erroneous a(clean, model, exact), b(clean, model, quantised);
  for (std::size_t k = 0; k < clean.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      const double value = b.samples[k].gyro_rad_s[axis], codes = value / model.gyro.lsb;
      ASSERT_NEAR(codes, std::round(codes), 1e-9);
      ASSERT_LE(std::abs(value), model.gyro.range * (1 + 1e-12));
      ASSERT_LE(std::abs(value - a.samples[k].gyro_rad_s[axis]), model.gyro.lsb * (k == 0 ? 1 : 0.5) * (1 + 1e-9));
    }
  }
}

TEST(ImuErrors, TruthFileHoldsThemAll) {
  const Erroneous made(steady({0, 0, 0.1}, {0, 0, g}), imu_model("bmi088"), ImuErrorOptions());
  const std::string json = errors_as_json(made.errors);
  for (const char* key : {"scale_and_misalignment", "g_sensitivity_rad_s_per_m_s2", "turn_on_bias_rad_s",
                          "turn_on_bias_m_s2", "saturated_axis_samples", "t_ns"})
    EXPECT_THAT(json, HasSubstr(key));
}

/// Response of the second-order Butterworth filter at a frequency: gain and phase lag.
struct Response {
  double gain, lag_rad;
};
Response butterworth(double hz, double cutoff_hz) {
  const double u = hz / cutoff_hz;
  return {1 / std::sqrt(1 + u * u * u * u), std::atan2(std::numbers::sqrt2 * u, 1 - u * u)};
}

TEST(ImuLowPass, AnswersASineAsTheFilterOfItsSheetDoes) {
  for (const double hz : {2.0, 50.0, 90.0, 200.0}) {
    const Shaker motion(hz, 2, 0.3);
    ImuOptions options = perfect("low-pass");
    options.low_pass_hz = 50;
    const Response response = butterworth(hz, 50);
    for (const ImuSample& s : ideal_imu(motion, options, g, Time(), time_from_s(1))) {
      if (to_s(s.t) < 0.3) continue;  // the filter's memory of the start
      const double phase = two_pi * hz * to_s(s.t) + 0.7 - response.lag_rad;
      ASSERT_NEAR(s.gyro_rad_s.z(), 0.3 * response.gain * std::sin(phase), 1e-6) << hz << " Hz at " << to_s(s.t);
    }
  }
}

TEST(ImuLowPass, IsLateByTheDelayOnTheSheet) {
  const Shaker motion(1, 2, 0.3);
  ImuOptions options = perfect("low-pass");
  options.low_pass_hz = 40;
  const Duration delay = imu_sheet(options).delay;
  EXPECT_NEAR(to_s(delay), std::numbers::sqrt2 / (two_pi * 40), 1e-9);
  double with = 0, without = 0;
  for (const ImuSample& s : ideal_imu(motion, options, g, Time(), time_from_s(2))) {
    if (to_s(s.t) < 0.3) continue;
    with = std::max(with, std::abs(s.gyro_rad_s.z() - motion.at(s.t - delay).omega_body.z()));
    without = std::max(without, std::abs(s.gyro_rad_s.z() - motion.at(s.t).omega_body.z()));
  }
  EXPECT_LT(with, 0.3 * 1e-5);
  EXPECT_GT(without, 0.3 * 0.03);
}

TEST(ImuLowPass, AStillStartIsSettled) {
  const auto motion = twist(Vector3d::Zero(), Vector3d::Zero(), SE3::Identity());
  for (const ImuSample& s : ideal_imu(*motion, perfect("low-pass"), g, Time(), time_from_s(1)))
    ASSERT_NEAR(s.accel_m_s2.z(), g, 1e-8);
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
  EXPECT_EQ(sheet.gyro_random_walk_rad_s2_rthz, imu_model("stim300").gyro.random_walk);
  options.sampling = "point";
  EXPECT_EQ(imu_sheet(options).delay.count(), 0);
}

TEST(Imu, CatalogueHoldsElevenDifferentGradesWithAllFigures) {
  ASSERT_EQ(imu_models().size(), 11u);
  for (const ImuModel& model : imu_models()) {
    for (const TriadModel& triad : {model.gyro, model.accel}) {
      EXPECT_GT(
          std::min({triad.noise_density, triad.bias_sigma, triad.bias_tau_s, triad.random_walk, triad.turn_on_sigma,
                    triad.scale_sigma, triad.misalignment_sigma_rad, triad.range, triad.lsb}),
          0)
          << model.name;
      EXPECT_LT(triad.lsb, 1e-4 * triad.range) << model.name;
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
  EXPECT_THAT(error_of("{sampling: low-pass, low_pass_hz: 0}"), AllOf(HasSubstr("low_pass_hz"), HasSubstr("above 0")));
  EXPECT_THAT(error_of("errors: {white_noize: false}"), HasSubstr("did you mean 'white_noise'"));
  EXPECT_THAT(error_of("rate_hz: -5"), AllOf(HasSubstr("rate_hz"), HasSubstr("above 0")));
  EXPECT_THAT(error_of("samplng: point"), HasSubstr("sampling"));
  EXPECT_THROW(imu_model("bmi088x"), InputError);
}

}  // namespace
}  // namespace tarmac::sim
