#include "core/rig.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"

namespace tarmac::core {
namespace {

using Json = nlohmann::ordered_json;

Json pose_json(const SE3& T) {
  const Eigen::Vector3d p = T.translation();
  const Eigen::Vector4d q = se3::quat_xyzw(T);
  return {{"xyz_m", {p.x(), p.y(), p.z()}}, {"quat_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

SE3 pose_of(const Json& json) {
  const auto p = json.at("xyz_m").get<std::array<double, 3>>();
  const auto q = json.at("quat_xyzw").get<std::array<double, 4>>();
  return se3::from_xyz_quat({p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]});
}

Json lidar_json(const LidarSheet& s) {
  return {{"model", s.model},
          {"T_body_lidar", pose_json(s.T_body_lidar)},
          {"sweep_rate_hz", s.sweep_rate_hz},
          {"min_range_m", s.min_range_m},
          {"max_range_m", s.max_range_m},
          {"clock_offset_ns", s.clock_offset.count()},
          {"stamp_convention", s.stamp_convention}};
}

LidarSheet lidar_of(const Json& j) {
  LidarSheet s;
  s.model = j.at("model").get<std::string>();
  s.T_body_lidar = pose_of(j.at("T_body_lidar"));
  s.sweep_rate_hz = j.at("sweep_rate_hz").get<double>();
  s.min_range_m = j.at("min_range_m").get<double>();
  s.max_range_m = j.at("max_range_m").get<double>();
  s.clock_offset = Duration(j.at("clock_offset_ns").get<std::int64_t>());
  s.stamp_convention = j.at("stamp_convention").get<std::string>();
  return s;
}

Json imu_json(const ImuSheet& s) {
  return {{"model", s.model},
          {"T_body_imu", pose_json(s.T_body_imu)},
          {"rate_hz", s.rate_hz},
          {"delay_ns", s.delay.count()},
          {"gyro_noise_density_rad_s_rthz", s.gyro_noise_density_rad_s_rthz},
          {"gyro_random_walk_rad_s2_rthz", s.gyro_random_walk_rad_s2_rthz},
          {"gyro_range_rad_s", s.gyro_range_rad_s},
          {"accel_noise_density_m_s2_rthz", s.accel_noise_density_m_s2_rthz},
          {"accel_random_walk_m_s3_rthz", s.accel_random_walk_m_s3_rthz},
          {"accel_range_m_s2", s.accel_range_m_s2}};
}

ImuSheet imu_of(const Json& j) {
  ImuSheet s;
  s.model = j.at("model").get<std::string>();
  s.T_body_imu = pose_of(j.at("T_body_imu"));
  s.rate_hz = j.at("rate_hz").get<double>();
  s.delay = Duration(j.at("delay_ns").get<std::int64_t>());
  s.gyro_noise_density_rad_s_rthz = j.at("gyro_noise_density_rad_s_rthz").get<double>();
  s.gyro_random_walk_rad_s2_rthz = j.at("gyro_random_walk_rad_s2_rthz").get<double>();
  s.gyro_range_rad_s = j.at("gyro_range_rad_s").get<double>();
  s.accel_noise_density_m_s2_rthz = j.at("accel_noise_density_m_s2_rthz").get<double>();
  s.accel_random_walk_m_s3_rthz = j.at("accel_random_walk_m_s3_rthz").get<double>();
  s.accel_range_m_s2 = j.at("accel_range_m_s2").get<double>();
  return s;
}

}  // namespace

std::string rig_to_json(const Rig& rig) {
  Json json = {{"calibrated", rig.calibrated},
               {"gravity_m_s2", rig.gravity_m_s2},
               {"lidars", Json::array()},
               {"imus", Json::array()}};
  for (const LidarSheet& sheet : rig.lidars) json["lidars"].push_back(lidar_json(sheet));
  for (const ImuSheet& sheet : rig.imus) json["imus"].push_back(imu_json(sheet));
  return json.dump(2);
}

Rig rig_from_json(const std::string& text, const std::string& where) {
  try {
    const Json json = Json::parse(text);
    Rig rig;
    rig.calibrated = json.at("calibrated").get<bool>();
    rig.gravity_m_s2 = json.at("gravity_m_s2").get<double>();
    for (const Json& entry : json.at("lidars")) rig.lidars.push_back(lidar_of(entry));
    for (const Json& entry : json.at("imus")) rig.imus.push_back(imu_of(entry));
    return rig;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: the rig data sheet cannot be read: {}", where, error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: the rig data sheet cannot be read: {}", where, error.what()));
  }
}

}  // namespace tarmac::core
