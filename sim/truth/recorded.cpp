#include "sim/truth/recorded.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/files.h"
#include "scenes/paths/smooth_step.h"
#include "sim/truth/series.h"

namespace tarmac::sim::truth {

namespace {

using namespace core;
using Eigen::Vector3d;
using Vector7 = std::array<Series<2>, 7>;

constexpr int points = PathInterpolation::points;

/// Coefficients by powers of x of the polynomial through (x[k], y[k]): Newton's divided differences, multiplied out.
std::array<double, points> polynomial(const std::array<long double, points>& x, std::array<long double, points> y) {
  for (int order = 1; order < points; ++order)
    for (int k = points - 1; k >= order; --k) y[k] = (y[k] - y[k - 1]) / (x[k] - x[k - order]);
  std::array<long double, points> c{};
  for (int k = points - 1; k >= 0; --k) {
    for (int i = points - 1; i > 0; --i) c[i] = c[i - 1] - x[k] * c[i];
    c[0] = y[k] - x[k] * c[0];
  }
  std::array<double, points> rounded;
  for (int i = 0; i < points; ++i) rounded[i] = static_cast<double>(c[i]);
  return rounded;
}

Series<2> value_at(const std::array<double, points>& c, const Series<2>& x) {
  Series<2> sum = Series<2>::constant(c.back());
  for (int k = points - 2; k >= 0; --k) {
    sum = sum * x;
    sum.c[0] += c[static_cast<std::size_t>(k)];
  }
  return sum;
}

Series<2> step(double t_s, double from_s, double to_s) {
  return smooth_step(Series<2>::line((t_s - from_s) / (to_s - from_s), 1 / (to_s - from_s)));
}

/// Omega and alpha of a unit quaternion q(t): 2 conj(q) q' and 2 (conj(q) q')'.
void set_rotation(const std::array<Series<2>, 4>& raw, Kinematics& k) {
  Series<2> length2;
  for (const auto& component : raw) length2 += component * component;
  const Series<2> length = sqrt(length2);
  Eigen::Quaterniond q, q1, q2;
  for (int i = 0; i < 4; ++i) {
    const Series<2> unit = raw[static_cast<std::size_t>(i)] / length;
    q.coeffs()[i] = unit.value(), q1.coeffs()[i] = unit.d1(), q2.coeffs()[i] = unit.d2();
  }
  k.T_world_body.linear() = q.normalized().toRotationMatrix();
  k.omega_body = 2 * (q.conjugate() * q1).vec();
  // (conj(q) q')' = conj(q') q' + conj(q) q'', and the first is a number, without a vector part.
  k.alpha_body = 2 * (q.conjugate() * q2).vec();
}

}  // namespace

PathInterpolation::PathInterpolation(const std::vector<RecordedPose>& poses) {
  const int n = static_cast<int>(poses.size());
  std::vector<Eigen::Vector4d> quat;
  for (const RecordedPose& pose : poses) {
    const bool flip = !quat.empty() && quat.back().dot(pose.quat_xyzw) < 0;
    quat.push_back(flip ? Eigen::Vector4d(-pose.quat_xyzw) : pose.quat_xyzw);
  }
  const auto seconds = [&](int k) { return to_s(poses[static_cast<std::size_t>(k)].t - poses.front().t); };
  // Parts of 1 that never repeat: 1/golden ratio times k, without the whole.
  const auto share = [](int k) {
    const double x = k * (std::numbers::phi - 1);
    return 0.30 + 0.18 * (x - std::floor(x));
  };
  for (int k = 0; k + 1 < n; ++k) {
    const int first = std::clamp(k - points / 2 + 1, 0, n - points);
    Piece piece;
    piece.begin_s = seconds(k), piece.length_s = seconds(k + 1) - piece.begin_s;
    piece.centre_s = piece.begin_s + piece.length_s / 2;
    piece.scale_s = (seconds(first + points - 1) - seconds(first)) / 2;
    piece.blend_until_s = k == 0 ? piece.begin_s : piece.begin_s + share(2 * k) * piece.length_s;
    piece.blend_from_s = k + 2 == n ? seconds(n - 1) : piece.begin_s + (1 - share(2 * k + 1)) * piece.length_s;
    std::array<long double, points> x, y;
    for (int i = 0; i < points; ++i)
      x[i] = (seconds(first + i) - static_cast<long double>(piece.centre_s)) / piece.scale_s;
    for (int axis = 0; axis < 7; ++axis) {
      for (int i = 0; i < points; ++i) {
        const auto at = static_cast<std::size_t>(first + i);
        y[i] = axis < 3 ? poses[at].xyz_m[axis] : quat[at][axis - 3];
      }
      piece.coefficient[static_cast<std::size_t>(axis)] = polynomial(x, y);
    }
    pieces_.push_back(piece);
  }
}

Kinematics PathInterpolation::at(double t_s) const {
  const auto next = std::upper_bound(pieces_.begin(), pieces_.end(), t_s,
                                     [](double t, const Piece& piece) { return t < piece.begin_s; });
  const auto piece = next == pieces_.begin() ? next : std::prev(next);
  const auto values = [&](const Piece& p) {
    const Series<2> x = Series<2>::line((t_s - p.centre_s) / p.scale_s, 1 / p.scale_s);
    Vector7 v;
    for (std::size_t axis = 0; axis < 7; ++axis) v[axis] = value_at(p.coefficient[axis], x);
    return v;
  };
  Vector7 v = values(*piece);
  const auto blend = [&](const Piece& a, const Piece& b) {
    const Series<2> h = step(t_s, a.blend_from_s, b.blend_until_s);
    const Vector7 va = &a == &*piece ? v : values(a), vb = &b == &*piece ? v : values(b);
    for (std::size_t axis = 0; axis < 7; ++axis) v[axis] = va[axis] + h * (vb[axis] - va[axis]);
  };
  if (t_s < piece->blend_until_s && piece != pieces_.begin()) {
    blend(*std::prev(piece), *piece);
  } else if (t_s > piece->blend_from_s && std::next(piece) != pieces_.end()) {
    blend(*piece, *std::next(piece));
  }
  Kinematics k;
  for (int axis = 0; axis < 3; ++axis) {
    const Series<2>& p = v[static_cast<std::size_t>(axis)];
    k.T_world_body.translation()[axis] = p.value();
    k.v_world[axis] = p.d1(), k.a_world[axis] = p.d2();
  }
  set_rotation({v[3], v[4], v[5], v[6]}, k);
  return k;
}

namespace {

class Recorded final : public SmoothTrajectory {
 public:
  Recorded(const RecordedOptions& options, PathInterpolation path, Duration duration)
      : options_(options), path_(std::move(path)), duration_(duration) {}

  Time begin() const override { return Time(); }
  Time end() const override { return Time(duration_); }

  Kinematics at(Time t) const override {
    if (!covers(t)) throw OutOfSpan(fmt::format("the path covers 0 to {} s, not {} s", to_s(duration_), to_s(t)));
    const Series<2> pace = path_time(to_s(t));
    const Kinematics path = path_.at(pace.value());
    const Eigen::Matrix3d R = options_.T_world_path.linear();
    const double rate = pace.d1(), change = pace.d2();
    Kinematics k;
    k.T_world_body = options_.T_world_path * path.T_world_body;
    k.v_world = R * path.v_world * rate;
    k.a_world = R * (path.a_world * rate * rate + path.v_world * change);
    k.omega_body = path.omega_body * rate;
    k.alpha_body = path.alpha_body * rate * rate + path.omega_body * change;
    return k;
  }

  /// Time of the path [s] at t: it rests, comes up to its own pace, and keeps it.
  Series<2> path_time(double t_s) const {
    const double T = options_.ease_s, since_s = t_s - options_.rest_s;
    if (options_.rest_s == 0 && T == 0) return Series<2>::line(t_s, 1);
    if (since_s <= 0) return {};
    if (since_s >= T) return Series<2>::line(since_s - T / 2, 1);
    const Series<2> h = smooth_step(Series<2>::line(since_s / T, 1 / T));
    return integral(h.truncated<1>(), T * scenes::smooth_step_integral(since_s / T));
  }

 private:
  RecordedOptions options_;
  PathInterpolation path_;
  Duration duration_;
};

/// Where the poses come from, for messages.
std::string source_of(const ConfigNode& node, const RecordedOptions& options) {
  if (options.file.empty()) return fmt::format("{}: motion.poses", node.file());
  const std::filesystem::path file = options.file;
  const ConfigNode named = node.child("file");
  if (file.is_absolute() || named.given_by_set()) return file.string();
  return (std::filesystem::path(node.file()).parent_path() / file).string();
}

std::string content_of(const ConfigNode& node, const RecordedOptions& options) {
  if (options.file.empty() == options.poses.empty()) {
    node.fail_at("file", "give either file (a TUM or CSV file) or poses (its lines), not both and not none");
  }
  if (options.file.empty()) {
    std::string text;
    for (const std::string& pose : options.poses) text += pose + "\n";
    return text;
  }
  try {
    return read_file(source_of(node, options));
  } catch (const InputError& error) {
    node.fail_at("file", error.what());
  }
}

/// Every value as its shortest text that reads back the same, times from the first.
std::string line_of(const RecordedPose& pose, Time first) {
  const std::int64_t ns = (pose.t - first).count();
  std::string line = fmt::format("{}.{:09}", ns / 1'000'000'000, ns % 1'000'000'000);
  for (const double value : {pose.xyz_m.x(), pose.xyz_m.y(), pose.xyz_m.z(), pose.quat_xyzw[0], pose.quat_xyzw[1],
                             pose.quat_xyzw[2], pose.quat_xyzw[3]}) {
    line += fmt::format(" {}", value);
  }
  return line;
}

/// What the poses themselves imply, from one to the next.
void check_steps(const std::vector<RecordedPose>& poses, const RecordedOptions& options, const std::string& name) {
  if (poses.size() < points) {
    throw InputError(fmt::format("{}: has {} poses; a path needs at least {}", name, poses.size(), points));
  }
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const RecordedPose &a = poses[k - 1], &b = poses[k];
    const double dt = to_s(b.t - a.t), speed = (b.xyz_m - a.xyz_m).norm() / dt;
    const double cosine = std::min(1.0, std::abs(a.quat_xyzw.dot(b.quat_xyzw)));
    const double rate_deg_s = 2 * std::acos(cosine) / dt * 180 / std::numbers::pi;
    const auto fail = [&](const std::string& message) {
      throw InputError(fmt::format("{}:{}: {}", name, b.line, message));
    };
    if (dt > options.max_gap_s) {
      fail(fmt::format(
          "{:.3f} s lie between this pose and that of line {}: nothing is known of the motion in such a gap "
          "(max_gap_s is {})",
          dt, a.line, options.max_gap_s));
    }
    if (speed > options.max_speed_m_s) {
      fail(
          fmt::format("the pose is {:.3f} m from that of line {}, {:.3f} s earlier: {:.1f} m/s is a jump and no motion "
                      "(max_speed_m_s is {})",
                      (b.xyz_m - a.xyz_m).norm(), a.line, dt, speed, options.max_speed_m_s));
    }
    if (rate_deg_s > options.max_rate_deg_s) {
      fail(fmt::format("the attitude turns by {:.1f} deg from that of line {} within {:.3f} s (max_rate_deg_s is {})",
                       rate_deg_s * dt, a.line, dt, options.max_rate_deg_s));
    }
  }
}

/// What the interpolation makes of them: a jump that is slow enough to pass as a motion shows in the acceleration.
void check_interpolation(const std::vector<RecordedPose>& poses, const PathInterpolation& path,
                         const RecordedOptions& options, const std::string& name) {
  constexpr int samples = 12;
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const double begin_s = to_s(poses[k].t - poses[0].t), dt = to_s(poses[k + 1].t - poses[k].t);
    for (int i = 0; i < samples; ++i) {
      const Kinematics state = path.at(begin_s + dt * (i + 0.5) / samples);
      const double a = state.a_world.norm(), v = state.v_world.norm();
      const double rate_deg_s = state.omega_body.norm() * 180 / std::numbers::pi;
      if (a <= options.max_acceleration_m_s2 && v <= options.max_speed_m_s && rate_deg_s <= options.max_rate_deg_s) {
        continue;
      }
      throw InputError(fmt::format(
          "{}:{}: between this pose and the next (line {}) a smooth motion through the poses has {:.1f} m/s, {:.1f} "
          "m/s^2 "
          "and {:.0f} deg/s, above max_speed_m_s {}, max_acceleration_m_s2 {} or max_rate_deg_s {}: a jump, or noise "
          "that would shake the sensor; smooth the path first, or raise the limit",
          name, poses[k].line, poses[k + 1].line, v, a, rate_deg_s, options.max_speed_m_s,
          options.max_acceleration_m_s2, options.max_rate_deg_s));
    }
  }
}

std::vector<RecordedPose> checked_poses(const ConfigNode& node, const RecordedOptions& options) {
  const std::string name = source_of(node, options);
  std::vector<RecordedPose> poses = parse_path(content_of(node, options), name);
  check_steps(poses, options, name);
  return poses;
}

RecordedOptions read_as_written(const ConfigNode& node) {
  RecordedOptions options;
  node.read(options, {"kind"});
  if (options.rest_s > 0 && options.ease_s == 0) {
    node.fail_at("ease_s", "must be above 0 after a rest: nothing comes up to its pace at once");
  }
  return options;
}

}  // namespace

void RecordedOptions::visit(OptionVisitor& v) {
  v("file", file, "TUM or CSV file (t x y z qx qy qz qw; seconds, metres), relative to the scenario's file");
  v("poses", poses, "the lines of such a file, in its place");
  v("T_world_path", T_world_path, "where the path's own frame lies in the scene's");
  v("rest_s", rest_s, "time at rest at the first pose before the path is followed", {.at_least = 0});
  v("ease_s", ease_s,
    "time in which it comes up to the path's own pace, from rest (0: the path is followed from t = 0 on)",
    {.at_least = 0});
  v("max_gap_s", max_gap_s, "longest time between two poses", {.above = 0});
  v("max_speed_m_s", max_speed_m_s, "a faster path has jumps", {.above = 0});
  v("max_acceleration_m_s2", max_acceleration_m_s2, "a path that accelerates more has jumps or noise", {.above = 0});
  v("max_rate_deg_s", max_rate_deg_s, "a path that turns faster has jumps", {.above = 0});
}

RecordedOptions read_recorded_options(const ConfigNode& node) {
  RecordedOptions options = read_as_written(node);
  const std::vector<RecordedPose> poses = checked_poses(node, options);
  options.file.clear();
  options.poses.clear();
  for (const RecordedPose& pose : poses) options.poses.push_back(line_of(pose, poses.front().t));
  return options;
}

std::shared_ptr<const SmoothTrajectory> make_recorded(const ConfigNode& node, Duration duration) {
  const RecordedOptions options = read_as_written(node);
  const std::string name = source_of(node, options);
  const std::vector<RecordedPose> poses = checked_poses(node, options);
  PathInterpolation path(poses);
  check_interpolation(poses, path, options, name);
  const double covered_s = to_s(poses.back().t - poses.front().t);
  auto motion = std::make_shared<Recorded>(options, std::move(path), duration);
  const double needed_s = motion->path_time(to_s(duration)).value();
  if (needed_s > covered_s) {
    throw InputError(fmt::format(
        "{}:{}: the path ends here, after {:.3f} s, but a motion of {} s needs {:.3f} s of it: "
        "shorten duration_s to at most {:.3f} s, or lengthen the path",
        name, poses.back().line, covered_s, to_s(duration), needed_s, to_s(duration) - (needed_s - covered_s)));
  }
  return motion;
}

}  // namespace tarmac::sim::truth
