#include "sim/collisions.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/error.h"
#include "scenes/primitives/inside.h"

namespace tarmac::sim {
namespace {

using core::SE3;
using core::Time;
using Eigen::Vector3d;

constexpr double touch_m = 0.02;
constexpr double lift_m = 0.15;
constexpr double interval_s = 0.5;
constexpr double difference_s = 1e-3;

using Triangles = fcl::BVHModel<fcl::OBBRSSd>;
using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

/// A rigid piece of a body.
struct Piece {
  Geometry geometry;
  SE3 T_body_piece = SE3::Identity();
  const scenes::Mesh* mesh = nullptr;  ///< that it is; null: a box, or what stands
};

/// Anything that may run into something.
struct Body {
  std::string name;
  const scenes::Actor* actor = nullptr;  ///< null: the ego vehicle, or what stands
  double radius_m = 0;
  std::function<SE3(Time)> pose;
  std::function<double(Time, Time)> acceleration_m_s2;  ///< bound over a time, of all its points
  std::function<const std::vector<Piece>&()> pieces;    ///< made when first asked for
};

/// How far a body's points are from where its origin is in the middle of an interval, at most.
struct Reach {
  Vector3d centre_m;
  double radius_m;
};

struct Interval {
  Time begin, end;
};

/// Meshes as FCL has them; each is made once, when something comes near.
class Shapes {
 public:
  explicit Shapes(const scenes::Scene& scene) : scene_(scene), of_mesh_(scene.meshes.size()) {}

  Geometry mesh(std::uint32_t index) {
    Geometry& shape = of_mesh_[index];
    if (!shape) {
      const scenes::Mesh& mesh = scene_.meshes[index];
      std::vector<Vector3d> vertices;
      for (const Eigen::Vector3f& v : mesh.vertices) vertices.push_back(v.cast<double>());
      std::vector<fcl::Triangle> triangles;
      for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
      shape = of_triangles(vertices, triangles);
    }
    return shape;
  }

  static Geometry of_triangles(const std::vector<Vector3d>& vertices, const std::vector<fcl::Triangle>& triangles) {
    auto model = std::make_shared<Triangles>();
    model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
    model->addSubModel(vertices, triangles);
    model->endModel();
    model->computeLocalAABB();
    return model;
  }

 private:
  const scenes::Scene& scene_;
  std::vector<Geometry> of_mesh_;
};

Body actor_body(const scenes::Scene& scene, std::size_t index, const std::shared_ptr<Shapes>& shapes) {
  const scenes::Actor& actor = scene.actors[index];
  auto pieces = std::make_shared<std::vector<Piece>>();
  const auto make = [&scene, index, shapes, pieces]() -> const std::vector<Piece>& {
    if (pieces->empty())
      for (const scenes::Instance& instance : scene.instances)
        if (instance.actor == static_cast<std::int32_t>(index) && !scene.meshes[instance.mesh].triangles.empty())
          pieces->push_back({shapes->mesh(instance.mesh), instance.T_parent_mesh, &scene.meshes[instance.mesh]});
    return *pieces;
  };
  return {actor.name,
          &actor,
          actor.radius_m,
          [&actor](Time t) { return actor.motion->T_world_actor(t); },
          [&actor](Time t0, Time t1) { return actor.motion->acceleration_bound_m_s2(t0, t1, actor.radius_m); },
          make};
}

/// Largest acceleration of any point of the ego vehicle in each interval, from samples every 10 ms with a share over.
std::vector<double> ego_accelerations(const core::SmoothTrajectory& ego, double radius_m, Time end) {
  std::vector<double> bounds;
  const core::Duration step = core::duration_from_s(0.01);
  for (Time t = ego.begin(); t <= end; t += step) {
    const core::Kinematics k = ego.at(t);
    const double a = k.a_world.norm() + (k.alpha_body.norm() + k.omega_body.squaredNorm()) * radius_m;
    const auto index = static_cast<std::size_t>(core::to_s(t - ego.begin()) / interval_s);
    bounds.resize(std::max(bounds.size(), index + 1), 0);
    bounds[index] = std::max(bounds[index], 1.3 * a + 0.1);
  }
  return bounds;
}

Body ego_body(const core::SmoothTrajectory& ego, const truth::BodyBox& box, Time end) {
  const Vector3d size(box.length_m, box.width_m, box.height_m + box.below_m);
  const Vector3d middle(0.5 * box.length_m - box.rear_overhang_m, 0, 0.5 * (box.height_m - box.below_m));
  const double radius_m = middle.norm() + 0.5 * size.norm();
  auto pieces = std::make_shared<std::vector<Piece>>(1);
  pieces->front().geometry = std::make_shared<fcl::Boxd>(size.x(), size.y(), size.z());
  pieces->front().geometry->computeLocalAABB();
  pieces->front().T_body_piece.translation() = middle;
  const Time begin = ego.begin();
  auto bounds = std::make_shared<std::vector<double>>(ego_accelerations(ego, radius_m, end));
  const auto acceleration = [bounds, begin](Time t0, Time t1) {
    const auto last = static_cast<std::ptrdiff_t>(bounds->size()) - 1;
    const auto at = [&](Time t) {
      return std::clamp(static_cast<std::ptrdiff_t>(core::to_s(t - begin) / interval_s), std::ptrdiff_t{0}, last);
    };
    double most = 0;
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, at(t0) - 1); k <= std::min(last, at(t1) + 1); ++k)
      most = std::max(most, (*bounds)[static_cast<std::size_t>(k)]);
    return most;
  };
  const Time last = std::min(end, ego.end());
  const auto pose = [&ego, last, upright = box.upright](Time t) {
    SE3 T_world_body = ego.pose(std::min(t, last));
    if (upright) T_world_body.linear().setIdentity();
    return T_world_body;
  };
  return {"the ego vehicle", nullptr,
          radius_m,          pose,
          acceleration,      [pieces]() -> const std::vector<Piece>& { return *pieces; }};
}

Reach reach_of(const Body& body, const Interval& when) {
  const Time middle = when.begin + (when.end - when.begin) / 2;
  const Vector3d p0 = body.pose(when.begin).translation(), p = body.pose(middle).translation(),
                 p1 = body.pose(when.end).translation();
  const double h = 0.5 * core::to_s(when.end - when.begin);
  const double bow = body.acceleration_m_s2(when.begin, when.end) * h * h / 8;
  return {p, body.radius_m + std::max((p0 - p).norm(), (p1 - p).norm()) + bow};
}

struct Speed {
  Vector3d of_origin_m_s;
  double beside_m_s;  ///< by how much that of another of its points may differ, at most
};

Speed speed_of(const Body& body, Time t) {
  const Time later = t + core::duration_from_s(difference_s);
  const SE3 T0 = body.pose(t), T1 = body.pose(later);
  const double turn = core::so3::angle_rad(T0.linear().transpose() * T1.linear());
  return {(T1.translation() - T0.translation()) / difference_s,
          turn * body.radius_m / difference_s + body.acceleration_m_s2(t, later) * difference_s};
}

bool stands(const Body& body, Time t) {
  const Speed speed = speed_of(body, t);
  return speed.of_origin_m_s.norm() + speed.beside_m_s == 0;
}

/// How fast any point of one comes towards any point of the other at t, at most: side by side they may be fast.
double approach_m_s(const Body& a, const Body& b, Time t) {
  const Speed of_a = speed_of(a, t), of_b = speed_of(b, t);
  return (of_a.of_origin_m_s - of_b.of_origin_m_s).norm() + of_a.beside_m_s + of_b.beside_m_s;
}

/// All that a body passes in an interval lies in a box: that of its triangles in the middle of it, longer by its way,
/// wider by what turning and acceleration (bounds over all its points) can make of it.
struct Passage {
  fcl::Boxd box;
  fcl::Transform3d T_world_box;
};

Eigen::AlignedBox3d bounds_of(const Body& body) {
  Eigen::AlignedBox3d bounds;
  for (const Piece& piece : body.pieces()) {
    const fcl::AABBd& local = piece.geometry->aabb_local;
    for (int corner = 0; corner < 8; ++corner)
      bounds.extend(piece.T_body_piece * Vector3d((corner & 1 ? local.max_ : local.min_).x(),
                                                  (corner & 2 ? local.max_ : local.min_).y(),
                                                  (corner & 4 ? local.max_ : local.min_).z()));
  }
  return bounds;
}

Passage passage_of(const Body& body, const Interval& when, double lift) {
  const Time middle = when.begin + (when.end - when.begin) / 2;
  const double h = 0.5 * core::to_s(when.end - when.begin) + 1e-6;
  const Speed speed = speed_of(body, middle);
  const double aside = speed.beside_m_s * h + body.acceleration_m_s2(when.begin, when.end) * h * h / 2 + touch_m;
  SE3 T_world_box = body.pose(middle);
  const Eigen::AlignedBox3d bounds = bounds_of(body);
  const Vector3d way = (T_world_box.linear().transpose() * speed.of_origin_m_s).cwiseAbs() * h;
  const Vector3d size = bounds.sizes() + 2 * (way + Vector3d::Constant(aside));
  T_world_box.translation() = T_world_box * bounds.center() + Vector3d(0, 0, lift);
  return {fcl::Boxd(size.x(), size.y(), size.z()), fcl::Transform3d(T_world_box)};
}

bool meet(const Passage& a, const fcl::CollisionGeometryd& b, const fcl::Transform3d& T_world_b) {
  fcl::CollisionResultd result;
  return fcl::collide(&a.box, a.T_world_box, &b, T_world_b, fcl::CollisionRequestd(), result) > 0;
}

struct Nearest {
  double distance_m = std::numeric_limits<double>::infinity();  ///< 0 or less: they meet
  std::size_t of_second = 0;                                    ///< triangle of the second body
};

/// Two bodies, the first of them lifted.
Nearest nearest(const Body& a, const Body& b, Time t, double lift_a_m) {
  Nearest least;
  SE3 T_a = a.pose(t);
  T_a.translation().z() += lift_a_m;
  const SE3 T_b = b.pose(t);
  for (const Piece& piece_a : a.pieces()) {
    for (const Piece& piece_b : b.pieces()) {
      fcl::DistanceRequestd request;
      request.enable_nearest_points = false;
      fcl::DistanceResultd result;
      // Not by fcl::CollisionObject: each would go through all vertices for its box.
      fcl::distance(piece_a.geometry.get(), fcl::Transform3d(T_a * piece_a.T_body_piece), piece_b.geometry.get(),
                    fcl::Transform3d(T_b * piece_b.T_body_piece), request, result);
      if (result.min_distance < least.distance_m)
        least = {result.min_distance, static_cast<std::size_t>(std::max<std::intptr_t>(0, result.b2))};
    }
  }
  return least;
}

bool holds(const Piece& solid, const Vector3d& p) {
  if (solid.mesh) return scenes::is_inside(*solid.mesh, p);
  const auto& box = dynamic_cast<const fcl::Boxd&>(*solid.geometry);
  return (p.cwiseAbs().array() < 0.5 * box.side.array()).all();
}

/// A point of the piece, in its own frame.
Vector3d point_of(const Piece& piece) {
  if (!piece.mesh) return Vector3d::Zero();
  return piece.mesh->vertices[piece.mesh->triangles[0][0]].cast<double>();
}

/// Surfaces of a and b that do not meet: a piece of one is then either wholly inside one of the other's, or outside.
bool is_inside(const Body& a, const Body& b, Time t) {
  for (const Piece& piece_a : a.pieces())
    for (const Piece& piece_b : b.pieces()) {
      const Vector3d p_world = a.pose(t) * piece_a.T_body_piece * point_of(piece_a);
      if (holds(piece_b, (b.pose(t) * piece_b.T_body_piece).inverse() * p_world)) return true;
    }
  return false;
}

/// From `when.begin` on, always as far as nothing can happen. Returns the time at which the bodies meet.
std::optional<Time> meeting(const Body& a, const Body& b, const Interval& when, double lift_a_m) {
  Time t = when.begin;
  while (t < when.end) {
    const double between_m =
        (a.pose(t).translation() - b.pose(t).translation()).norm() - a.radius_m - b.radius_m - lift_a_m;
    double free_m = between_m;
    if (free_m < 1) {
      free_m = nearest(a, b, t, lift_a_m).distance_m;
      if (free_m < touch_m) return t;
    }
    const double left_s = core::to_s(when.end - t);
    const double v = approach_m_s(a, b, t);
    const double acceleration = a.acceleration_m_s2(t, when.end) + b.acceleration_m_s2(t, when.end);
    double step_s = left_s;
    if (v * left_s + 0.5 * acceleration * left_s * left_s > free_m)
      step_s = 2 * free_m / (v + std::sqrt(v * v + 2 * acceleration * free_m));
    t += std::max(core::Duration(1000), core::duration_from_s(step_s));
  }
  return std::nullopt;
}

[[noreturn]] void refuse(const Body& a, const std::string& what, Time t, const std::string& scenario_name) {
  const std::string where = a.actor->where.empty() ? scenario_name : a.actor->where;
  const Vector3d p = a.pose(t).translation();
  throw core::InputError(
      fmt::format("{}: actor {} runs into {} at {:.2f} s, near x {:.1f} m, y {:.1f} m: move its path or its timetable",
                  where, a.name, what, core::to_s(t), p.x(), p.y()));
}

bool belong_together(const Body& a, const Body& b) {
  return a.actor != nullptr && b.actor != nullptr && a.actor->group >= 0 && a.actor->group == b.actor->group;
}

/// Bodies against each other, interval by interval: only those that come near are looked at closely.
void check_each_other(const std::vector<Body>& bodies, Time end, const std::string& scenario_name) {
  const auto count = static_cast<std::int64_t>(std::ceil(core::to_s(end) / interval_s));
  for (std::int64_t k = 0; k < count; ++k) {
    const Interval when{core::time_from_s(interval_s * static_cast<double>(k)),
                        std::min(end, core::time_from_s(interval_s * static_cast<double>(k + 1)))};
    std::vector<Reach> reach;
    for (const Body& body : bodies) reach.push_back(reach_of(body, when));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if ((reach[i].centre_m - reach[j].centre_m).norm() > reach[i].radius_m + reach[j].radius_m + touch_m) continue;
        if (belong_together(bodies[i], bodies[j])) continue;
        std::optional<Time> t;
        if (k == 0 && (is_inside(bodies[i], bodies[j], when.begin) || is_inside(bodies[j], bodies[i], when.begin)))
          t = when.begin;
        const Passage of_i = passage_of(bodies[i], when, 0), of_j = passage_of(bodies[j], when, 0);
        if (!t && meet(of_i, of_j.box, of_j.T_world_box)) t = meeting(bodies[i], bodies[j], when, 0);
        if (t) {
          const bool ego = bodies[j].actor == nullptr;
          refuse(bodies[i], ego ? bodies[j].name : "actor " + bodies[j].name, *t, scenario_name);
        }
      }
    }
  }
}

bool is_free(scenes::Label label) {
  using enum scenes::Label;
  return label == pavement || label == marking || label == vegetation || label == terrain;
}

/// Cells of the plane where an actor may be at some time.
class Swept {
 public:
  void add(const Vector3d& p, double radius_m) {
    for (long i = cell(p.x() - radius_m); i <= cell(p.x() + radius_m); ++i)
      for (long j = cell(p.y() - radius_m); j <= cell(p.y() + radius_m); ++j) cells_.insert({i, j});
  }
  bool meets(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const {
    for (long i = cell(low.x()); i <= cell(high.x()); ++i)
      for (long j = cell(low.y()); j <= cell(high.y()); ++j)
        if (cells_.contains({i, j})) return true;
    return false;
  }

 private:
  static long cell(double x_m) { return static_cast<long>(std::floor(x_m / 4)); }
  std::set<std::pair<long, long>> cells_;
};

/// The static triangles that actors come near to, in the world; no geometry when there are none.
struct Scenery {
  Geometry geometry;
  std::vector<std::uint32_t> mesh;  ///< that each triangle is of
};

Scenery scenery_near(const scenes::Scene& scene, const Swept& swept) {
  Scenery scenery;
  std::vector<Vector3d> vertices;
  std::vector<fcl::Triangle> triangles;
  for (const scenes::Instance& instance : scene.instances) {
    if (instance.actor >= 0 || is_free(instance.label)) continue;
    const scenes::Mesh& mesh = scene.meshes[instance.mesh];
    std::vector<Vector3d> world;
    for (const Eigen::Vector3f& v : mesh.vertices) world.push_back(instance.T_parent_mesh * v.cast<double>());
    for (const auto& corners : mesh.triangles) {
      const Eigen::Vector2d a = world[corners[0]].head<2>(), b = world[corners[1]].head<2>(),
                            c = world[corners[2]].head<2>();
      if (!swept.meets(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c))) continue;
      const std::size_t first = vertices.size();
      for (const std::uint32_t v : corners) vertices.push_back(world[v]);
      triangles.emplace_back(first, first + 1, first + 2);
      scenery.mesh.push_back(instance.mesh);
    }
  }
  if (!triangles.empty()) scenery.geometry = Shapes::of_triangles(vertices, triangles);
  return scenery;
}

/// The solid that an actor begins in; null: none. `bounds` are those of the scene's meshes.
const scenes::Mesh* standing_around(const scenes::Scene& scene, const std::vector<Eigen::AlignedBox3f>& bounds,
                                    const Body& actor, Time t) {
  for (const Piece& piece : actor.pieces()) {
    const Vector3d p_world = actor.pose(t) * piece.T_body_piece * point_of(piece) + Vector3d(0, 0, lift_m);
    for (const scenes::Instance& instance : scene.instances) {
      if (instance.actor >= 0 || is_free(instance.label)) continue;
      const scenes::Mesh& mesh = scene.meshes[instance.mesh];
      const Vector3d p = instance.T_parent_mesh.inverse() * p_world;
      if (bounds[instance.mesh].contains(p.cast<float>()) && scenes::is_inside(mesh, p)) return &mesh;
    }
  }
  return nullptr;
}

void check_against_what_stands(const scenes::Scene& scene, const std::vector<Body>& actors, Time end,
                               const std::string& scenario_name) {
  Swept swept;
  const auto count = static_cast<std::int64_t>(std::ceil(core::to_s(end) / interval_s));
  const auto interval = [&](std::int64_t k) {
    return Interval{core::time_from_s(interval_s * static_cast<double>(k)),
                    std::min(end, core::time_from_s(interval_s * static_cast<double>(k + 1)))};
  };
  for (const Body& actor : actors)
    for (std::int64_t k = 0; k < count; ++k) {
      const Reach reach = reach_of(actor, interval(k));
      swept.add(reach.centre_m, reach.radius_m);
    }
  const Scenery scenery = scenery_near(scene, swept);
  if (!scenery.geometry) return;
  const std::vector<Piece> pieces{Piece{.geometry = scenery.geometry}};
  std::vector<Eigen::AlignedBox3f> bounds;
  for (const scenes::Mesh& mesh : scene.meshes) bounds.push_back(scenes::bounds_of(mesh));
  const auto stays = [](Time) { return SE3(SE3::Identity()); };
  // Its radius holds everything: how near an actor is, only the triangles tell.
  const Body standing{"what stands there",
                      nullptr,
                      1e9,
                      stays,
                      [](Time, Time) { return 0.0; },
                      [&]() -> const std::vector<Piece>& { return pieces; }};
  for (const Body& actor : actors) {
    if (const scenes::Mesh* around = standing_around(scene, bounds, actor, Time{}))
      refuse(actor, "what stands there (" + around->name + ")", Time{}, scenario_name);
    for (std::int64_t k = 0; k < count; ++k) {
      const Interval when = interval(k);
      const bool rests = k > 0 && actor.acceleration_m_s2(when.begin, when.end) == 0 && stands(actor, when.begin);
      if (rests || !meet(passage_of(actor, when, lift_m), *scenery.geometry, fcl::Transform3d::Identity())) continue;
      if (const auto t = meeting(actor, standing, when, lift_m)) {
        const std::size_t triangle = nearest(actor, standing, *t, lift_m).of_second;
        refuse(actor, "what stands there (" + scene.meshes[scenery.mesh.at(triangle)].name + ")", *t, scenario_name);
      }
    }
  }
}

}  // namespace

void check_collisions(const scenes::Scene& scene, const core::SmoothTrajectory& ego, const truth::BodyBox& box,
                      Time end, const std::string& scenario_name) {
  if (scene.actors.empty()) return;
  end = std::min(end, ego.end());
  const auto shapes = std::make_shared<Shapes>(scene);
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < scene.actors.size(); ++i) bodies.push_back(actor_body(scene, i, shapes));
  check_against_what_stands(scene, bodies, end, scenario_name);
  bodies.insert(bodies.begin(), ego_body(ego, box, end));
  check_each_other(bodies, end, scenario_name);
}

}  // namespace tarmac::sim
