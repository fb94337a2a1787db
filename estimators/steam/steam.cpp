#include "estimators/steam/options.h"
#include "estimators/window_odometry/estimator.h"

namespace tarmac::estimators {
extern const EstimatorEntry steam_lo;
const EstimatorEntry steam_lo{
    .name = "steam-lo",
    .summary =
        "a Gaussian process with white noise on acceleration, one state a sweep, a sliding window inside the ICP",
    .source =
        "Burnett et al., Continuous-Time Radar-Inertial and Lidar-Inertial Odometry using a GP Motion Prior, 2024; "
        "upstream 819c607",
    .needs = Needs::lidar,
    .make = make_with<WindowOdometryEstimator, SteamLoOptions>,
    .describe = describe_with<SteamLoOptions>,
    .resolve = resolve_with<SteamLoOptions>};

extern const EstimatorEntry steam_lio;
const EstimatorEntry steam_lio{
    .name = "steam-lio",
    .summary = "steam-lo with gyroscope and accelerometer",
    .source = "Burnett et al. 2024 and IMU as an Input vs. a Measurement of the State, 2024/25; upstream 819c607",
    .needs = Needs::lidar_and_imu,
    .make = make_with<WindowOdometryEstimator, SteamLioOptions>,
    .describe = describe_with<SteamLioOptions>,
    .resolve = resolve_with<SteamLioOptions>};

}  // namespace tarmac::estimators
