#include "sim/lidar/echo_train.h"

#include <algorithm>
#include <cmath>

namespace tarmac::sim::lidar {
namespace {

constexpr float same_plane_m = 0.05f;
constexpr float same_normal = 0.985f;  // 10 degrees
constexpr double mixed_from_m = 0.05;

bool on_one_plane(const Part& a, const Part& b) {
  return a.kind == b.kind && std::abs(a.plane_m - b.plane_m) < same_plane_m &&
         a.nx * b.nx + a.ny * b.ny + a.nz * b.nz > same_normal;
}

/// The part that stands for a surface which all rays met: the centre ray's, else the strongest.
const Part& main_part_of_one(std::span<const Part> parts) {
  const Part* chief = &parts.front();
  for (const Part& p : parts)
    if (chief->ray != 0 && (p.ray == 0 || p.signal > chief->signal)) chief = &p;
  return *chief;
}

bool one_surface(std::span<const Part> parts) {
  bool one = true;
  for (const Part& p : parts) one &= (p.instance == parts.front().instance) & (p.kind == parts.front().kind);
  return one;
}

/// The same for the surface which gave the most.
const Part& main_part(std::span<const Part> parts) {
  if (one_surface(parts)) return main_part_of_one(parts);
  const Part* best = &parts.front();
  float most = -1;
  for (const Part& of : parts) {
    float sum = 0;
    const Part* chief = nullptr;
    for (const Part& p : parts) {
      if (p.instance != of.instance || p.kind != of.kind) continue;
      sum += p.signal;
      if (!chief || (chief->ray != 0 && (p.ray == 0 || p.signal > chief->signal))) chief = &p;
    }
    if (sum > most) {
      most = sum;
      best = chief;
    }
  }
  return *best;
}

Echo echo_of(std::span<const Part> parts) {
  const Part& main = main_part(parts);
  Echo echo{parts.front().t_m, parts.front().signal, main.cos_incidence, main.nx, main.ny,
            main.nz,           main.instance,        main.kind};
  if (parts.size() == 1) return echo;
  double sum = 0, moment = 0;
  bool mixed = false;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto signal = static_cast<double>(parts[i].signal);
    sum += signal;
    moment += signal * parts[i].t_m;
    mixed = mixed || (i > 0 && parts[i].t_m - parts[i - 1].t_m > mixed_from_m && !on_one_plane(parts[i - 1], parts[i]));
  }
  echo.signal = static_cast<float>(sum);
  if (sum > 0) echo.t_m = moment / sum;
  if (mixed) echo.kind = ReturnKind::mixed;
  return echo;
}

}  // namespace

void tell_apart(std::vector<Part>& parts, double separation_m, std::vector<Echo>& echoes) {
  echoes.clear();
  double nearest = parts.front().t_m, farthest = nearest;
  for (const Part& p : parts) {
    nearest = std::min(nearest, p.t_m);
    farthest = std::max(farthest, p.t_m);
  }
  if (farthest - nearest <= std::min(separation_m, mixed_from_m)) {  // one echo and not mixed, in whatever order
    echoes.push_back(echo_of(parts));
    return;
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.t_m != b.t_m ? a.t_m < b.t_m : a.ray < b.ray; });
  std::size_t surfaces = 0;
  for (std::size_t first = 0; first < parts.size();) {
    std::size_t last = first + 1;
    while (last < parts.size() &&
           (parts[last].t_m - parts[last - 1].t_m <= separation_m || on_one_plane(parts[last - 1], parts[last])))
      ++last;
    echoes.push_back(echo_of(std::span(parts).subspan(first, last - first)));
    const ReturnKind kind = echoes.back().kind;
    surfaces += kind == ReturnKind::surface || kind == ReturnKind::mixed;
    first = last;
  }
  if (surfaces < 2) return;
  for (Echo& echo : echoes)
    if (echo.kind == ReturnKind::surface) echo.kind = ReturnKind::edge;
}

}  // namespace tarmac::sim::lidar
