#include "scenes/actors/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "core/error.h"

namespace tarmac::scenes {

const std::vector<ActorKind>& actor_kinds() {
  // Speeds: a fire tender, an aircraft before it takes off, a train of carts, a runner.
  static const std::vector<ActorKind> kinds{
      {"aircraft", "an aircraft that taxies", "a320", 30, 2.5},
      {"pushback", "an aircraft that a tractor pushes back, tail first", "a320", 3, 1},
      {"baggage-train", "a tractor with carts behind it", "baggage-cart", 9, 3},
      {"fuel-truck", "a refueller", "refueller", 15, 5},
      {"belt-loader", "a belt loader", "belt-loader", 9, 4},
      {"bus", "an apron bus", "apron-bus", 13, 4},
      {"follow-me", "a follow-me car", "follow-me-car", 25, 8},
      {"vehicle", "any equipment, on its own wheels", "baggage-tractor", 35, 8},
      {"marshaller", "a person on foot, with wands", nullptr, 4.2, 3},
      {"accelerating-plane", "a control: a plate that accelerates evenly, in closed form", nullptr, 0, 0},
      {"turning-box", "a control: a box that turns, in closed form", nullptr, 0, 0},
  };
  return kinds;
}

const ActorKind& actor_kind(const std::string& name) {
  for (const ActorKind& kind : actor_kinds())
    if (name == kind.name) return kind;
  throw core::InputError("there is no kind of actor '" + name + "'");
}

void WayPoint::visit(core::OptionVisitor& v) {
  v("x_m", x_m, "world position");
  v("y_m", y_m, "world position");
  v("at_s", at_s,
    "time at which it would be passed if speeds changed at once; changes of speed are centred on it (-1: not given). "
    "The first and the last one have one, or none has",
    {.at_least = -1});
}

namespace {

void visit_control(ActorOptions& o, core::OptionVisitor& v) {
  const bool box = o.kind == "turning-box";
  v("size_m", o.size_m, box ? "edges of the box; its middle is the actor's origin" : "thickness, width, height");
  v("position_m", o.position_m, "world position of the origin at t = 0");
  v("velocity_m_s", o.velocity_m_s, "velocity at t = 0");
  v("acceleration_m_s2", o.acceleration_m_s2, "constant acceleration");
  v("heading_deg", o.heading_deg, "heading at t = 0");
  if (!box) return;
  v("turn_deg_s", o.turn_deg_s, "rate of turn about the vertical at t = 0", {.at_least = -720, .at_most = 720});
  v("turn_deg_s2", o.turn_deg_s2, "its constant change", {.at_least = -720, .at_most = 720});
}

void visit_movement(ActorOptions& o, core::OptionVisitor& v) {
  v.group(
      "start", o.start,
      "where the path begins: the rear axle, an aircraft's main gear, a person. A pushed-back aircraft points along "
      "heading_deg and moves the other way");
  v.list("path", o.path, "pieces of the path, as in a drive; behind each other without a gap");
  v.list("way_points", o.way_points, "instead of start and path: places joined by straights and turns");
  v("corner_radius_m", o.corner_radius_m, "radius of the turns at way points where they are tightest", {.above = 0.3});
  v("rest_s", o.rest_s, "time before the first change of speed", {.at_least = 0});
  v.list("speed", o.speed, "changes of speed, as in a drive. None, and no times at way points: it stands still");
  v("stop_peak_m_s2", o.stop_peak_m_s2, "deceleration at its peak of the stop at the path's end",
    {.above = 0, .at_most = 12});
}

/// Options that are read, and that the others leave without effect.
void refuse_idle(const core::ConfigNode& node, const ActorOptions& o) {
  const ActorOptions usual;
  const auto idle = [](const core::ConfigNode& at, bool given, const char* name, const char* why) {
    if (given) at.fail_at(name, std::string("has no effect here: ") + why);
  };
  const bool places = !o.way_points.empty();
  const bool timed =
      std::any_of(o.way_points.begin(), o.way_points.end(), [](const WayPoint& p) { return p.at_s >= 0; });
  const core::ConfigNode start = node.child("start");
  for (const auto& [name, value] :
       {std::pair{"x_m", o.start.x_m}, std::pair{"y_m", o.start.y_m}, std::pair{"heading_deg", o.start.heading_deg}})
    idle(start, places && value != 0, name, "the path begins at the first way point, toward the second: take it away");
  idle(start, timed && o.start.speed_m_s > 0, "speed_m_s", "the way points have times: take it away");
  idle(node, !places && o.corner_radius_m != usual.corner_radius_m, "corner_radius_m",
       "there are no way points: take it away");
  idle(node, timed && o.rest_s > 0, "rest_s", "the way points have times: say with the first one when it leaves");
  idle(node, o.rest_s > 0 && o.start.speed_m_s > 0, "rest_s",
       "start.speed_m_s says that it moves from the begin: give one of them");
  const bool moves = timed || !o.speed.empty() || o.start.speed_m_s > 0;
  idle(node, !moves && o.rest_s > 0, "rest_s", "without speed it stands for good: give speed, or take it away");
  idle(node, !moves && o.stop_peak_m_s2 != usual.stop_peak_m_s2, "stop_peak_m_s2",
       "without speed it stands for good: give speed, or take it away");
  idle(node, o.arms_raised_from_s < 0 && o.beckon_hz != usual.beckon_hz, "beckon_hz",
       "the arms are never raised: give arms_raised_from_s and arms_raised_until_s");
}

}  // namespace

void ActorOptions::visit(core::OptionVisitor& v) {
  std::vector<std::string> names;
  for (const ActorKind& k : actor_kinds()) names.emplace_back(k.name);
  v.choice("kind", kind, names, "what moves");
  v("name", name, "in messages and pictures; empty: the kind and its number");
  if (kind == "accelerating-plane" || kind == "turning-box") return visit_control(*this, v);
  const bool has_type = kind == "aircraft" || kind == "pushback" || kind == "baggage-train" || kind == "vehicle";
  if (has_type)
    v("type", type,
      kind == "baggage-train" ? "equipment of the carts"
      : kind == "vehicle"     ? "equipment, of `tarmac list equipment`"
                              : "aircraft, of `tarmac list aircraft`; empty: the kind's usual one");
  if (kind == "pushback") {
    v("tractor", tractor, "equipment that pushes");
    v("towbar", towbar, "equipment between tractor and nose gear; none: the tractor lifts the nose gear");
  }
  if (kind == "baggage-train") v("carts", carts, "carts behind the tractor", {.at_least = 1, .at_most = 10});
  visit_movement(*this, v);
  if (kind == "marshaller") {
    v("arms_raised_from_s", arms_raised_from_s, "when the arms go up, taking 1.5 s (-1: never)", {.at_least = -1});
    v("arms_raised_until_s", arms_raised_until_s, "when they begin to sink again (-1: never)", {.at_least = -1});
    v("beckon_hz", beckon_hz, "how often the raised forearms beckon", {.at_least = 0, .at_most = 3});
  }
}

std::vector<ActorOptions> read_actor_options(const core::ConfigNode& node) {
  std::vector<ActorOptions> actors;
  std::set<std::string> names;
  for (const core::ConfigNode& item : node.items()) {
    if (!item.is_block()) item.fail("must be a block such as {kind: bus, start: {...}, path: [...], speed: [...]}");
    ActorOptions& actor = actors.emplace_back();
    item.read(actor);
    refuse_idle(item, actor);
    const ActorKind& kind = actor_kind(actor.kind);
    if (actor.name.empty()) actor.name = fmt::format("{}-{}", actor.kind, actors.size());
    if (!names.insert(actor.name).second) item.fail("there are two actors called '" + actor.name + "'");
    if (actor.type.empty() && kind.default_type != nullptr) actor.type = kind.default_type;
  }
  return actors;
}

}  // namespace tarmac::scenes
