#include "estimators/registry.h"

namespace tarmac::estimators {

const EstimatorEntry* find_estimator(const std::string& name) {
  for (const EstimatorEntry* entry : estimators()) {
    if (name == entry->name) return entry;
  }
  return nullptr;
}

}  // namespace tarmac::estimators
