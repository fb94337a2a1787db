/// Estimators by name. Adding one: a folder, and one line in estimators/CMakeLists.txt.
#pragma once

#include <span>
#include <string>

#include "estimators/estimator.h"

namespace tarmac::estimators {

std::span<const EstimatorEntry* const> estimators();
/// nullptr when there is none of that name.
const EstimatorEntry* find_estimator(const std::string& name);

}  // namespace tarmac::estimators
