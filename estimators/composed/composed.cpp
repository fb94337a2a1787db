#include "estimators/composed/options.h"
#include "estimators/window_odometry/estimator.h"

namespace tarmac::estimators {
extern const EstimatorEntry composed;
const EstimatorEntry composed{
    .name = "composed",
    .summary =
        "one front end, any trajectory model: rigid, two-pose, B-spline or Gaussian process, with or without IMU",
    .source =
        "the parts' own: Sommer et al. CVPR 2020 (splines), Barfoot et al. RSS 2014 (Gaussian processes), Dellenbach "
        "et al. ICRA 2022 (front end)",
    .needs = Needs::lidar,
    .make = make_with<WindowOdometryEstimator, ComposedOptions>,
    .describe = describe_with<ComposedOptions>,
    .resolve = resolve_with<ComposedOptions>};

}  // namespace tarmac::estimators
