#include "scenes/primitives/mesh_builder.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/shortest_turn.h"

namespace tarmac::scenes {

using Eigen::Vector3d;

namespace {

constexpr double tau = 2 * std::numbers::pi;

/// Two unit vectors that complete `axis` to a right-handed frame (u, v, axis).
void complete_frame(const Vector3d& axis, Vector3d& u, Vector3d& v) {
  const Vector3d up = std::abs(axis.z()) > 0.999 ? Vector3d::UnitY() : Vector3d::UnitZ();
  u = up.cross(axis).normalized();
  v = axis.cross(u);
}

Ring circle(const Vector3d& centre, const Vector3d& u, const Vector3d& v, double radius_m, int segments) {
  Ring ring(static_cast<std::size_t>(segments));
  for (int j = 0; j < segments; ++j) {
    const double a = tau * j / segments;
    ring[static_cast<std::size_t>(j)] = centre + radius_m * (std::cos(a) * u + std::sin(a) * v);
  }
  return ring;
}

std::vector<std::uint32_t> add_vertices(MeshBuilder& b, const Ring& ring) {
  std::vector<std::uint32_t> indices;
  indices.reserve(ring.size());
  for (const Vector3d& p : ring) indices.push_back(b.vertex(p));
  return indices;
}

void add_fan(MeshBuilder& b, const std::vector<std::uint32_t>& ring, const Vector3d& centre, bool forward) {
  const std::uint32_t c = b.vertex(centre);
  for (std::size_t j = 0; j < ring.size(); ++j) {
    const std::uint32_t p = ring[j], q = ring[(j + 1) % ring.size()];
    forward ? b.triangle(c, p, q) : b.triangle(c, q, p);
  }
}

Vector3d centroid(const Ring& ring) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : ring) sum += p;
  return sum / static_cast<double>(ring.size());
}

void join_rings(MeshBuilder& b, const std::vector<std::uint32_t>& lower, const std::vector<std::uint32_t>& upper,
                const QuadMaterial& material, std::size_t i) {
  for (std::size_t j = 0; j < lower.size(); ++j) {
    const std::size_t k = (j + 1) % lower.size();
    if (material) b.use(material(i, j));
    b.quad(lower[j], lower[k], upper[k], upper[j]);
  }
}

/// Circle of a lathe profile: the first vertex at the bottom, then towards +y.
Ring lathe_circle(const ProfilePoint& p, int segments) {
  return circle({p.x_m, 0, 0}, -Vector3d::UnitZ(), Vector3d::UnitY(), p.radius_m, segments);
}

}  // namespace

std::uint32_t MeshBuilder::vertex(const Vector3d& p_local) {
  const Vector3d p(p_local.x(), mirrored_ ? -p_local.y() : p_local.y(), p_local.z());
  mesh_.vertices.push_back((T_mesh_local_ * p).cast<float>());
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (mirrored_) std::swap(b, c);
  mesh_.triangles.push_back({a, b, c});
  mesh_.materials.push_back(material_);
}

void MeshBuilder::quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  triangle(a, b, c);
  triangle(a, c, d);
}

void MeshBuilder::orient_outward(std::size_t first) {
  if (first >= mesh_.triangles.size()) return;
  const Vector3d origin = mesh_.vertices[mesh_.triangles[first][0]].cast<double>();
  double volume = 0;
  for (std::size_t t = first; t < mesh_.triangles.size(); ++t) {
    const auto corner = [&](int k) -> Vector3d {
      return mesh_.vertices[mesh_.triangles[t][static_cast<std::size_t>(k)]].cast<double>() - origin;
    };
    volume += corner(0).dot(corner(1).cross(corner(2)));
  }
  if (volume >= 0) return;
  for (std::size_t t = first; t < mesh_.triangles.size(); ++t) std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
}

void add_box(MeshBuilder& b, const Vector3d& low, const Vector3d& high) {
  const Ring bottom{{low.x(), low.y(), low.z()},
                    {high.x(), low.y(), low.z()},
                    {high.x(), high.y(), low.z()},
                    {low.x(), high.y(), low.z()}};
  std::array<std::uint32_t, 8> v{};
  for (std::size_t j = 0; j < 4; ++j) v[j] = b.vertex(bottom[j]);
  for (std::size_t j = 0; j < 4; ++j) v[j + 4] = b.vertex({bottom[j].x(), bottom[j].y(), high.z()});
  const std::size_t first = b.triangle_count();
  b.quad(v[3], v[2], v[1], v[0]);
  b.quad(v[4], v[5], v[6], v[7]);
  for (std::size_t j = 0; j < 4; ++j) b.quad(v[j], v[(j + 1) % 4], v[(j + 1) % 4 + 4], v[j + 4]);
  b.orient_outward(first);
}

void add_beam(MeshBuilder& b, const Vector3d& p, const Vector3d& q, double width_m, double height_m) {
  const Vector3d axis = (q - p).normalized();
  const Vector3d across = (std::abs(axis.z()) > 0.999 ? Vector3d::UnitX() : Vector3d::UnitZ().cross(axis).normalized());
  const Vector3d u = across * (width_m / 2), v = axis.cross(across) * (height_m / 2);
  const auto ring = [&](const Vector3d& c) { return Ring{c - u - v, c + u - v, c + u + v, c - u + v}; };
  add_loft(b, {ring(p), ring(q)});
}

void add_frustum(MeshBuilder& b, const Vector3d& p, const Vector3d& q, double radius_p_m, double radius_q_m,
                 int segments) {
  Vector3d u, v;
  complete_frame((q - p).normalized(), u, v);
  add_loft(b, {circle(p, u, v, radius_p_m, segments), circle(q, u, v, radius_q_m, segments)});
}

void add_loft(MeshBuilder& b, const std::vector<Ring>& rings, const QuadMaterial& material) {
  const std::size_t first = b.triangle_count();
  std::vector<std::uint32_t> lower = add_vertices(b, rings.front());
  if (material) b.use(material(0, rings.front().size() / 4));
  add_fan(b, lower, centroid(rings.front()), false);
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
    std::vector<std::uint32_t> upper = add_vertices(b, rings[i + 1]);
    join_rings(b, lower, upper, material, i);
    lower = std::move(upper);
  }
  add_fan(b, lower, centroid(rings.back()), true);
  b.orient_outward(first);
}

void add_lathe(MeshBuilder& b, const std::vector<ProfilePoint>& profile, int segments) {
  const std::size_t first = b.triangle_count();
  const auto on_axis = [](const ProfilePoint& p) { return p.radius_m <= 0; };
  std::vector<std::uint32_t> previous;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const ProfilePoint& p = profile[i];
    const Vector3d axis_point(p.x_m, 0, 0);
    if (i > 0) b.use(profile[i - 1].material);
    if (on_axis(p)) {
      if (!previous.empty()) add_fan(b, previous, axis_point, true);
      previous.clear();
      continue;
    }
    std::vector<std::uint32_t> current = add_vertices(b, lathe_circle(p, segments));
    if (previous.empty()) {
      const bool from_axis = i > 0 && on_axis(profile[i - 1]);
      if (!from_axis) b.use(p.material);
      add_fan(b, current, from_axis ? Vector3d(profile[i - 1].x_m, 0, 0) : axis_point, false);
    } else {
      join_rings(b, previous, current, {}, i);
    }
    previous = std::move(current);
  }
  if (!previous.empty()) add_fan(b, previous, {profile.back().x_m, 0, 0}, true);
  b.orient_outward(first);
}

void add_lathe_loop(MeshBuilder& b, const std::vector<ProfilePoint>& profile, int segments) {
  const std::size_t first = b.triangle_count();
  std::vector<std::vector<std::uint32_t>> rings;
  rings.reserve(profile.size());
  for (const ProfilePoint& p : profile) rings.push_back(add_vertices(b, lathe_circle(p, segments)));
  for (std::size_t i = 0; i < profile.size(); ++i) {
    b.use(profile[i].material);
    join_rings(b, rings[i], rings[(i + 1) % rings.size()], {}, i);
  }
  b.orient_outward(first);
}

void add_bar(MeshBuilder& b, const std::vector<Vector3d>& line, double radius_m, int segments) {
  std::vector<Ring> rings;
  Vector3d axis, u, v;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vector3d before = i > 0 ? Vector3d((line[i] - line[i - 1]).normalized()) : Vector3d::Zero();
    const Vector3d after = i + 1 < line.size() ? Vector3d((line[i + 1] - line[i]).normalized()) : Vector3d::Zero();
    const Vector3d next_axis = (before + after).normalized();
    if (i == 0) {
      complete_frame(next_axis, u, v);
    } else {  // turned along with the axis by the shortest way, so that the bar does not twist
      const Eigen::Quaterniond turn = core::shortest_turn(axis, next_axis);
      u = turn * u;
      v = turn * v;
    }
    axis = next_axis;
    rings.push_back(circle(line[i], u, v, radius_m, segments));
  }
  add_loft(b, rings);
}

void add_plate(MeshBuilder& b, const std::vector<Eigen::Vector2d>& outline_xz, double y0_m, double y1_m) {
  Ring near, far;
  for (const Eigen::Vector2d& p : outline_xz) {
    near.emplace_back(p.x(), y0_m, p.y());
    far.emplace_back(p.x(), y1_m, p.y());
  }
  add_loft(b, {near, far});
}

void add_patch(MeshBuilder& b, const Vector3d& corner_a, const Vector3d& corner_b, const Vector3d& corner_c,
               const Vector3d& corner_d, int nu, int nv) {
  std::vector<std::uint32_t> grid;
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const double u = static_cast<double>(i) / nu, v = static_cast<double>(j) / nv;
      grid.push_back(b.vertex((1 - v) * ((1 - u) * corner_a + u * corner_b) + v * ((1 - u) * corner_d + u * corner_c)));
    }
  }
  const auto at = [&](int i, int j) { return grid[static_cast<std::size_t>(j * (nu + 1) + i)]; };
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) b.quad(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
}

core::SE3 place(double x_m, double y_m, double z_m, double yaw_rad) {
  core::SE3 T = core::SE3::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Vector3d(x_m, y_m, z_m);
  return T;
}

}  // namespace tarmac::scenes
