#include "reports/stills.h"

#include <vtkMapper.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cmath>

#include "reports/stills_cameras.h"
#include "reports/stills_state.h"

namespace tarmac::reports {

Stills::Stills(const scenes::Scene& scene, core::Time t, const std::string& egl_library)
    : state_(std::make_unique<State>(scene, egl_library)) {
  state_->build();
  state_->place(t);
}

Stills::~Stills() = default;

void Stills::set_time(core::Time t) {
  state_->place(t);
}

Image Stills::overview(int width_px, int height_px) {
  const vtkSmartPointer<vtkRenderer> renderer = state_->new_renderer(/*night=*/false);
  look_as_bird(renderer, state_->center, state_->half_m(), double(width_px) / height_px);
  return state_->draw(renderer, width_px, height_px);
}

Image Stills::top(const TopView& view) {
  const vtkSmartPointer<vtkRenderer> renderer = state_->new_renderer(/*night=*/false);
  look_from_above(renderer, view, state_->ground_z_m);
  return state_->draw(renderer, view.width_px, view.height_px);
}

Image Stills::view(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& direction, int width_px,
                   int height_px) {
  constexpr double room = 1.06;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector3d& p : points) corners.push_back(room * (p - box.center()));
  const vtkSmartPointer<vtkRenderer> renderer = state_->new_renderer(/*night=*/false);
  look_at_corners(renderer, box.center(), corners, direction, double(width_px) / height_px);
  return state_->draw(renderer, width_px, height_px);
}

Image Stills::seen_from(const EyeView& view, int width_px, int height_px) {
  check(view);
  const vtkSmartPointer<vtkRenderer> renderer = state_->new_renderer(/*night=*/false, /*with_ceilings=*/true);
  // The far ground is no part of the scene.
  const double above_ground_m = std::abs(view.eye_m.z() - state_->ground_z_m);
  look_from_eye(renderer, view, std::min(state_->distance_m(view.eye_m), above_ground_m));
  return state_->draw(renderer, width_px, height_px);
}

Image Stills::silhouette(const FlatView& view) {
  const vtkSmartPointer<vtkRenderer> renderer = state_->new_silhouette_renderer();
  look_flat(renderer, view);
  return state_->draw(renderer, view.width_px, view.height_px);
}

Image Stills::map(const metrics::MapSample& sample, const ErrorScale& scale, int width_px, int height_px) {
  const vtkSmartPointer<vtkRenderer> renderer = state_->new_renderer(/*night=*/true);
  const vtkSmartPointer<vtkActor> points = actor_of(to_polydata(sample, scale));
  points->GetProperty()->LightingOff();
  points->GetProperty()->SetPointSize(kSupersampling * 1.5f);
  // A map that sank below the true ground would vanish in it, and with it the very errors to be shown.
  points->GetMapper()->SetResolveCoincidentTopologyToPolygonOffset();
  points->GetMapper()->SetRelativeCoincidentTopologyPointOffsetParameter(-60000);
  renderer->AddActor(points);
  look_as_bird(renderer, state_->center, state_->half_m(), double(width_px) / height_px);
  return state_->draw(renderer, width_px, height_px);
}

}  // namespace tarmac::reports
