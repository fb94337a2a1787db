#include "sim/lidar/receiver.h"

#include <fmt/format.h>

#include <algorithm>

namespace tarmac::sim::lidar {
namespace {

constexpr std::uint64_t slots = 16;  // echoes of one firing that have draws of their own

std::string stream_name(std::uint16_t sensor, const std::string& effect) {
  return fmt::format("lidar{}/{}", sensor, effect);
}

}  // namespace

void NoiseOptions::visit(core::OptionVisitor& v) {
  v("range_scale", range_scale, "factor on the sensor's range noise", {.at_least = 0});
  v("channel_bias_scale", channel_bias_scale, "factor on the constant range errors of its channels", {.at_least = 0});
  v("quantisation", quantisation, "round ranges to the sensor's step");
  v("dropout", dropout, "lose echoes that are too weak");
  v("intensity", intensity, "noise on the intensity");
}

void Returns::resize(std::size_t n) {
  echoes.resize(n);
  true_range_m.resize(n);
  kind.resize(n);
  instance.resize(n);
  for (auto* v : {&nx, &ny, &nz}) v->resize(n);
}

void Returns::put(std::size_t i, const Echo& echo, double range_m) {
  echoes.range_m[i] = range_m;
  echoes.signal[i] = echo.signal;
  echoes.cos_incidence[i] = echo.cos_incidence;
  kind[i] = echo.kind;
  instance[i] = echo.instance;
  nx[i] = echo.nx;
  ny[i] = echo.ny;
  nz[i] = echo.nz;
}

Receiver::Noise Receiver::noise_of(const Profile& p, const char* which, std::uint16_t sensor,
                                   std::uint64_t seed) const {
  const std::string range = stream_name(sensor, std::string("range_noise") + which);
  const std::string intensity = stream_name(sensor, std::string("intensity") + which);
  return {RangeNoise(p, noise_options_.range_scale, seed, range.c_str()),
          SnrNoise(p, noise_options_.range_scale, options_.spot_smear, seed, range.c_str()),
          Intensity(noise_options_.intensity, seed, intensity.c_str())};
}

Receiver::Receiver(const Profile& p, const FiringTable& firing, const NoiseOptions& noise, const BeamOptions& options,
                   std::uint16_t sensor, std::uint64_t seed)
    : noise_options_(noise),
      options_(options),
      min_range_m_(p.min_range_m),
      max_range_m_(p.max_range_m),
      range_step_m_(p.range_step_m),
      range_offset_m_(firing.range_offset_m()),
      channels_(firing.channels()),
      detection_(p, seed, stream_name(sensor, "detection").c_str()),
      other_detection_(seed, stream_name(sensor, "detection/others")),
      false_alarms_(seed, stream_name(sensor, "false_alarms")),
      channel_bias_(p, noise.channel_bias_scale, seed, stream_name(sensor, "channel_bias").c_str(),
                    firing.profile_channels()),
      brightness_{options.range_walk_m, options.saturation ? options.saturation_signal : 0, options.saturation_bias_m},
      first_(noise_of(p, "", sensor, seed)),
      second_(noise_of(p, "/second", sensor, seed)) {}

void Receiver::operator()(const EchoField& field, std::size_t first, std::size_t count, std::uint64_t number,
                          Scratch& scratch, Returns& firsts, Returns& seconds) const {
  take(field, first, count, number, firsts);
  if (noise_options_.dropout) detection_(firsts.echoes);
  scratch.more.clear();
  find_more(field, first, count, number, scratch);
  if (options_.false_alarms_per_shot > 0) add_false_alarms(count, number, scratch);
  std::stable_sort(scratch.more.begin(), scratch.more.end(),
                   [](const auto& a, const auto& b) { return a.firing < b.firing; });
  seconds.resize(0);
  seconds.firing.clear();
  seconds.echoes.firings.clear();
  seconds.echoes.channels = channels_;
  for (std::size_t k = 0; k < scratch.more.size();) {
    const std::uint32_t i = scratch.more[k].firing;
    scratch.all.clear();
    const double range_m = firsts.echoes.range_m[i];
    if (reported(range_m))
      scratch.all.push_back(
          {i, range_m, detection_.snr(static_cast<double>(firsts.echoes.signal[i]), range_m), field.at(first + i)});
    for (; k < scratch.more.size() && scratch.more[k].firing == i; ++k) scratch.all.push_back(scratch.more[k]);
    choose(i, number + i, scratch.all, firsts, seconds);
  }
  measure(first_, firsts);
  measure(second_, seconds);
}

/// The strongest echo of every firing.
void Receiver::take(const EchoField& field, std::size_t first, std::size_t count, std::uint64_t number,
                    Returns& out) const {
  out.resize(count);
  Echoes& e = out.echoes;
  e.channels = channels_;
  e.first_firing = number;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = field.t_m[first + i];
    e.range_m[i] = t > 0 ? t + range_offset_m_ : 0;
  }
  const auto copy = [&](const auto& from, auto& to) {
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(count), to.begin());
  };
  copy(field.signal, e.signal);
  copy(field.cos_incidence, e.cos_incidence);
  copy(field.kind, out.kind);
  copy(field.instance, out.instance);
  copy(field.nx, out.nx);
  copy(field.ny, out.ny);
  copy(field.nz, out.nz);
}

/// The other echoes that are detected.
void Receiver::find_more(const EchoField& field, std::size_t first, std::size_t count, std::uint64_t number,
                         Scratch& scratch) const {
  const auto by_firing = [](const EchoField::Other& other, std::size_t firing) { return other.firing < firing; };
  const auto begin = std::lower_bound(field.others.begin(), field.others.end(), first, by_firing);
  const auto end = std::lower_bound(begin, field.others.end(), first + count, by_firing);
  for (auto other = begin; other != end; ++other) {
    const auto i = static_cast<std::uint32_t>(other->firing - first);
    const double range_m = other->echo.t_m + range_offset_m_;
    const double snr = detection_.snr(static_cast<double>(other->echo.signal), range_m);
    const std::uint64_t draw = (number + i) * slots + std::min<std::uint64_t>(other->slot, slots - 1);
    const bool seen = !noise_options_.dropout || snr + other_detection_.normal(draw) > detection_.threshold();
    if (seen && reported(range_m)) scratch.more.push_back({i, range_m, snr, other->echo});
  }
}

/// As strong as what is just seen, anywhere in range.
void Receiver::add_false_alarms(std::size_t count, std::uint64_t number, Scratch& scratch) const {
  scratch.draws.resize(count);
  false_alarms_.uniforms(number, scratch.draws);
  for (std::size_t i = 0; i < count; ++i) {
    if (static_cast<double>(scratch.draws[i]) >= options_.false_alarms_per_shot) continue;
    const double range_m = min_range_m_ + (max_range_m_ - min_range_m_) * false_alarms_.uniform(number + i, 1);
    Echo echo;
    echo.kind = ReturnKind::noise;
    echo.instance = raycast::Hits::nothing;
    echo.signal = static_cast<float>(detection_.threshold() / detection_.snr(1, range_m));
    scratch.more.push_back({static_cast<std::uint32_t>(i), range_m, detection_.threshold(), echo});
  }
}

void Receiver::choose(std::uint32_t i, std::uint64_t number, std::vector<Scratch::Candidate>& candidates,
                      Returns& firsts, Returns& seconds) const {
  using Candidate = Scratch::Candidate;
  const auto weaker = [](const Candidate& a, const Candidate& b) { return a.snr < b.snr; };
  const auto nearer = [](const Candidate& a, const Candidate& b) { return a.range_m < b.range_m; };
  auto chosen = std::max_element(candidates.begin(), candidates.end(), weaker);
  if (options_.returns == "first") chosen = std::min_element(candidates.begin(), candidates.end(), nearer);
  if (options_.returns == "last") chosen = std::max_element(candidates.begin(), candidates.end(), nearer);
  firsts.put(i, chosen->echo, chosen->range_m);
  if (!options_.dual() || candidates.size() < 2) return;
  auto second = std::max_element(candidates.begin(), candidates.end(), nearer);
  if (second == chosen) {
    std::iter_swap(chosen, candidates.end() - 1);
    second = std::max_element(candidates.begin(), candidates.end() - 1, weaker);
  }
  const std::size_t at = seconds.size();
  seconds.resize(at + 1);
  seconds.put(at, second->echo, second->range_m);
  seconds.firing.push_back(i);
  seconds.echoes.firings.push_back(number);
}

void Receiver::measure(const Noise& noise, Returns& r) const {
  if (r.size() == 0) return;
  Echoes& e = r.echoes;
  r.true_range_m = e.range_m;
  if (options_.saturation)
    for (std::size_t i = 0; i < e.size(); ++i)
      if (brightness_.saturates(e.signal[i]) && (r.kind[i] == ReturnKind::surface || r.kind[i] == ReturnKind::edge))
        r.kind[i] = ReturnKind::saturated;
  // Noise goes with how bright the target is, not with what is made of it afterwards.
  const bool by_snr = options_.range_noise == "snr";
  if (noise_options_.range_scale > 0) by_snr ? noise.by_snr(e) : noise.by_range(e);
  if (options_.saturation || options_.range_walk_m != 0) brightness_(e);
  if (noise_options_.channel_bias_scale > 0) channel_bias_(e);
  if (noise_options_.quantisation) quantise(range_step_m_, e);
  noise.intensity(e);
}

}  // namespace tarmac::sim::lidar
