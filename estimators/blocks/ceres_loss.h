/// A robust loss as Ceres takes it.
#pragma once

#include <memory>

#include "estimators/blocks/robust_loss.h"

namespace ceres {
class LossFunction;
}

namespace tarmac::estimators {

std::unique_ptr<ceres::LossFunction> ceres_loss(const RobustLoss& loss);

}  // namespace tarmac::estimators
