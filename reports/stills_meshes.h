/// Scenes and maps as VTK's data. Included by the stills' own sources only: VTK stays out of the public headers.
#pragma once

#include <vtkActor.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <Eigen/Core>
#include <vector>

#include "metrics/evaluation.h"
#include "reports/stills.h"
#include "scenes/scene.h"

namespace tarmac::reports {

using Rgb = Eigen::Vector3f;

inline constexpr double kGroundRadius_m = 1500;
/// What a night picture is tinted with; to_polydata() writes both versions.
inline const Rgb kNightTint{0.30f, 0.345f, 0.385f};

/// Cell arrays "day" and "night" hold the colours.
vtkSmartPointer<vtkPolyData> to_polydata(const scenes::Mesh& mesh, const std::vector<scenes::Material>& materials);
/// A disc around the scene that runs out into the haze, so that the world does not end at the last slab.
vtkSmartPointer<vtkPolyData> far_ground(const Eigen::Vector3d& center, const Rgb& near_color, const Rgb& far_color);
/// The static points, coloured by their error.
vtkSmartPointer<vtkPolyData> to_polydata(const metrics::MapSample& sample, const ErrorScale& scale);
vtkSmartPointer<vtkActor> actor_of(vtkPolyData* data);
vtkSmartPointer<vtkMatrix4x4> to_vtk(const Eigen::Matrix4d& T);

}  // namespace tarmac::reports
