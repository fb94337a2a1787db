// Apart from oracle.cpp: this alone builds the truth's scene and reads from disk.
#include "metrics/degeneracy/oracle.h"
#include "scenes/registry.h"

namespace tarmac::metrics {

Oracle make_oracle(const core::Recording& recording, const sim::truth::GroundTruth& truth,
                   const OracleSettings& settings) {
  const auto scene = std::make_shared<const scenes::Scene>(scenes::make_scene(truth.config.child("scene"), truth.seed));
  const sim::raycast::Tracer tracer(scene, {settings.threads, false});
  return make_oracle(sweeps_of(recording), truth, labels_of(recording, truth), tracer, settings);
}

}  // namespace tarmac::metrics
