#include "scenes/equipment/person.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace tarmac::scenes {

using Eigen::Vector3d;
using enum MaterialId;

namespace {

constexpr double pi = std::numbers::pi, deg = pi / 180;
// Thigh and shank are equally long: then bending the knee lifts the foot straight up, and the other foot alone decides
// how high the hips are.
constexpr double limb_m = 0.43, ankle_m = 0.08, hip_m = ankle_m + 2 * limb_m, hip_half_m = 0.09;
constexpr double shoulder_m = 0.50, shoulder_half_m = 0.20, upper_arm_m = 0.28, height_m = 1.75;
constexpr double hip_swing_rad = 24 * deg, knee_bend_rad = 60 * deg, arm_swing_rad = 22 * deg;

/// An oval at a height of the part's frame; the material holds up to the next one.
struct Oval {
  double z_m, half_x_m, half_y_m, x_m;
  MaterialId material;
};

void add_ovals(MeshBuilder& b, const std::vector<Oval>& ovals, int around = 20) {
  std::vector<Ring> rings;
  for (const Oval& o : ovals) {
    Ring ring;
    for (int j = 0; j < around; ++j) {
      const double a = 2 * pi * j / around;
      ring.emplace_back(o.x_m + o.half_x_m * std::cos(a), o.half_y_m * std::sin(a), o.z_m);
    }
    rings.push_back(std::move(ring));
  }
  add_loft(b, rings, [&](std::size_t i, std::size_t) { return ovals[i].material; });
}

Mesh torso() {
  MeshBuilder b("person_torso");
  add_ovals(b, {{-0.10, 0.06, 0.10, 0, gse_chassis},
                {-0.06, 0.11, 0.16, 0, gse_chassis},
                {0.05, 0.12, 0.17, 0, cone_orange},
                {0.14, 0.115, 0.165, 0, retro_sheeting_ra1},
                {0.19, 0.115, 0.165, 0, cone_orange},
                {0.30, 0.125, 0.175, 0, retro_sheeting_ra1},
                {0.35, 0.125, 0.18, 0, cone_orange},
                {0.46, 0.11, 0.19, 0, cone_orange},
                {0.53, 0.07, 0.13, 0, cone_orange},
                {0.545, 0.05, 0.06, 0, cone_orange}});
  const double top = height_m - hip_m;
  add_ovals(b,
            {{0.52, 0.05, 0.05, 0, interior_wall},
             {0.59, 0.05, 0.05, 0.005, interior_wall},
             {0.60, 0.075, 0.06, 0.02, interior_wall},
             {0.66, 0.095, 0.075, 0.015, interior_wall},
             {0.71, 0.10, 0.08, 0.01, gse_chassis},  // cap
             {top - 0.04, 0.09, 0.07, 0, gse_chassis},
             {top - 0.01, 0.05, 0.04, -0.005, gse_chassis},
             {top, 0.015, 0.012, -0.005, gse_chassis}},
            16);
  b.use(gse_chassis);  // ear defenders
  for (const double side : {-1.0, 1.0})
    add_frustum(b, {0, side * 0.065, 0.68}, {0, side * 0.105, 0.68}, 0.045, 0.04, 12);
  return std::move(b).build();
}

Mesh thigh() {
  MeshBuilder b("person_thigh");
  add_ovals(b,
            {{0.03, 0.05, 0.05, 0, gse_chassis},
             {-0.02, 0.085, 0.08, 0, gse_chassis},
             {-0.20, 0.075, 0.072, 0, gse_chassis},
             {-limb_m, 0.058, 0.058, 0, gse_chassis},
             {-limb_m - 0.03, 0.03, 0.03, 0, gse_chassis}},
            14);
  return std::move(b).build();
}

Mesh shank() {
  MeshBuilder b("person_shank");
  add_ovals(b,
            {{0.03, 0.03, 0.03, 0, gse_chassis},
             {0, 0.058, 0.058, 0, gse_chassis},
             {-0.12, 0.062, 0.06, -0.01, gse_chassis},
             {-0.26, 0.052, 0.05, -0.005, retro_sheeting_ra1},
             {-0.31, 0.05, 0.048, 0, gse_chassis},
             {-limb_m + 0.02, 0.045, 0.045, 0, gse_chassis},
             {-limb_m - 0.01, 0.03, 0.03, 0, gse_chassis}},
            14);
  return std::move(b).build();
}

Mesh foot() {
  MeshBuilder b("person_foot");
  b.use(tyre_rubber);
  const double z = -ankle_m;
  add_loft(b, {{{-0.07, -0.04, z}, {0.20, -0.045, z}, {0.20, 0.045, z}, {-0.07, 0.04, z}},
               {{-0.07, -0.04, z + 0.05}, {0.19, -0.04, z + 0.045}, {0.19, 0.04, z + 0.045}, {-0.07, 0.04, z + 0.05}},
               {{-0.05, -0.035, 0.03}, {0.06, -0.035, 0.02}, {0.06, 0.035, 0.02}, {-0.05, 0.035, 0.03}}});
  return std::move(b).build();
}

Mesh upper_arm() {
  MeshBuilder b("person_upper_arm");
  add_ovals(b,
            {{0.04, 0.03, 0.03, 0, cone_orange},
             {0.01, 0.055, 0.052, 0, cone_orange},
             {-0.16, 0.047, 0.045, 0, retro_sheeting_ra1},
             {-0.21, 0.045, 0.043, 0, cone_orange},
             {-upper_arm_m, 0.04, 0.04, 0, cone_orange},
             {-upper_arm_m - 0.025, 0.02, 0.02, 0, cone_orange}},
            12);
  return std::move(b).build();
}

/// With hand and wand: the wand continues the forearm.
Mesh forearm() {
  MeshBuilder b("person_forearm");
  add_ovals(b,
            {{0.025, 0.02, 0.02, 0, cone_orange},
             {0, 0.04, 0.04, 0, cone_orange},
             {-0.22, 0.032, 0.030, 0, cone_orange},
             {-0.24, 0.030, 0.028, 0, interior_wall},
             {-0.30, 0.045, 0.028, 0.005, interior_wall},
             {-0.34, 0.04, 0.025, 0.005, interior_wall},
             {-0.355, 0.02, 0.015, 0.005, interior_wall}},
            12);
  b.use(gse_chassis);
  add_frustum(b, {0.02, 0, -0.26}, {0.02, 0, -0.40}, 0.018, 0.018, 10);
  b.use(retro_sheeting_ra1);
  add_frustum(b, {0.02, 0, -0.40}, {0.02, 0, -0.68}, 0.022, 0.019, 10);
  return std::move(b).build();
}

enum Part : std::size_t {
  torso_part,
  left_thigh,
  right_thigh,
  left_shank,
  right_shank,
  left_foot,
  right_foot,
  left_upper_arm,
  right_upper_arm,
  left_forearm,
  right_forearm,
  part_count
};

core::SE3 joint(const Vector3d& at, const Eigen::AngleAxisd& turn) {
  core::SE3 T = core::SE3::Identity();
  T.linear() = turn.toRotationMatrix();
  T.translation() = at;
  return T;
}

/// Swings a hanging limb forward.
Eigen::AngleAxisd forward(double angle_rad) {
  return {-angle_rad, Vector3d::UnitY()};
}
Eigen::AngleAxisd about_x(double angle_rad) {
  return {angle_rad, Vector3d::UnitX()};
}

}  // namespace

const std::vector<PersonPart>& person_parts() {
  static const std::vector<PersonPart> parts = [] {
    const Vector3d knee(0, 0, -limb_m), elbow(0, 0, -upper_arm_m);
    const auto side = [](double sign, double half, double z) { return Vector3d(0, sign * half, z); };
    return std::vector<PersonPart>{
        {"torso", -1, {0, 0, hip_m}, torso()},
        {"left_thigh", torso_part, side(1, hip_half_m, 0), thigh()},
        {"right_thigh", torso_part, side(-1, hip_half_m, 0), thigh()},
        {"left_shank", left_thigh, knee, shank()},
        {"right_shank", right_thigh, knee, shank()},
        {"left_foot", left_shank, knee, foot()},
        {"right_foot", right_shank, knee, foot()},
        {"left_upper_arm", torso_part, side(1, shoulder_half_m, shoulder_m - 0.02), upper_arm()},
        {"right_upper_arm", torso_part, side(-1, shoulder_half_m, shoulder_m - 0.02), upper_arm()},
        {"left_forearm", left_upper_arm, elbow, forearm()},
        {"right_forearm", right_upper_arm, elbow, forearm()}};
  }();
  return parts;
}

double person_stride_m(double gait) {
  // Each step covers what the standing foot travels under the hips, from one end of its swing to the other.
  return 4 * 2 * limb_m * std::sin(gait * hip_swing_rad);
}

std::vector<core::SE3> person_pose(const PersonPosture& posture) {
  const std::vector<PersonPart>& parts = person_parts();
  std::vector<core::SE3> T(part_count, core::SE3::Identity());
  const double swing = posture.gait * hip_swing_rad * std::sin(posture.gait_phase_rad);
  T[torso_part] = joint({0, 0, ankle_m + 2 * limb_m * std::cos(swing)}, forward(0));
  for (const bool left : {true, false}) {
    const auto part = [left](Part left_one) { return static_cast<std::size_t>(left_one) + (left ? 0 : 1); };
    const double phase = posture.gait_phase_rad + (left ? 0 : pi), side = left ? 1 : -1;
    // The knee bends while the leg swings forward and is straight while it stands.
    const double bend = posture.gait * knee_bend_rad * std::pow(0.5 * (1 + std::cos(phase + 0.35)), 3);
    const double hip = side * swing + bend / 2;
    const auto chain = [&](Part child, std::size_t parent, const Eigen::AngleAxisd& turn) {
      T[part(child)] = T[parent] * joint(parts[part(child)].joint_m, turn);
    };
    chain(left_thigh, torso_part, forward(hip));
    chain(left_shank, part(left_thigh), forward(-bend));
    chain(left_foot, part(left_shank), forward(bend - hip));  // level
    const double arm = -side * posture.gait * arm_swing_rad * std::sin(posture.gait_phase_rad);
    const double raised = posture.arms_raised;
    chain(left_upper_arm, torso_part, forward((1 - raised) * arm));
    T[part(left_upper_arm)].rotate(about_x(side * (6 * deg + raised * 84 * deg)));
    chain(left_forearm, part(left_upper_arm), forward((1 - raised) * (12 * deg + 8 * deg * posture.gait)));
    T[part(left_forearm)].rotate(about_x(side * raised * (62 * deg + 26 * deg * std::sin(posture.wave_phase_rad))));
  }
  return T;
}

void add_person(MeshBuilder& b, const PersonPosture& posture) {
  const std::vector<PersonPart>& parts = person_parts();
  const std::vector<core::SE3> T = person_pose(posture);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    b.at(T[p]);
    const Mesh& mesh = parts[p].mesh;
    std::vector<std::uint32_t> index;
    for (const Eigen::Vector3f& v : mesh.vertices) index.push_back(b.vertex(v.cast<double>()));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh.triangles[t];
      b.use(static_cast<MaterialId>(mesh.materials[t])).triangle(index[i], index[j], index[k]);
    }
  }
  b.at(core::SE3::Identity());
}

Mesh make_person(const PersonPosture& posture) {
  MeshBuilder b("person");
  add_person(b, posture);
  return std::move(b).build();
}

}  // namespace tarmac::scenes
