/// Who leads and who follows.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "scenes/actors/timetabled.h"
#include "scenes/actors/trailers.h"

namespace tarmac::scenes {

/// One vehicle (or aircraft), whose rear axle (main gear) runs along the course.
class SingleVehicle final : public Convoy {
 public:
  explicit SingleVehicle(Course course) : course_(std::move(course)) {}
  const Course& course() const override { return course_; }
  PlanarPose body(std::size_t, double s_m) const override;

 private:
  Course course_;
};

/// A tractor (body 0) and carts (bodies 1, 2, ...), each drawn by the one before it (TrailerChain).
class Train final : public Convoy {
 public:
  Train(Course course, const std::vector<TrailerChain::Link>& carts);
  const Course& course() const override { return course_; }
  PlanarPose body(std::size_t index, double s_m) const override;
  const TrailerChain& chain() const { return chain_; }

 private:
  Course course_;
  TrailerChain chain_;
};

/// An aircraft that is pushed back. The course is that of its main gear, which moves tail first: with chi the direction
/// of its motion, kappa the curvature of the course, L the wheelbase and b the towbar's length,
///
///   nose gear N = P - L u(chi),   it rolls along mu = chi - atan(L kappa), and so does the towbar,
///   towbar's far end H = N - b u(mu),
///
/// all closed forms of the course. The tractor pushes at H; its axle, `tractor_m` behind H in the sense of the motion,
/// does not slip: a trailer of H (TrailerChain with no hitch offset), stable in this direction.
class Pushback final : public Convoy {
 public:
  enum Body : std::size_t { aircraft = 0, towbar = 1, tractor = 2 };
  /// The towbar's reference point is its far end, H; the tractor's is its axle. Headings: aircraft nose, towbar towards
  /// the nose gear, tractor towards H.
  Pushback(Course course, double wheelbase_m, double towbar_m, double tractor_m);
  const Course& course() const override { return course_; }
  PlanarPose body(std::size_t index, double s_m) const override;
  const TrailerChain& chain() const { return chain_; }
  /// Largest angle of the nose gear from straight ahead [rad], and where.
  TrailerChain::Bend sharpest_steer() const;

 private:
  PlanarJets coupling(double s_m) const;
  Course course_;
  double wheelbase_m_, towbar_m_;
  TrailerChain chain_;
};

}  // namespace tarmac::scenes
