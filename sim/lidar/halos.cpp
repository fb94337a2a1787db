// Light beside its beam: what very bright targets put into the beams next to theirs.
#include <algorithm>
#include <cmath>

#include "sim/lidar/beam_model.h"

namespace tarmac::sim::lidar {
namespace {

constexpr double halo_within_m = 30;
constexpr float halo_from_signal = 100;
constexpr std::uint32_t halo_slot = 15;  // beyond what a footprint's rays can make

}  // namespace

/// Very bright targets near by reach the beams beside theirs. A beam keeps what it has as another echo.
void BeamModel::add_halos(BeamWorkspace& w) const {
  const auto channels = static_cast<std::int64_t>(beside_.size()),
             cycles = static_cast<std::int64_t>(w.echoes.size()) / channels;
  std::vector<EchoField::Other> halos;
  for (std::size_t f = 0; f < w.echoes.size(); ++f) {
    const Echo source = w.echoes.at(f);
    if (source.t_m <= 0 || source.t_m > halo_within_m || source.signal < halo_from_signal ||
        source.kind == ReturnKind::self)
      continue;
    const std::int64_t cycle = static_cast<std::int64_t>(f) / channels;
    for (const Beside& beside : beside_[f % beside_.size()]) {
      const std::int64_t other = cycle + beside.cycles;
      if (other < 0 || other >= cycles) continue;
      Echo halo = source;
      halo.signal *= beside.share;
      halo.kind = ReturnKind::retro_halo;
      halos.push_back({static_cast<std::uint32_t>(other * channels + beside.channel), 0, halo});
    }
  }
  merge_halos(halos, w);
}

/// Of several halos the strongest; none where the beam's own echo is so near that the two are one, or where the beam
/// ends on the own vehicle.
void BeamModel::merge_halos(std::vector<EchoField::Other>& halos, BeamWorkspace& w) const {
  std::stable_sort(halos.begin(), halos.end(), [](const auto& a, const auto& b) {
    return a.firing != b.firing ? a.firing < b.firing : a.echo.signal > b.echo.signal;
  });
  EchoField& e = w.echoes;
  for (std::size_t k = 0; k < halos.size(); ++k) {
    EchoField::Other& halo = halos[k];
    const std::uint32_t f = halo.firing;
    if (k > 0 && halos[k - 1].firing == f) continue;
    if (e.t_m[f] <= 0) {
      e.put(f, halo.echo);
      continue;
    }
    if (std::abs(e.t_m[f] - halo.echo.t_m) <= separation_m_ || e.kind[f] == ReturnKind::self) continue;
    const auto strength = [&](double signal, double t_m) { return detection_.snr(signal, t_m + range_offset_m_); };
    halo.slot = halo_slot;
    if (strength(static_cast<double>(halo.echo.signal), halo.echo.t_m) >
        strength(static_cast<double>(e.signal[f]), e.t_m[f])) {
      const Echo own = e.at(f);
      e.put(f, halo.echo);
      halo.echo = own;
    }
    e.others.push_back(halo);
  }
}

}  // namespace tarmac::sim::lidar
