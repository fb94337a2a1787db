#include "estimators/blocks/ceres_loss.h"

#include <ceres/loss_function.h>

namespace tarmac::estimators {
namespace {

class LossAdaptor final : public ceres::LossFunction {
 public:
  explicit LossAdaptor(const RobustLoss& loss) : loss_(loss) {}
  void Evaluate(double s, double out[3]) const override {
    const RobustLoss::Value value = loss_(s);
    out[0] = value.rho;
    out[1] = value.first;
    out[2] = value.second;
  }

 private:
  RobustLoss loss_;
};

}  // namespace

std::unique_ptr<ceres::LossFunction> ceres_loss(const RobustLoss& loss) {
  return std::make_unique<LossAdaptor>(loss);
}

}  // namespace tarmac::estimators
