/// What the stills keep between pictures: the window, meshes, light on the ground. VTK inside.
#pragma once

#include <vtkActor.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>

#include <string>
#include <vector>

#include "reports/ground_light.h"
#include "reports/stills.h"
#include "reports/stills_meshes.h"

namespace tarmac::reports {

inline constexpr int kSupersampling = 2;  ///< pixels are averaged over 2 x 2: edges without stairs

struct Stills::State {
  State(const scenes::Scene& scene_in, const std::string& egl_library);
  /// The window asks its owner, us, for its context.
  void connect(vtkGenericOpenGLRenderWindow* target);
  void build();
  static bool is_ground(const scenes::Instance& instance);
  /// A ceiling keeps rays in; in pictures from above it would hide the room.
  bool is_shown(const scenes::Instance& instance) const;
  vtkSmartPointer<vtkActor> instance_actor(const scenes::Instance& instance);
  /// Texture coordinates by the place in the world, so that one picture of shadows serves every slab.
  void add_ground_coordinates(vtkPolyData* data, const core::SE3& T_world_mesh) const;
  core::SE3 T_world_mesh(const scenes::Instance& instance) const;
  void place(core::Time t);
  /// Shadows of the sun, sharp, and of the sky, wide, as one picture that the pavement wears.
  void paint_ground_light();
  /// 1 where something stands between the ground and `to_light`.
  GroundLight cast_shadows(const Eigen::Vector3d& to_light);
  double lowest_z_m() const;
  /// To the nearest triangle.
  double distance_m(const Eigen::Vector3d& p_world) const;
  vtkSmartPointer<vtkRenderer> new_renderer(bool night, bool with_ceilings = false) const;
  vtkSmartPointer<vtkRenderer> new_silhouette_renderer() const;
  static void add_light(vtkRenderer* renderer, const Eigen::Vector3d& from, const Rgb& color, double intensity);
  Eigen::Vector2d half_m() const { return 0.5 * (scene.interest_max - scene.interest_min); }
  Image draw(vtkRenderer* renderer, int width_px, int height_px, int supersampling = kSupersampling);

  const scenes::Scene& scene;
  OffscreenGl gl;
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  std::vector<vtkSmartPointer<vtkPolyData>> meshes;
  std::vector<vtkSmartPointer<vtkActor>> actors;  ///< one an instance
  vtkNew<vtkTexture> ground_light;
  Eigen::Vector2d light_min = Eigen::Vector2d::Zero();
  double light_size_m = 0;
  core::Time time;
  bool placed = false;
  double ground_z_m = 0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
};

}  // namespace tarmac::reports
