#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "core/error.h"
#include "core/files.h"
#include "io/sensor/text_lines.h"
#include "io/sensor/tum.h"

namespace tarmac::io {
namespace {

using core::SE3;
using core::Time;

/// Quaternions in text have few digits; what is further off than this is another column order or no quaternion.
constexpr double quaternion_tolerance = 1e-3;

SE3 pose_from(const TextLine& line, const Eigen::Vector3d& xyz_m, const Eigen::Vector4d& quat_xyzw) {
  const double norm = quat_xyzw.norm();
  if (std::abs(norm - 1) > quaternion_tolerance) {
    line.fail(fmt::format("quaternion has norm {:.6g}: expected 1 within {}", norm, quaternion_tolerance));
  }
  return core::se3::from_xyz_quat(xyz_m, quat_xyzw);
}

void check_ascending(const TextLine& line, const std::vector<StampedPose>& poses, Time t) {
  if (!poses.empty() && t <= poses.back().t) {
    line.fail(fmt::format("time {} is not after the line before it ({}): expected strictly ascending times",
                          seconds_text(t), seconds_text(poses.back().t)));
  }
}

void check_fields(const TextLine& line, std::size_t expected, const char* format) {
  if (line.fields.size() == expected) return;
  line.fail(fmt::format("{} fields: expected {} ({})", line.fields.size(), expected, format));
}

void check_not_empty(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  if (!poses.empty()) return;
  throw core::InputError(fmt::format("{}: holds no pose: expected one a line", file.string()));
}

SE3 kitti_pose(const TextLine& line) {
  check_fields(line, 12, "the upper 3x4 of a pose, row by row");
  Eigen::Matrix<double, 3, 4> M;
  for (int k = 0; k < 12; ++k) M(k / 4, k % 4) = line.number_at(static_cast<std::size_t>(k), "matrix entry");
  const Eigen::Matrix3d R = M.leftCols<3>();
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).norm();
  if (off > quaternion_tolerance || R.determinant() < 0) {
    line.fail(fmt::format("the left 3x3 is no rotation (R^T R is off the identity by {:.3g}, determinant {:.3g})", off,
                          R.determinant()));
  }
  SE3 T = SE3::Identity();
  T.linear() = R;
  T.translation() = M.col(3);
  return core::se3::normalized(T);
}

std::vector<Time> kitti_times(const std::filesystem::path& file) {
  std::vector<Time> times;
  TextLines lines(file, ' ');
  for (TextLine line; lines.next(line);) {
    check_fields(line, 1, "seconds");
    times.push_back(line.seconds_at(0, "time"));
  }
  return times;
}

}  // namespace

void write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses, const std::string& comment) {
  std::string text;
  if (!comment.empty()) text += fmt::format("# {}\n", comment);
  text += "# t_s x_m y_m z_m qx qy qz qw\n";
  for (const StampedPose& p : poses) {
    const Eigen::Vector3d x = p.T.translation();
    const Eigen::Vector4d q = core::se3::quat_xyzw(p.T);
    fmt::format_to(std::back_inserter(text), "{} {:.12f} {:.12f} {:.12f} {:.15f} {:.15f} {:.15f} {:.15f}\n",
                   seconds_text(p.t), x.x(), x.y(), x.z(), q[0], q[1], q[2], q[3]);
  }
  core::write_file(file, text);
}

std::vector<StampedPose> read_tum(const std::filesystem::path& file) {
  std::vector<StampedPose> poses;
  TextLines lines(file, ' ');
  for (TextLine line; lines.next(line);) {
    check_fields(line, 8, "t x y z qx qy qz qw, separated by blanks");
    const Time t = line.seconds_at(0, "t");
    check_ascending(line, poses, t);
    const Eigen::Vector3d xyz_m(line.number_at(1, "x"), line.number_at(2, "y"), line.number_at(3, "z"));
    const Eigen::Vector4d quat_xyzw(line.number_at(4, "qx"), line.number_at(5, "qy"), line.number_at(6, "qz"),
                                    line.number_at(7, "qw"));
    poses.push_back({t, pose_from(line, xyz_m, quat_xyzw)});
  }
  check_not_empty(file, poses);
  return poses;
}

void write_kitti_poses(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  std::string text;
  for (const StampedPose& p : poses) {
    const Eigen::Matrix<double, 3, 4> M = p.T.matrix().topRows<3>();
    for (int k = 0; k < 12; ++k) {
      fmt::format_to(std::back_inserter(text), "{:.15g}{}", M(k / 4, k % 4), k < 11 ? ' ' : '\n');
    }
  }
  core::write_file(file, text);
}

std::vector<StampedPose> read_kitti_poses(const std::filesystem::path& file, const std::filesystem::path& times_file,
                                          core::Duration period) {
  const std::vector<Time> times = times_file.empty() ? std::vector<Time>{} : kitti_times(times_file);
  std::vector<StampedPose> poses;
  TextLines lines(file, ' ');
  for (TextLine line; lines.next(line);) {
    Time t = core::time_from_ns(0) + static_cast<std::int64_t>(poses.size()) * period;
    if (!times_file.empty()) {
      if (poses.size() == times.size()) {
        line.fail(fmt::format("more poses than the {} times in {}", times.size(), times_file.string()));
      }
      t = times[poses.size()];
      check_ascending(line, poses, t);
    }
    poses.push_back({t, kitti_pose(line)});
  }
  check_not_empty(file, poses);
  if (!times_file.empty() && times.size() != poses.size()) {
    throw core::InputError(fmt::format("{}: {} times, but {} holds {} poses: expected as many", times_file.string(),
                                       times.size(), file.string(), poses.size()));
  }
  return poses;
}

std::vector<StampedPose> read_euroc(const std::filesystem::path& file) {
  std::vector<StampedPose> poses;
  TextLines lines(file, ',');
  for (TextLine line; lines.next(line);) {
    if (line.fields.size() < 8) {
      line.fail(fmt::format("{} fields: expected at least 8 (t_ns,x,y,z,qw,qx,qy,qz)", line.fields.size()));
    }
    const Time t = core::time_from_ns(line.integer_at(0, "t_ns"));
    check_ascending(line, poses, t);
    const Eigen::Vector3d xyz_m(line.number_at(1, "x"), line.number_at(2, "y"), line.number_at(3, "z"));
    const Eigen::Vector4d quat_xyzw(line.number_at(5, "qx"), line.number_at(6, "qy"), line.number_at(7, "qz"),
                                    line.number_at(4, "qw"));
    poses.push_back({t, pose_from(line, xyz_m, quat_xyzw)});
  }
  check_not_empty(file, poses);
  return poses;
}

void write_euroc(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  std::string text = "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n";
  for (const StampedPose& p : poses) {
    const Eigen::Vector3d x = p.T.translation();
    const Eigen::Vector4d q = core::se3::quat_xyzw(p.T);
    fmt::format_to(std::back_inserter(text), "{},{:.12f},{:.12f},{:.12f},{:.15f},{:.15f},{:.15f},{:.15f}\n",
                   core::to_ns(p.t), x.x(), x.y(), x.z(), q[3], q[0], q[1], q[2]);
  }
  core::write_file(file, text);
}

std::vector<StampedPose> read_trajectory(const std::filesystem::path& file) {
  TextLine line;
  TextLines lines(file, ' ');
  if (!lines.next(line)) check_not_empty(file, {});
  if (line.text.find(',') != std::string_view::npos) return read_euroc(file);
  if (line.fields.size() == 8) return read_tum(file);
  if (line.fields.size() != 12) {
    line.fail(fmt::format(
        "{} fields: expected 8 (TUM: t x y z qx qy qz qw), 12 (KITTI: 3x4 matrix) or commas (EuRoC: t_ns,x,y,z,qw,..)",
        line.fields.size()));
  }
  const std::filesystem::path times_file = file.parent_path() / "times.txt";
  const bool timed = std::filesystem::exists(times_file);
  return read_kitti_poses(file, timed ? times_file : std::filesystem::path(), kitti_period);
}

}  // namespace tarmac::io
