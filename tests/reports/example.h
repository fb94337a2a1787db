/// Small made-up results and a small scene for the tests of reports/.
#pragma once

#include "reports/report.h"

namespace tarmac::reports::example {

/// An evaluation with a row of every kind and every series that the page draws.
metrics::Evaluation evaluation(const std::string& estimator, std::uint64_t seed, double end_error_percent);
/// One that gave nothing.
metrics::Evaluation failed(const std::string& estimator, std::uint64_t seed, const std::string& status,
                           const std::string& message);
/// Two estimators, one of which failed in the second of two seeds.
ReportInput input();

/// A grey apron of 40 m x 40 m around the origin, a red block of 4 m x 2 m x 3 m whose middle is at (8, -6), and a blue
/// cart that drives east through (0, 6) at 2 m/s, being there at t = 0.
scenes::Scene scene();
inline const Eigen::Vector2d kBlock{8, -6}, kCartAtZero{0, 6};

}  // namespace tarmac::reports::example
