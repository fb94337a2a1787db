#include "sim/lidar/spin.h"

#include <cmath>
#include <numbers>

namespace tarmac::sim::lidar {

using std::numbers::pi;

void SpinOptions::visit(core::OptionVisitor& v) {
  v("rate_jitter", rate_jitter, "standard deviation of the spin rate, share of it; real heads 0.001 to 0.003",
    {.at_least = 0, .at_most = 0.02});
  v("correlation_s", correlation_s, "time over which the spin rate keeps its error", {.at_least = 0.05, .at_most = 60});
  v("encoder_step_deg", encoder_step_deg, "width of the encoder's uniform error; real ones 0.01",
    {.at_least = 0, .at_most = 1});
}

SpinJitter::SpinJitter(const SpinOptions& options, std::uint64_t seed, const std::string& stream_name)
    : on_(options.rate_jitter > 0),
      amplitude_(options.rate_jitter * std::sqrt(2.0 / waves)),
      encoder_step_rad_(options.encoder_step_deg * pi / 180),
      encoder_(seed, stream_name + "/encoder") {
  const core::RandomStream draws(seed, stream_name + "/rate");
  for (std::uint64_t i = 0; on_ && i < waves; ++i) {
    // Share u of the spectrum lies below w = tan(pi u / 2) / tau.
    const double u = (static_cast<double>(i) + draws.uniform(i, 0)) / waves;
    const double phase = 2 * pi * draws.uniform(i, 1);
    waves_.push_back({std::tan(pi / 2 * u) / options.correlation_s, phase, std::sin(phase)});
  }
}

double SpinJitter::lead_s(double t_s) const {
  double sum = 0;
  for (const Wave& wave : waves_)
    sum += (std::sin(wave.w_rad_s * t_s + wave.phase_rad) - wave.sine_of_phase) / wave.w_rad_s;
  return amplitude_ * sum;
}

double SpinJitter::rate_error(double t_s) const {
  double sum = 0;
  for (const Wave& wave : waves_) sum += std::cos(wave.w_rad_s * t_s + wave.phase_rad);
  return amplitude_ * sum;
}

double SpinJitter::encoder_error_rad(std::int64_t cycle) const {
  if (encoder_step_rad_ == 0) return 0;
  return (encoder_.uniform(static_cast<std::uint64_t>(cycle)) - 0.5) * encoder_step_rad_;
}

}  // namespace tarmac::sim::lidar
