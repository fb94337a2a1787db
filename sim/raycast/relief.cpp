#include "sim/raycast/relief.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/vector_loop.h"

namespace tarmac::sim::raycast {
namespace {

constexpr float tolerance_m = 50e-6f;  // of height
constexpr int max_iterations = 40;
constexpr std::size_t block = 256;  // rays that iterate together: their arrays stay in the first-level cache
constexpr float infinity = std::numeric_limits<float>::infinity();

/// One step of every ray, in arrays of equal length.
struct Iteration {
  const float *dx, *dy, *nd, *height_m, *slope_x, *slope_y;
  float *s, *above, *below, *highest_m, *retreat;
  std::uint32_t* done;
};

// Heights seen so far bound how far a ray can be from its macro hit: farther out it is above or in the relief for sure.
// `above` and `below` are the known sides of the root nearest to it: rays run from above the relief to below it. Where
// the ray is above the relief behind a crest that it has gone through, only what comes before the crest counts.
TARMAC_VECTOR_LOOP void bracket(std::size_t count, const Iteration it) {
#pragma GCC ivdep
  for (std::size_t k = 0; k < count; ++k) {
    const float s = it.s[k], h = it.height_m[k], above = it.above[k], below = it.below[k], highest = it.highest_m[k];
    const float f = s * it.nd[k] - h, size = f < 0 ? -f : f, height = h < 0 ? -h : h;
    it.highest_m[k] = height > highest ? height : highest;
    const float lowered = s < below ? s : below, below_now = f <= 0 ? lowered : below;
    const float in_above = above >= below_now ? -infinity : above;
    const float higher = s > above ? s : above, out_above = s < below ? higher : above;
    it.below[k] = below_now;
    it.above[k] = f <= 0 ? in_above : out_above;
    it.done[k] = size < tolerance_m ? 1u : 0u;
  }
}

// The Newton step where it lies between the known sides, else a point that brings them together.
TARMAC_VECTOR_LOOP void step(std::size_t count, float settled_m, const Iteration it) {
#pragma GCC ivdep
  for (std::size_t k = 0; k < count; ++k) {
    const float s = it.s[k], nd = it.nd[k], above = it.above[k], below = it.below[k], retreat = it.retreat[k];
    // The height field's own slope may turn the ray's approach round; the macro slope never does.
    const float own = nd - it.slope_x[k] * it.dx[k] - it.slope_y[k] * it.dy[k];
    const float wanted = s - (s * nd - it.height_m[k]) / (own < 0.25f * nd ? own : nd);
    const float last = 0.5f * (above + below), farther = 2 * retreat;
    const float behind = below + farther * it.highest_m[k] / nd;
    const bool two_sides = below - above < infinity;
    const float fallback = two_sides ? last : behind;
    const float low = two_sides ? above : -infinity;
    const float next_low = wanted > low ? wanted : fallback, next = wanted < below ? next_low : fallback;
    const float one_side = wanted < below ? retreat : farther;
    it.retreat[k] = two_sides ? retreat : one_side;
    const float moved = next - s, way = moved < 0 ? -moved : moved;
    const bool newton = (next == wanted) & (own < 0.25f * nd);
    it.s[k] = it.done[k] != 0 ? s : next;
    it.done[k] = (it.done[k] != 0) | (newton & (way < settled_m)) ? 1u : 0u;
  }
}

TARMAC_VECTOR_LOOP void advance(std::size_t count, const double* __restrict px, const double* __restrict py,
                                const float* __restrict dx, const float* __restrict dy, const float* __restrict s,
                                double* __restrict x, double* __restrict y) {
  for (std::size_t k = 0; k < count; ++k) {
    x[k] = px[k] + static_cast<double>(s[k] * dx[k]);
    y[k] = py[k] + static_cast<double>(s[k] * dy[k]);
  }
}

/// Of the relief's normal n - grad h with the ray. A facet that faces away is hidden by its crest in truth; the visible
/// ones are seen no flatter than a quarter of the macro surface's cosine.
TARMAC_VECTOR_LOOP void shade(std::size_t count, const float* __restrict dx, const float* __restrict dy,
                              const float* __restrict nx, const float* __restrict ny, const float* __restrict nz,
                              const float* __restrict nd, const float* __restrict slope_x,
                              const float* __restrict slope_y, float* __restrict cosine) {
  for (std::size_t k = 0; k < count; ++k) {
    const float gx = slope_x[k], gy = slope_y[k], flat = -nd[k];
    const float mx = nx[k] - gx, my = ny[k] - gy, mz = nz[k];
    const float c = (flat + gx * dx[k] + gy * dy[k]) / std::sqrt(mx * mx + my * my + mz * mz);
    const float least = 0.25f * flat, seen = c < least ? least : c;
    cosine[k] = seen > 1 ? 1 : seen;
  }
}

}  // namespace

void ReliefBatch::reserve(std::size_t count) {
  if (px_m_.size() >= count) return;
  for (auto* v : {&px_m_, &py_m_}) v->resize(count);
  for (auto* v : {&dx_, &dy_, &nx_, &ny_, &nz_, &nd_, &s_out_, &slope_x_out_, &slope_y_out_, &cosine_})
    v->resize(count);
  for (auto* v : {&ax_m_, &ay_m_, &x_m_, &y_m_}) v->resize(block);
  for (auto* v : {&adx_, &ady_, &and_, &s_, &above_, &below_, &highest_m_, &retreat_, &height_m_, &slope_x_, &slope_y_})
    v->resize(block);
  ray_.resize(block);
  done_.resize(block);
  kept_.resize(block);
}

/// Notes where each ray stands and moves those that are not done to the front; returns how many there are.
std::size_t ReliefBatch::compact(std::size_t first, std::size_t count, std::size_t active) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < active; ++k) {
    kept_[kept] = static_cast<std::uint32_t>(k);
    kept += done_[k] == 0;
  }
  if (active == count) {  // the rays are still in their own order
    std::copy_n(s_.begin(), count, &s_out_[first]);
    std::copy_n(slope_x_.begin(), count, &slope_x_out_[first]);
    std::copy_n(slope_y_.begin(), count, &slope_y_out_[first]);
  } else {
    for (std::size_t k = 0; k < active; ++k) {
      const std::size_t ray = first + ray_[k];
      s_out_[ray] = s_[k], slope_x_out_[ray] = slope_x_[k], slope_y_out_[ray] = slope_y_[k];
    }
  }
  if (kept == active) return kept;
  for (std::size_t k = 0; k < kept; ++k) {
    const std::uint32_t from = kept_[k];
    ray_[k] = ray_[from];
    ax_m_[k] = ax_m_[from], ay_m_[k] = ay_m_[from];
    adx_[k] = adx_[from], ady_[k] = ady_[from], and_[k] = and_[from];
    s_[k] = s_[from], above_[k] = above_[from], below_[k] = below_[from];
    highest_m_[k] = highest_m_[from], retreat_[k] = retreat_[from];
  }
  return kept;
}

void ReliefBatch::solve_block(const scenes::Relief& relief, float settled_m, std::size_t first, std::size_t count) {
  std::copy_n(&px_m_[first], count, ax_m_.begin());
  std::copy_n(&py_m_[first], count, ay_m_.begin());
  std::copy_n(&dx_[first], count, adx_.begin());
  std::copy_n(&dy_[first], count, ady_.begin());
  std::copy_n(&nd_[first], count, and_.begin());
  std::fill_n(s_.begin(), count, 0.0f);
  std::fill_n(above_.begin(), count, -infinity);
  std::fill_n(below_.begin(), count, infinity);
  std::fill_n(highest_m_.begin(), count, 0.0f);
  std::fill_n(retreat_.begin(), count, 0.5f);
  for (std::size_t k = 0; k < count; ++k) ray_[k] = static_cast<std::uint32_t>(k);
  const Iteration it{adx_.data(), ady_.data(),   and_.data(),   height_m_.data(),  slope_x_.data(), slope_y_.data(),
                     s_.data(),   above_.data(), below_.data(), highest_m_.data(), retreat_.data(), done_.data()};
  std::size_t active = count;
  for (int i = 0; i < max_iterations && active > 0; ++i) {
    advance(active, ax_m_.data(), ay_m_.data(), adx_.data(), ady_.data(), s_.data(), x_m_.data(), y_m_.data());
    relief.heights_m(active, x_m_.data(), y_m_.data(), height_m_.data(), slope_x_.data(), slope_y_.data());
    bracket(active, it);
    step(active, settled_m, it);
    // Unless a small step settles it, hardly a ray is done after the first look: it stays where it is until the second.
    if (i > 0 || settled_m > 0) active = compact(first, count, active);
  }
}

void ReliefBatch::solve(const scenes::Relief& relief, float settled_m) {
  for (std::size_t first = 0; first < size_; first += block)
    solve_block(relief, settled_m, first, std::min(block, size_ - first));
  shade(size_, dx_.data(), dy_.data(), nx_.data(), ny_.data(), nz_.data(), nd_.data(), slope_x_out_.data(),
        slope_y_out_.data(), cosine_.data());
}

ReliefHit meet_relief(const scenes::Relief& relief, const Eigen::Vector3d& p_macro_world,
                      const Eigen::Vector3d& direction, const Eigen::Vector3d& normal, double t_macro_m) {
  const double nd = normal.dot(direction);
  if (!ReliefBatch::applies(nd)) return {t_macro_m, -nd};
  const Eigen::Vector3f d = direction.cast<float>(), n = normal.cast<float>();
  ReliefBatch one;
  one.reserve(1);
  one.push_back(p_macro_world.x(), p_macro_world.y(), d.x(), d.y(), n.x(), n.y(), n.z(), static_cast<float>(nd));
  one.solve(relief);
  return {t_macro_m + one.s_m()[0], one.cos_incidence()[0]};
}

}  // namespace tarmac::sim::raycast
