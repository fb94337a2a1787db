/// Motions that a timetable drives.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scenes/actors/acceleration_table.h"
#include "scenes/actors/footing.h"

namespace tarmac::scenes {

/// The motion with its table of bounds, which is made at construction: derived classes call tabulate() last in theirs.
class TimetabledMotion : public ActorMotion {
 public:
  core::SE3 T_world_actor(core::Time t) const final { return pose(core::to_s(t)); }
  double acceleration_bound_m_s2(core::Time t0, core::Time t1, double radius_m) const final {
    return bounds_->bound_m_s2(core::to_s(t0), core::to_s(t1), radius_m);
  }

 protected:
  virtual core::SE3 pose(double t_s) const = 0;
  void tabulate(std::span<const Course::Span> moves) {
    bounds_.emplace([this](double t_s) { return pose(t_s); }, moves);
  }

 private:
  std::optional<AccelerationTable> bounds_;
};

/// A body of a convoy: what moves along a course, or is drawn behind it.
class Convoy {
 public:
  virtual ~Convoy() = default;
  virtual const Course& course() const = 0;
  /// Rear axle of body `index` when the leader has covered s.
  virtual PlanarPose body(std::size_t index, double s_m) const = 0;
};

/// One body, standing on the ground.
class GroundMotion final : public TimetabledMotion {
 public:
  GroundMotion(std::shared_ptr<const Convoy> convoy, std::size_t index, const Footing& footing,
               std::shared_ptr<const Ground> ground)
      : convoy_(std::move(convoy)), index_(index), footing_(footing), ground_(std::move(ground)) {
    tabulate(convoy_->course().moves());
  }

 private:
  core::SE3 pose(double t_s) const override {
    return stand_on(*ground_, footing_, convoy_->body(index_, convoy_->course().s_m(t_s)));
  }
  std::shared_ptr<const Convoy> convoy_;
  std::size_t index_;
  Footing footing_;
  std::shared_ptr<const Ground> ground_;
};

}  // namespace tarmac::scenes
