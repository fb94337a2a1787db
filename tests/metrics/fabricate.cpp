#include "tests/metrics/fabricate.h"

namespace tarmac::metrics::tests {

using namespace core;

namespace {

/// value, first and second derivative of a sum of sinusoids.
struct Wave {
  double x = 0, dx = 0, ddx = 0;
  Wave& add(double amplitude, double rad_s, double phase, double t) {
    x += amplitude * std::sin(rad_s * t + phase);
    dx += amplitude * rad_s * std::cos(rad_s * t + phase);
    ddx -= amplitude * rad_s * rad_s * std::sin(rad_s * t + phase);
    return *this;
  }
};

}  // namespace

Kinematics ConstantTwist::at(Time t) const {
  Kinematics k;
  const Eigen::Vector3d velocity = xi_.head<3>(), rate = xi_.tail<3>();
  k.T_world_body = T0_ * se3::exp(xi_ * to_s(t));
  const Eigen::Matrix3d R = k.T_world_body.linear();
  k.v_world = R * velocity;
  k.a_world = R * rate.cross(velocity);
  k.omega_body = rate;
  return k;
}

Kinematics Wobbly::at(Time time) const {
  const double t = to_s(time);
  const Wave px = Wave{}.add(30, 0.31, 0.2, t).add(0.02, 41, 0, t),
             py = Wave{}.add(22, 0.23, 1.0, t).add(0.3, 2.9, 0, t),
             pz = Wave{}.add(0.4, 0.7, 0.4, t).add(0.001, 90, 0.3, t);
  const Wave yaw = Wave{}.add(1.1, 0.5, 0.3, t).add(0.05, 3.1, 0, t), pitch = Wave{}.add(0.04, 2.2, 1.5, t),
             roll = Wave{}.add(0.05, 1.7, 0.9, t).add(0.002, 30, 0, t);
  Kinematics k;
  k.T_world_body.linear() =
      (Eigen::AngleAxisd(yaw.x, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch.x, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll.x, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  k.T_world_body.translation() = Eigen::Vector3d(px.x, py.x, pz.x);
  k.v_world = Eigen::Vector3d(px.dx, py.dx, pz.dx);
  k.a_world = Eigen::Vector3d(px.ddx, py.ddx, pz.ddx);
  const double sp = std::sin(pitch.x), cp = std::cos(pitch.x), sr = std::sin(roll.x), cr = std::cos(roll.x);
  k.omega_body = {roll.dx - yaw.dx * sp, pitch.dx * cr + yaw.dx * cp * sr, -pitch.dx * sr + yaw.dx * cp * cr};
  k.alpha_body = {roll.ddx - yaw.ddx * sp - yaw.dx * pitch.dx * cp,
                  pitch.ddx * cr - pitch.dx * roll.dx * sr + yaw.ddx * cp * sr - yaw.dx * pitch.dx * sp * sr +
                      yaw.dx * roll.dx * cp * cr,
                  -pitch.ddx * sr - pitch.dx * roll.dx * cr + yaw.ddx * cp * cr - yaw.dx * pitch.dx * sp * cr -
                      yaw.dx * roll.dx * cp * sr};
  return k;
}

SE3 pose(const Eigen::Vector3d& xyz_m, const Eigen::Vector3d& rotation_vector) {
  SE3 T = SE3::Identity();
  T.linear() = so3::exp(rotation_vector);
  T.translation() = xyz_m;
  return T;
}

SE3 lidar_mount() {
  return pose({0.3, -0.1, 1.8}, {0.02, 0.05, 0.7});
}

SweepSource Drive::source() const {
  return {sweeps.size(), [this](std::size_t i) { return sweeps[i]; }, nominal, 0};
}

Evaluation Drive::evaluate(const Estimate& estimate, const EvaluateSettings& settings) const {
  return metrics::evaluate({estimate, source(), &truth, &labels}, settings);
}

Drive make_drive(std::shared_ptr<const SmoothTrajectory> motion, const DriveShape& shape,
                 const std::function<std::vector<Target>(int sweep)>& targets) {
  Drive drive;
  drive.shape = shape;
  drive.nominal.lidars.emplace_back().T_body_lidar = lidar_mount();
  drive.truth.motion = motion;
  drive.truth.rig = drive.nominal;
  drive.truth.scenario = "fabricated";
  drive.truth.seed = 7;
  for (int k = 0; k < shape.sweeps; ++k) {
    LidarSweep sweep;
    sim::truth::PointLabels labels;
    sweep.index = k;
    labels.begin = sweep.begin = shape.begin(k);
    labels.end = sweep.end = shape.end(k);
    const std::vector<Target> seen = targets(k);
    for (int c = 0; c < shape.columns; ++c) {
      const SE3 T_lidar_world = (motion->pose(shape.column(k, c)) * lidar_mount()).inverse();
      const auto t_ns = static_cast<std::int32_t>((c * shape.column_spacing).count());
      for (const Target& target : seen) {
        sweep.push_back((T_lidar_world * target.p_world).cast<float>(), t_ns, 0, 1);
        labels.t_ns.push_back(t_ns);
        labels.moving.push_back(target.moving);
        labels.label.push_back(target.moving ? scenes::Label::vehicle : scenes::Label::building);
        labels.instance.push_back(0);
      }
    }
    drive.sweeps.push_back(std::move(sweep));
    drive.labels.push_back(std::move(labels));
  }
  return drive;
}

std::vector<Target> box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_extent) {
  std::vector<Target> corners;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {-1, 1})
        corners.push_back({centre + half_extent.cwiseProduct(Eigen::Vector3d(x, y, z)), false});
  return corners;
}

Estimate in_other_map(const Estimate& estimate, const SE3& T_other_map) {
  Estimate other = estimate;
  other.causal = {};
  for (Segment segment : estimate.causal.segments()) {
    for (SE3& T : segment.poses) T = T_other_map * T;
    other.causal.append(segment);
  }
  for (SweepResult& sweep : other.sweeps) sweep.T_map_body = T_other_map * sweep.T_map_body;
  return other;
}

}  // namespace tarmac::metrics::tests
