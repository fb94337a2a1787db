#include "scenes/actors/walker.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include "scenes/paths/smooth_step.h"
#include "scenes/primitives/mesh_builder.h"

namespace tarmac::scenes {
namespace {

constexpr double raise_s = 1.5;
constexpr double half_gait_m_s = 0.3;  // speed at which steps have half their full size

/// 0 at rest, near 1 at walking speed.
double gait_at(double speed_m_s) {
  const double v2 = speed_m_s * speed_m_s;
  return v2 / (v2 + half_gait_m_s * half_gait_m_s);
}

std::uint64_t next_id() {
  static std::atomic<std::uint64_t> next{1};
  return next++;
}

}  // namespace

Walker::Walker(Course course, const Gesture& gesture, std::shared_ptr<const Ground> ground)
    : course_(std::move(course)),
      gesture_(gesture),
      ground_(std::move(ground)),
      stride_m_(person_stride_m(std::max(0.1, gait_at(course_.top_speed_m_s())))),
      id_(next_id()) {}

core::SE3 Walker::T_world_person(double t_s) const {
  const PlanarPath::Point p = course_.path().at(course_.s_m(t_s));
  return place(p.x_m, p.y_m, ground_->height_m(p.x_m, p.y_m), p.heading.f);
}

PersonPosture Walker::posture(double t_s) const {
  PersonPosture posture;
  posture.gait_phase_rad = 2 * std::numbers::pi * course_.s_m(t_s) / stride_m_;
  posture.gait = gait_at(course_.speed_m_s(t_s));
  if (gesture_.from_s >= 0) {
    posture.arms_raised =
        smooth_step((t_s - gesture_.from_s) / raise_s).f - smooth_step((t_s - gesture_.until_s) / raise_s).f;
    posture.wave_phase_rad = 2 * std::numbers::pi * gesture_.beckon_hz * (t_s - gesture_.from_s);
  }
  return posture;
}

const std::vector<core::SE3>& Walker::T_world_parts(double t_s) const {
  struct Answer {
    std::uint64_t walker = 0;
    double t_s = 0;
    std::vector<core::SE3> parts;
  };
  thread_local std::array<Answer, 16> answers;
  thread_local std::size_t oldest = 0;
  for (const Answer& answer : answers)
    if (answer.walker == id_ && answer.t_s == t_s) return answer.parts;
  Answer& answer = answers[oldest++ % answers.size()];
  answer = {id_, t_s, person_pose(posture(t_s))};
  const core::SE3 T_world_person = this->T_world_person(t_s);
  for (core::SE3& T : answer.parts) T = T_world_person * T;
  return answer.parts;
}

std::vector<Course::Span> Walker::moves() const {
  std::vector<Course::Span> all = course_.moves();
  if (gesture_.from_s >= 0) all.push_back({gesture_.from_s, gesture_.until_s + raise_s});
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.begin_s < b.begin_s; });
  std::vector<Course::Span> merged;
  for (const Course::Span& span : all) {
    if (!merged.empty() && span.begin_s <= merged.back().end_s)
      merged.back().end_s = std::max(merged.back().end_s, span.end_s);
    else
      merged.push_back(span);
  }
  return merged;
}

WalkerPart::WalkerPart(std::shared_ptr<const Walker> walker, std::size_t part)
    : walker_(std::move(walker)), part_(part) {
  tabulate(walker_->moves());
}

core::SE3 WalkerPart::pose(double t_s) const {
  return walker_->T_world_parts(t_s)[part_];
}

}  // namespace tarmac::scenes
