/// Grows a mesh from primitives. Every primitive owns its vertices, so the connected parts of a mesh are its
/// primitives; closed primitives turn their own winding outward.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/lie.h"
#include "scenes/materials/materials.h"
#include "scenes/scene.h"

namespace tarmac::scenes {

class MeshBuilder {
 public:
  explicit MeshBuilder(std::string name) { mesh_.name = std::move(name); }

  /// Material of the triangles that follow.
  MeshBuilder& use(MaterialId material) {
    material_ = static_cast<std::uint16_t>(material);
    return *this;
  }
  /// Where the primitives that follow are built: p_mesh = T_mesh_local * p_local.
  MeshBuilder& at(const core::SE3& T_mesh_local) {
    T_mesh_local_ = T_mesh_local;
    return *this;
  }
  /// Replaces y by -y in the local frame (a right wing from a left one); winding is kept outward.
  MeshBuilder& mirror_y(bool on) {
    mirrored_ = on;
    return *this;
  }

  std::uint32_t vertex(const Eigen::Vector3d& p_local);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// Counter-clockwise seen from outside; split along a-c.
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);

  std::size_t triangle_count() const { return mesh_.triangles.size(); }
  /// Turns the closed part made of the triangles from `first` on outward, by the sign of its volume.
  void orient_outward(std::size_t first);
  Mesh build() && { return std::move(mesh_); }

 private:
  Mesh mesh_;
  std::uint16_t material_ = 0;
  core::SE3 T_mesh_local_ = core::SE3::Identity();
  bool mirrored_ = false;
};

using Ring = std::vector<Eigen::Vector3d>;
/// Material of the quad between ring i and i + 1, ring vertices j and j + 1.
using QuadMaterial = std::function<MaterialId(std::size_t i, std::size_t j)>;

/// Axis-aligned in the local frame; closed.
void add_box(MeshBuilder& b, const Eigen::Vector3d& low, const Eigen::Vector3d& high);
/// A box of width `width_m` (across) and `height_m` whose centre line runs from p to q; closed. Across is horizontal
/// unless the line is vertical, when it is x.
void add_beam(MeshBuilder& b, const Eigen::Vector3d& p, const Eigen::Vector3d& q, double width_m, double height_m);
/// Truncated cone with flat ends; closed.
void add_frustum(MeshBuilder& b, const Eigen::Vector3d& p, const Eigen::Vector3d& q, double radius_p_m,
                 double radius_q_m, int segments);
/// Rings of equal size joined by quads, first and last ring closed by fans around their centroids; closed.
/// `material` may be empty: then the builder's current one.
void add_loft(MeshBuilder& b, const std::vector<Ring>& rings, const QuadMaterial& material = {});
/// One point of a profile turned about the local x axis; `material` holds from this point to the next.
struct ProfilePoint {
  double x_m = 0;
  double radius_m = 0;
  MaterialId material{};
};
/// Surface of revolution about the local x axis; closed: a profile that begins or ends off the axis gets a flat cap.
/// A vertex of each circle lies at the bottom (-z), so that wheels of any number of segments stand on the ground.
void add_lathe(MeshBuilder& b, const std::vector<ProfilePoint>& profile, int segments);
/// The same for a profile that is a loop off the axis (a tyre).
void add_lathe_loop(MeshBuilder& b, const std::vector<ProfilePoint>& profile, int segments);
/// A round bar along a polyline; closed.
void add_bar(MeshBuilder& b, const std::vector<Eigen::Vector3d>& line, double radius_m, int segments);
/// A convex polygon in the local x-z plane given thickness across y (from y0 to y1); closed.
void add_plate(MeshBuilder& b, const std::vector<Eigen::Vector2d>& outline_xz, double y0_m, double y1_m);
/// An open rectangle a, b, c, d (counter-clockwise from outside) cut into nu x nv cells (a-b, a-d).
void add_patch(MeshBuilder& b, const Eigen::Vector3d& corner_a, const Eigen::Vector3d& corner_b,
               const Eigen::Vector3d& corner_c, const Eigen::Vector3d& corner_d, int nu = 1, int nv = 1);

/// Pose helper: translation and rotation about z [rad].
core::SE3 place(double x_m, double y_m, double z_m, double yaw_rad = 0);

}  // namespace tarmac::scenes
