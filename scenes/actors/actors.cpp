#include "scenes/actors/actors.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "scenes/actors/controls.h"
#include "scenes/actors/convoys.h"
#include "scenes/actors/options.h"
#include "scenes/actors/walker.h"
#include "scenes/aircraft/aircraft.h"
#include "scenes/equipment/equipment.h"
#include "scenes/equipment/person.h"

namespace tarmac::scenes {
namespace {

using Eigen::Vector3d;

constexpr double sideways_wheels_m_s2 = 4, sideways_aircraft_m_s2 = 2, sideways_feet_m_s2 = 6;
constexpr double vehicle_steer_rad = 0.8;
constexpr double nose_gear_steer_rad = 1.26;  // 72 degrees while taxiing
constexpr double pushback_steer_rad = 1.13;   // 65 degrees: the usual limit of towing
constexpr double hitch_limit_rad = 1.31;      // 75 degrees: carts touch

class FlatGround final : public Ground {
 public:
  double height_m(double, double, Eigen::Vector2d* gradient, Eigen::Vector3d* hessian) const override {
    if (gradient != nullptr) gradient->setZero();
    if (hessian != nullptr) hessian->setZero();
    return 0;
  }
};

/// A mesh that is in the scene, and how it stands.
struct Model {
  std::uint32_t mesh = 0;
  Label label = Label::other;
  Footing footing;
  double low_x_m = 0, high_x_m = 0;  ///< of the whole mesh
};

/// Adds actors to a scene; a mesh that several of them have is there once.
class Cast {
 public:
  explicit Cast(Scene& scene)
      : scene_(&scene), ground_(scene.ground ? scene.ground : std::make_shared<const FlatGround>()) {
    for (const Actor& actor : scene.actors) group_ = std::max(group_, actor.group);
  }

  const std::shared_ptr<const Ground>& ground() const { return ground_; }
  void begin_group(const core::ConfigNode& node) {
    ++group_;
    where_ = node.line() > 0 ? fmt::format("{}:{}", node.file(), node.line()) : node.file();
  }

  std::uint32_t mesh(const std::string& name, const std::function<Mesh()>& make) {
    const auto [entry, is_new] = meshes_.try_emplace(name, 0u);
    if (is_new) {
      scene_->meshes.push_back(make());
      entry->second = static_cast<std::uint32_t>(scene_->meshes.size() - 1);
    }
    return entry->second;
  }

  Model equipment(const core::ConfigNode& node, const char* option, const std::string& name) {
    try {
      const EquipmentEntry& entry = equipment_entry(name);
      Model model = with_extent(mesh("equipment/" + name, [&] { return make_equipment(name); }));
      model.label = entry.label;
      model.footing = footing_of(scene_->meshes[model.mesh]);
      return model;
    } catch (const core::InputError& error) {
      node.fail_at(option, error.what());
    }
  }

  Model aircraft(const core::ConfigNode& node, const std::string& name) {
    try {
      const AircraftType& type = aircraft_type(name);
      Model model = with_extent(mesh("aircraft/" + name, [&] { return make_aircraft(type); }));
      model.label = Label::aircraft;
      double main_x_m = 0;
      for (const LandingGear& gear : type.main_gear) {
        main_x_m += gear.x_m / static_cast<double>(type.main_gear.size());
        model.footing.half_track_m = std::max(model.footing.half_track_m, gear.half_track_m);
      }
      model.footing.rear_x_m = -main_x_m;
      model.footing.front_x_m = -type.nose_gear.x_m;
      return model;
    } catch (const core::InputError& error) {
      node.fail_at("type", error.what());
    }
  }

  /// `T_actor_mesh`: where the mesh is in the frame that moves.
  void add(const std::string& name, std::shared_ptr<const ActorMotion> motion, std::uint32_t mesh, Label label,
           const core::SE3& T_actor_mesh = core::SE3::Identity()) {
    const double radius_m = radius_about(scene_->meshes[mesh], T_actor_mesh.inverse().translation());
    const auto index = static_cast<std::int32_t>(scene_->actors.size());
    scene_->actors.push_back({name, std::move(motion), radius_m, where_, group_});
    scene_->instances.push_back({mesh, label, index, T_actor_mesh});
  }

  /// A body of a convoy: its frame lies at its rear axle.
  void add_body(const std::string& name, const Model& model, const std::shared_ptr<const Convoy>& convoy,
                std::size_t index) {
    add(name, std::make_shared<GroundMotion>(convoy, index, model.footing, ground_), model.mesh, model.label,
        place(-model.footing.rear_x_m, 0, 0));
  }

 private:
  Model with_extent(std::uint32_t mesh) const {
    Model model;
    model.mesh = mesh;
    for (const Eigen::Vector3f& p : scene_->meshes[mesh].vertices) {
      model.low_x_m = std::min(model.low_x_m, static_cast<double>(p.x()));
      model.high_x_m = std::max(model.high_x_m, static_cast<double>(p.x()));
    }
    return model;
  }

  Scene* scene_;
  std::shared_ptr<const Ground> ground_;
  std::map<std::string, std::uint32_t> meshes_;
  std::string where_;
  std::int32_t group_ = -1;
};

Course::Limits limits_of(const ActorOptions& o, double sideways_m_s2, double min_radius_m) {
  const ActorKind& kind = actor_kind(o.kind);
  return {kind.max_speed_m_s, kind.max_acceleration_m_s2, sideways_m_s2, min_radius_m};
}

Course::Limits wheels(const ActorOptions& o, const Footing& footing) {
  return limits_of(o, sideways_wheels_m_s2, footing.wheelbase_m() / std::tan(vehicle_steer_rad));
}

void add_vehicle(const core::ConfigNode& node, const ActorOptions& o, Cast& cast) {
  const Model model = cast.equipment(node, "type", o.type);
  const auto convoy = std::make_shared<SingleVehicle>(make_course(node, o, wheels(o, model.footing)));
  cast.add_body(o.name, model, convoy, 0);
}

void add_aircraft(const core::ConfigNode& node, const ActorOptions& o, Cast& cast) {
  const Model model = cast.aircraft(node, o.type);
  const double min_radius_m = model.footing.wheelbase_m() / std::tan(nose_gear_steer_rad);
  const auto convoy =
      std::make_shared<SingleVehicle>(make_course(node, o, limits_of(o, sideways_aircraft_m_s2, min_radius_m)));
  cast.add_body(o.name, model, convoy, 0);
}

void add_train(const core::ConfigNode& node, const ActorOptions& o, Cast& cast) {
  const Model tractor = cast.equipment(node, "type", "baggage-tractor"), cart = cast.equipment(node, "type", o.type);
  std::vector<TrailerChain::Link> links;
  for (int k = 0; k < o.carts; ++k) {
    const Model& before = k == 0 ? tractor : cart;
    links.push_back({before.footing.rear_x_m - before.low_x_m, cart.high_x_m - cart.footing.rear_x_m});
  }
  const auto train = std::make_shared<Train>(make_course(node, o, wheels(o, tractor.footing)), links);
  if (const TrailerChain::Bend bend = train->chain().sharpest_bend(); bend.angle_rad > hitch_limit_rad)
    node.fail(
        fmt::format("{}: cart {} would turn {:.0f} degrees against what draws it after {:.1f} m; at most {:.0f} "
                    "are possible: turn more widely",
                    o.name, bend.link + 1, bend.angle_rad * 180 / std::numbers::pi, bend.s_m,
                    hitch_limit_rad * 180 / std::numbers::pi));
  cast.add_body(o.name, tractor, train, 0);
  for (int k = 0; k < o.carts; ++k)
    cast.add_body(fmt::format("{}/cart-{}", o.name, k + 1), cart, train, static_cast<std::size_t>(k) + 1);
}

void check_pushback(const core::ConfigNode& node, const ActorOptions& o, const Pushback& pushback) {
  const auto refuse = [&](const char* what, const TrailerChain::Bend& bend, double limit_rad) {
    if (bend.angle_rad <= limit_rad) return;
    node.fail(fmt::format(
        "{}: {} would turn by {:.0f} degrees after {:.1f} m; at most {:.0f} are possible: turn more "
        "widely",
        o.name, what, bend.angle_rad * 180 / std::numbers::pi, bend.s_m, limit_rad * 180 / std::numbers::pi));
  };
  refuse("the nose gear", pushback.sharpest_steer(), pushback_steer_rad);
  refuse("the tractor against the towbar", pushback.chain().sharpest_bend(), hitch_limit_rad);
}

void add_pushback(const core::ConfigNode& node, ActorOptions o, Cast& cast) {
  const Model aircraft = cast.aircraft(node, o.type), tractor = cast.equipment(node, "tractor", o.tractor);
  const bool has_towbar = o.towbar != "none";
  const Model towbar = has_towbar ? cast.equipment(node, "towbar", o.towbar) : Model{};
  const double towbar_m = towbar.high_x_m - towbar.low_x_m;
  // With a towbar the tractor pushes with its front; without one its rear holds the nose gear, and its front axle is
  // the one that does not slip.
  const double tractor_m =
      has_towbar ? tractor.high_x_m - tractor.footing.rear_x_m : tractor.footing.front_x_m - tractor.low_x_m;
  o.start.heading_deg += 180;  // of the motion, tail first
  const auto pushback = std::make_shared<Pushback>(make_course(node, o, limits_of(o, sideways_aircraft_m_s2, 0)),
                                                   aircraft.footing.wheelbase_m(), towbar_m, tractor_m);
  check_pushback(node, o, *pushback);
  cast.add_body(o.name, aircraft, pushback, Pushback::aircraft);
  if (has_towbar) {
    Model bar = towbar;  // its frame lies at its far end
    bar.footing = {towbar.low_x_m, towbar.high_x_m, 0.2};
    cast.add_body(o.name + "/towbar", bar, pushback, Pushback::towbar);
    cast.add_body(o.name + "/tractor", tractor, pushback, Pushback::tractor);
    return;
  }
  // The body's heading points from the axle to the nose gear: backwards for this tractor.
  const Footing reversed{-tractor.footing.front_x_m, -tractor.footing.rear_x_m, tractor.footing.half_track_m};
  core::SE3 T_actor_mesh = place(0, 0, 0, std::numbers::pi);
  T_actor_mesh.translation().x() = tractor.footing.front_x_m;
  cast.add(o.name + "/tractor", std::make_shared<GroundMotion>(pushback, Pushback::tractor, reversed, cast.ground()),
           tractor.mesh, tractor.label, T_actor_mesh);
}

void add_marshaller(const core::ConfigNode& node, const ActorOptions& o, Cast& cast) {
  if ((o.arms_raised_from_s >= 0) != (o.arms_raised_until_s >= 0) || o.arms_raised_until_s < o.arms_raised_from_s)
    node.fail(fmt::format("{}: arms_raised_from_s and arms_raised_until_s go together, the second not before the first",
                          o.name));
  const auto walker = std::make_shared<const Walker>(
      make_course(node, o, limits_of(o, sideways_feet_m_s2, 0.2)),
      Walker::Gesture{o.arms_raised_from_s, o.arms_raised_until_s, o.beckon_hz}, cast.ground());
  const std::vector<PersonPart>& parts = person_parts();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::uint32_t mesh = cast.mesh("person/" + parts[k].name, [&] { return parts[k].mesh; });
    cast.add(o.name + "/" + parts[k].name, std::make_shared<WalkerPart>(walker, k), mesh, Label::person);
  }
}

void add_control(const ActorOptions& o, Cast& cast) {
  const bool box = o.kind == "turning-box";
  constexpr double rad = std::numbers::pi / 180;
  const Vector3d half = 0.5 * o.size_m;
  const Vector3d low = box ? Vector3d(-half) : Vector3d(-o.size_m.x(), -half.y(), -half.z());
  const Vector3d high = box ? half : Vector3d(0, half.y(), half.z());
  const std::uint32_t mesh = cast.mesh(o.kind + "/" + o.name, [&] {
    MeshBuilder b(o.name);
    b.use(MaterialId::concrete_wall);
    add_box(b, low, high);
    return std::move(b).build();
  });
  cast.add(o.name,
           std::make_shared<UniformlyAccelerated>(
               UniformlyAccelerated::Parameters{o.position_m, o.velocity_m_s, o.acceleration_m_s2, o.heading_deg * rad,
                                                o.turn_deg_s * rad, o.turn_deg_s2 * rad}),
           mesh, Label::other);
}

void add_actor(const core::ConfigNode& node, const ActorOptions& o, Cast& cast) {
  if (o.kind == "aircraft") return add_aircraft(node, o, cast);
  if (o.kind == "pushback") return add_pushback(node, o, cast);
  if (o.kind == "baggage-train") return add_train(node, o, cast);
  if (o.kind == "marshaller") return add_marshaller(node, o, cast);
  if (o.kind == "accelerating-plane" || o.kind == "turning-box") {
    if (o.size_m.minCoeff() <= 0) node.fail_at("size_m", "all three must be above 0");
    return add_control(o, cast);
  }
  add_vehicle(node, o, cast);
}

/// A list of actors as options.
struct ActorList {
  std::vector<ActorOptions> actors;
  void visit(core::OptionVisitor& v) { v.list("actors", actors, "what moves"); }
};

}  // namespace

void add_actors(const core::ConfigNode& scene_node, Scene& scene) {
  const core::ConfigNode list = scene_node.child("actors");
  if (!list.present()) return;
  const std::vector<ActorOptions> options = read_actor_options(list);
  const std::vector<core::ConfigNode> items = list.items();
  Cast cast(scene);
  for (std::size_t i = 0; i < items.size(); ++i) {
    cast.begin_group(items[i]);
    add_actor(items[i], options[i], cast);
  }
}

std::string resolve_actors(const core::ConfigNode& scene_node) {
  const core::ConfigNode list = scene_node.child("actors");
  return list.present() ? core::write_options(ActorList{read_actor_options(list)}, 2) : std::string();
}

std::vector<ActorKindSummary> actor_summaries() {
  std::vector<ActorKindSummary> summaries;
  for (const ActorKind& kind : actor_kinds()) summaries.push_back({kind.name, kind.summary});
  return summaries;
}

std::vector<core::OptionDescription> describe_actor(const std::string& kind) {
  ActorOptions options;
  options.kind = actor_kind(kind).name;
  if (actor_kind(kind).default_type != nullptr) options.type = actor_kind(kind).default_type;
  return core::describe_options(options);
}

}  // namespace tarmac::scenes
