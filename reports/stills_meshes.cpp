#include "reports/stills_meshes.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCleanPolyData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkUnsignedCharArray.h>

#include <array>
#include <cmath>

namespace tarmac::reports {

namespace {

void append(vtkUnsignedCharArray* colors, const Rgb& color) {
  const Rgb bytes = 255 * color;
  colors->InsertNextTuple3(bytes.x(), bytes.y(), bytes.z());
}

}  // namespace

vtkSmartPointer<vtkPolyData> to_polydata(const scenes::Mesh& mesh, const std::vector<scenes::Material>& materials) {
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.vertices[i].cast<double>().eval().data());
  }
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkUnsignedCharArray> day, night;
  day->SetName("day");
  night->SetName("night");
  for (auto* colors : {day.Get(), night.Get()}) colors->SetNumberOfComponents(3);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto& corner = mesh.triangles[k];
    const vtkIdType ids[3] = {corner[0], corner[1], corner[2]};
    triangles->InsertNextCell(3, ids);
    const Rgb color = materials.at(mesh.materials.at(k)).color.cwiseMax(0).cwiseMin(1);
    append(day, color);
    append(night, (0.3f + 0.7f * color.dot(Rgb(0.21f, 0.72f, 0.07f))) * kNightTint);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(triangles);
  data->GetCellData()->AddArray(day);
  data->GetCellData()->AddArray(night);

  vtkNew<vtkCleanPolyData> merge;  // meshes may repeat a corner per triangle; smooth shading needs it once
  merge->SetInputData(data);
  merge->ConvertPolysToLinesOff();
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputConnection(merge->GetOutputPort());
  normals->SetFeatureAngle(32);
  normals->ConsistencyOff();
  normals->Update();
  return normals->GetOutput();
}

vtkSmartPointer<vtkPolyData> far_ground(const Eigen::Vector3d& center, const Rgb& near_color, const Rgb& far_color) {
  constexpr int kSpokes = 96;
  const std::array<double, 4> radius_m{0, 120, 450, kGroundRadius_m};
  vtkNew<vtkPoints> points;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (std::size_t ring = 0; ring < radius_m.size(); ++ring) {
    const float share = std::sqrt(static_cast<float>(radius_m[ring] / kGroundRadius_m));
    const Rgb color = near_color + share * (far_color - near_color);
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double angle_rad = 2 * M_PI * spoke / kSpokes;
      points->InsertNextPoint(center.x() + radius_m[ring] * std::cos(angle_rad),
                              center.y() + radius_m[ring] * std::sin(angle_rad), center.z());
      append(colors, color);
    }
  }
  vtkNew<vtkCellArray> quads;
  for (vtkIdType ring = 0; ring + 1 < static_cast<vtkIdType>(radius_m.size()); ++ring) {
    for (vtkIdType spoke = 0; spoke < kSpokes; ++spoke) {
      const vtkIdType next = (spoke + 1) % kSpokes;
      const vtkIdType ids[4] = {ring * kSpokes + spoke, (ring + 1) * kSpokes + spoke, (ring + 1) * kSpokes + next,
                                ring * kSpokes + next};
      quads->InsertNextCell(4, ids);
    }
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(quads);
  data->GetPointData()->SetScalars(colors);
  return data.Get();
}

vtkSmartPointer<vtkPolyData> to_polydata(const metrics::MapSample& sample, const ErrorScale& scale) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < sample.p_world_m.size(); ++i) {
    if (i < sample.moving.size() && sample.moving[i]) continue;  // a mover smears in any map: no error of the method
    if (!sample.p_world_m[i].allFinite()) continue;
    const vtkIdType id = points->InsertNextPoint(sample.p_world_m[i].data());
    vertices->InsertNextCell(1, &id);
    append(colors, error_color(place_on(scale, sample.error_m.at(i))));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(vertices);
  data->GetPointData()->SetScalars(colors);
  return data.Get();
}

vtkSmartPointer<vtkActor> actor_of(vtkPolyData* data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetColorModeToDirectScalars();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  return actor.Get();
}

vtkSmartPointer<vtkMatrix4x4> to_vtk(const Eigen::Matrix4d& T) {
  vtkNew<vtkMatrix4x4> matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix->SetElement(row, column, T(row, column));
  }
  return matrix.Get();
}

}  // namespace tarmac::reports
