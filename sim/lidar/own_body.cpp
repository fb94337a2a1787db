#include "sim/lidar/own_body.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "core/config.h"
#include "core/error.h"
#include "scenes/equipment/equipment.h"
#include "scenes/materials/materials.h"
#include "scenes/primitives/inside.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::sim::lidar {
namespace {

using Eigen::Vector3d;
using raycast::Hits;
using raycast::SweepTracer;

constexpr double underside_m = 0.3;
constexpr double reach_m = 60;

void bounds(const scenes::Mesh& mesh, Vector3d& low, Vector3d& high) {
  low.setConstant(std::numeric_limits<double>::infinity());
  high = -low;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    low = low.cwiseMin(v.cast<double>());
    high = high.cwiseMax(v.cast<double>());
  }
}

std::shared_ptr<const scenes::Scene> scene_of(scenes::Mesh mesh) {
  scenes::Scene scene;
  scene.name = "own body";
  scene.materials = scenes::materials();
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({.mesh = 0, .label = scenes::Label::own_body});
  return std::make_shared<const scenes::Scene>(std::move(scene));
}

}  // namespace

void BodyOptions::visit(core::OptionVisitor& v) {
  v("kind", kind, "none (beams do not see it), box, or a name of scenes/equipment such as baggage-tractor");
  if (sized) {
    v("length_m", length_m, "from rear to front; with kind none: of what others must not run into, as are the next",
      {.above = 0, .at_most = 100});
    v("width_m", width_m, "of the body", {.above = 0, .at_most = 100});
    v("height_m", height_m, "of its top above the ground", {.above = underside_m, .at_most = 100});
  }
  if (sized || any())
    v("rear_overhang_m", rear_overhang_m, "from the rear axle back to the rear", {.at_least = 0, .at_most = 100});
}

bool gives_size(const core::ConfigNode& node) {
  const std::string kind = node.child("kind").present() ? node.child("kind").scalar("kind") : BodyOptions{}.kind;
  const auto& known = scenes::equipment();
  const bool equipment =
      std::any_of(known.begin(), known.end(), [&](const scenes::EquipmentEntry& e) { return kind == e.name; });
  for (const char* size : {"length_m", "width_m", "height_m"}) {
    if (!node.child(size).present()) continue;
    if (equipment) node.fail_at(size, fmt::format("{} has a size of its own: take it away", kind));
    return true;
  }
  return kind == "box" || (!equipment && node.child("rear_overhang_m").present());
}

std::vector<std::string> body_kinds() {
  std::vector<std::string> kinds{"none", "box"};
  for (const scenes::EquipmentEntry& e : scenes::equipment()) kinds.emplace_back(e.name);
  return kinds;
}

void check_body(const core::ConfigNode& node, const BodyOptions& o, const core::SE3& T_body_lidar) {
  const std::vector<std::string> kinds = body_kinds();
  if (std::find(kinds.begin(), kinds.end(), o.kind) == kinds.end()) {
    const std::string guess = core::did_you_mean(o.kind, kinds);
    node.fail_at("kind",
                 fmt::format("'{}' is no body{}; there are: {}", o.kind,
                             guess.empty() ? "" : fmt::format(", did you mean '{}'?", guess), fmt::join(kinds, ", ")));
  }
  if (!o.any()) return;
  const Vector3d p = T_body_lidar.translation();
  if (o.kind != "box") {
    if (scenes::is_inside(body_mesh(o), p))
      node.fail(
          fmt::format("the LiDAR stands at ({}, {}, {}) m, inside a solid part of {}: every beam would end there; move "
                      "T_body_lidar",
                      p.x(), p.y(), p.z(), o.kind));
    return;
  }
  const bool inside = p.x() > -o.rear_overhang_m && p.x() < o.length_m - o.rear_overhang_m &&
                      std::abs(p.y()) < o.width_m / 2 && p.z() > underside_m && p.z() < o.height_m;
  if (inside)
    node.fail(
        fmt::format("the LiDAR stands at ({}, {}, {}) m, inside the body's box: it would see nothing else; raise "
                    "T_body_lidar above height_m",
                    p.x(), p.y(), p.z()));
}

scenes::Mesh body_mesh(const BodyOptions& o) {
  if (o.kind == "box") {
    scenes::MeshBuilder b("own_body");
    b.use(scenes::MaterialId::gse_paint_white);
    scenes::add_box(b, {-o.rear_overhang_m, -o.width_m / 2, underside_m},
                    {o.length_m - o.rear_overhang_m, o.width_m / 2, o.height_m});
    return std::move(b).build();
  }
  scenes::Mesh mesh = scenes::make_equipment(o.kind);
  Vector3d low, high;
  bounds(mesh, low, high);
  const auto forward = static_cast<float>(-o.rear_overhang_m - low.x());
  for (Eigen::Vector3f& v : mesh.vertices) v.x() += forward;
  return mesh;
}

OwnBody::OwnBody(scenes::Mesh mesh)
    : scene_(scene_of(std::move(mesh))),
      tracer_(std::make_unique<const raycast::Tracer>(scene_, raycast::TracerSettings{})),
      reflectance_(scene_->materials) {
  bounds(scene_->meshes.front(), low_, high_);
}

bool OwnBody::passes_by(const raycast::Rays& rays, std::size_t i) const {
  double in = 0, out = reach_m;
  const double o[3] = {rays.ox[i], rays.oy[i], rays.oz[i]}, d[3] = {rays.dx[i], rays.dy[i], rays.dz[i]};
  for (int k = 0; k < 3; ++k) {
    // A ray along a face divides by zero: infinities compare as they should, 0 * infinity does not and is let pass.
    const double a = (low_[k] - o[k]) / d[k], b = (high_[k] - o[k]) / d[k];
    if (a < b ? a > in : b > in) in = a < b ? a : b;
    if (a < b ? b < out : a < out) out = a < b ? b : a;
  }
  return in > out;
}

void OwnBody::meet(const raycast::Rays& rays, std::vector<Hit>& out) const {
  out.clear();
  std::vector<std::uint32_t> order;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!passes_by(rays, i)) order.push_back(static_cast<std::uint32_t>(i));
  if (order.empty()) return;
  const std::vector<std::uint32_t> met = order;
  order.resize((order.size() + SweepTracer::tile - 1) / SweepTracer::tile * SweepTracer::tile, SweepTracer::no_ray);
  const SweepTracer traced = tracer_->sweep(core::Time{}, core::Time{} + core::Duration(1), Vector3d::Zero(), reach_m);
  raycast::Rays shifted = rays;
  for (std::size_t i = 0; i < shifted.size(); ++i) {
    shifted.ox[i] -= traced.base().x();
    shifted.oy[i] -= traced.base().y();
    shifted.oz[i] -= traced.base().z();
    shifted.t_ns[i] = 0;
  }
  Hits hits;
  traced.trace(shifted, order, hits);
  std::vector<float> signal(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i)
    if (hits.instance[i] == Hits::nothing) hits.material[i] = 0;
  reflectance_.signals(hits.size(), hits.material.data(), hits.cos_incidence.data(), signal.data());
  for (const std::uint32_t i : met)
    if (hits.instance[i] != Hits::nothing)
      out.push_back({i, hits.t_m[i], signal[i], hits.cos_incidence[i], hits.nx[i], hits.ny[i], hits.nz[i]});
}

}  // namespace tarmac::sim::lidar
