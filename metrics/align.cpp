#include "metrics/align.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/shortest_turn.h"

namespace tarmac::metrics {

using namespace core;

namespace {

constexpr std::array kAlignments{Alignment::none, Alignment::first_pose, Alignment::yaw_pos, Alignment::se3,
                                 Alignment::sim3};
/// Positions that all lie within this are one point: what they say of a rotation is rounding.
constexpr double kSamePlaceM = 1e-9;
/// Ratio of the second to the first singular value below which positions lie on a line: 1e-5 of its length beside it.
constexpr double kOnALine = 1e-10;

const char* const kNoteOnePlace = "the positions are all equal: the rotation is that of the first pose";
const char* const kNoteLine =
    "the positions lie on a line: the rotation about it is free, taken nearest to the first pose's";

struct Centred {
  Eigen::Vector3d p_mean, q_mean;
  Eigen::Matrix3Xd p, q;
  Eigen::Matrix3d H;  ///< sum of q p^T
  Centred(const Eigen::Matrix3Xd& p_map, const Eigen::Matrix3Xd& q_world)
      : p_mean(p_map.rowwise().mean()),
        q_mean(q_world.rowwise().mean()),
        p(p_map.colwise() - p_mean),
        q(q_world.colwise() - q_mean),
        H(q * p.transpose()) {}
  double count() const { return static_cast<double>(p.cols()); }
};

Fit assemble(const Centred& c, double scale, const Eigen::Matrix3d& R, std::string note) {
  Fit fit;
  fit.A.scale = scale;
  fit.A.T_world_map.linear() = R;
  fit.A.T_world_map.translation() = c.q_mean - scale * (R * c.p_mean);
  fit.note = std::move(note);
  return fit;
}

}  // namespace

const char* name_of(Alignment alignment) {
  switch (alignment) {
    case Alignment::none:
      return "none";
    case Alignment::first_pose:
      return "first_pose";
    case Alignment::yaw_pos:
      return "yaw_pos";
    case Alignment::se3:
      return "se3";
    case Alignment::sim3:
      return "sim3";
  }
  return "?";
}

Alignment alignment(const std::string& name) {
  std::string plain = name;
  std::replace(plain.begin(), plain.end(), '-', '_');
  for (const Alignment a : kAlignments)
    if (plain == name_of(a)) return a;
  throw InputError(
      fmt::format("alignment '{}' is none of: none, first-pose, yaw-pos, se3, sim3; name one of these", name));
}

Eigen::Matrix3d fit_rotation(const Eigen::Matrix3d& H, double count, const Eigen::Matrix3d& R_preferred,
                             std::string* note) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d sigma = svd.singularValues();
  if (!(sigma[0] > count * kSamePlaceM * kSamePlaceM)) {
    if (note) *note = kNoteOnePlace;
    return R_preferred;
  }
  const Eigen::Matrix3d& U = svd.matrixU();
  const Eigen::Matrix3d& V = svd.matrixV();
  if (sigma[1] < kOnALine * sigma[0]) {
    if (note) *note = kNoteLine;
    // R v = u is all that H asks. Nearest to P is Q P with the smallest turn Q that carries P v onto u.
    return core::shortest_turn(R_preferred * V.col(0), U.col(0)).toRotationMatrix() * R_preferred;
  }
  const double sign = U.determinant() * V.determinant() < 0 ? -1 : 1;
  return U * Eigen::Vector3d(1, 1, sign).asDiagonal() * V.transpose();
}

Fit align_se3(const Eigen::Matrix3Xd& p_map_m, const Eigen::Matrix3Xd& q_world_m, const Eigen::Matrix3d& R_preferred) {
  const Centred c(p_map_m, q_world_m);
  std::string note;
  const Eigen::Matrix3d R = fit_rotation(c.H, c.count(), R_preferred, &note);
  return assemble(c, 1, R, note);
}

std::optional<Fit> align_sim3(const Eigen::Matrix3Xd& p_map_m, const Eigen::Matrix3Xd& q_world_m,
                              const Eigen::Matrix3d& R_preferred) {
  const Centred c(p_map_m, q_world_m);
  const double spread = c.p.squaredNorm();
  if (!(spread > c.count() * kSamePlaceM * kSamePlaceM)) return std::nullopt;
  std::string note;
  const Eigen::Matrix3d R = fit_rotation(c.H, c.count(), R_preferred, &note);
  // A negative correlation would ask for a mirror; the best scale that a similarity may have is then 0.
  const double scale = std::max(0.0, (R.transpose() * c.H).trace() / spread);
  return assemble(c, scale, R, note);
}

Fit align_yaw_position(const Eigen::Matrix3Xd& p_map_m, const Eigen::Matrix3Xd& q_world_m,
                       const Eigen::Matrix3d& R_level) {
  const Centred c(R_level * p_map_m, q_world_m);
  // trace(Rz(yaw)^T H) = cos(yaw) (H00 + H11) + sin(yaw) (H10 - H01) + H22.
  const double along = c.H(0, 0) + c.H(1, 1), across = c.H(1, 0) - c.H(0, 1);
  const bool free = !(std::hypot(along, across) > c.count() * kSamePlaceM * kSamePlaceM);
  const Eigen::Matrix3d Rz =
      Eigen::AngleAxisd(free ? 0.0 : std::atan2(across, along), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Fit fit = assemble(c, 1, Rz, free ? "the positions leave the yaw free: none is applied" : "");
  fit.A.T_world_map.linear() = Rz * R_level;
  return fit;
}

}  // namespace tarmac::metrics
