#include "reports/stills.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkAutoInit.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCleanPolyData.h>
#include <vtkFloatArray.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkLogger.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "reports/ground_light.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2)

namespace tarmac::reports {

namespace {

using Rgb = Eigen::Vector3f;

// The light of a bright, slightly hazy day, and a night version of it under the coloured maps.
const Rgb kSkyTop{0.60f, 0.72f, 0.83f}, kSkyHorizon{0.90f, 0.92f, 0.92f};
const Rgb kDayGround{0.66f, 0.68f, 0.63f}, kNightGround{0.085f, 0.10f, 0.115f};
const Rgb kNight{0.055f, 0.066f, 0.078f}, kNightTint{0.30f, 0.345f, 0.385f};
const Eigen::Vector3d kSun = Eigen::Vector3d(-0.62, -0.55, 0.80).normalized();  ///< from the scene to the sun
constexpr int kSupersampling = 2;  ///< pixels are averaged over 2 x 2: edges without stairs
constexpr int kShadowPixels = 2048;
constexpr double kGroundRadius_m = 1500;
constexpr double kFramedWidth = 0.8;
constexpr double kTallest_m = 14;  ///< what the bird's view leaves room for above the ground
const Eigen::Vector3d kBirdDirection = Eigen::Vector3d(-0.62, -1.0, 0.50).normalized();  ///< from the scene to the eye
constexpr double kFieldOfView_deg = 28;

/// Debian's GLEW asks for an X display that is not there and needs none: VTK reports that as an error each time a
/// window is made. Everything else is passed on.
class QuietAboutGlew final : public vtkOutputWindow {
 public:
  static QuietAboutGlew* New();
  vtkTypeMacro(QuietAboutGlew, vtkOutputWindow) void DisplayText(const char* text) override {
    if (std::strstr(text, "GLEW could not be initialized") == nullptr) fmt::print(stderr, "{}\n", text);
  }
};
vtkStandardNewMacro(QuietAboutGlew)

    void keep_quiet_about_glew() {
  static const bool done = [] {
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);  // it would print the same messages, unfiltered
    vtkNew<QuietAboutGlew> window;
    vtkOutputWindow::SetInstance(window);
    return true;
  }();
  static_cast<void>(done);
}

void append(vtkUnsignedCharArray* colors, const Rgb& color) {
  const Rgb bytes = 255 * color;
  colors->InsertNextTuple3(bytes.x(), bytes.y(), bytes.z());
}

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

/// A disc around the scene that runs out into the haze, so that the world does not end at the last slab.
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

}  // namespace

struct Stills::State {
  State(const scenes::Scene& scene_in, const std::string& egl_library) : scene(scene_in), gl(egl_library) {
    keep_quiet_about_glew();
    connect(window);
    window->SetMapped(1);
    window->SetIsDirect(1);
    window->SetOwnContext(0);
    window->SetMultiSamples(0);
    window->InitializeFromCurrentContext();
  }

  /// The window asks its owner, us, for its context.
  void connect(vtkGenericOpenGLRenderWindow* target) {
    const auto observe = [&](unsigned long event, void (*answer)(vtkObject*, unsigned long, void*, void*)) {
      vtkNew<vtkCallbackCommand> command;
      command->SetClientData(&gl);
      command->SetCallback(answer);
      target->AddObserver(event, command);
    };
    observe(vtkCommand::WindowMakeCurrentEvent,
            [](vtkObject*, unsigned long, void* gl_, void*) { static_cast<OffscreenGl*>(gl_)->make_current(); });
    observe(vtkCommand::WindowIsCurrentEvent, [](vtkObject*, unsigned long, void* gl_, void* answer) {
      *static_cast<bool*>(answer) = static_cast<OffscreenGl*>(gl_)->is_current();
    });
    observe(vtkCommand::WindowSupportsOpenGLEvent,
            [](vtkObject*, unsigned long, void*, void* answer) { *static_cast<int*>(answer) = 1; });
  }

  void build() {
    for (const auto& mesh : scene.meshes) meshes.push_back(to_polydata(mesh, scene.materials));
    ground_z_m = lowest_z_m() - 0.25;
    center = {0.5 * (scene.interest_min.x() + scene.interest_max.x()),
              0.5 * (scene.interest_min.y() + scene.interest_max.y()), ground_z_m};
    light_min = scene.interest_min.array() - 80;
    light_size_m = (scene.interest_max - scene.interest_min).maxCoeff() + 160;
    ground_light->SetRepeat(0);
    ground_light->InterpolateOn();
    ground_light->MipmapOn();
    for (const auto& instance : scene.instances) actors.push_back(instance_actor(instance));
  }

  static bool is_ground(const scenes::Instance& instance) {
    return instance.label == scenes::Label::pavement || instance.label == scenes::Label::marking;
  }

  vtkSmartPointer<vtkActor> instance_actor(const scenes::Instance& instance) {
    vtkNew<vtkPolyData> data;
    data->ShallowCopy(meshes.at(instance.mesh));
    if (is_ground(instance)) add_ground_coordinates(data, instance.T_parent_mesh);
    const vtkSmartPointer<vtkActor> actor = actor_of(data);
    actor->GetMapper()->SetScalarModeToUseCellFieldData();
    actor->GetProperty()->SetAmbient(0.41);
    actor->GetProperty()->SetDiffuse(0.72);
    actor->GetProperty()->SetSpecular(0);
    if (is_ground(instance)) actor->SetTexture(ground_light);
    return actor;
  }

  /// Texture coordinates by the place in the world, so that one picture of shadows serves every slab.
  void add_ground_coordinates(vtkPolyData* data, const core::SE3& T_world_mesh) const {
    vtkNew<vtkFloatArray> coordinates;
    coordinates->SetNumberOfComponents(2);
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
      const Eigen::Vector3d p_world = T_world_mesh * Eigen::Map<const Eigen::Vector3d>(data->GetPoint(i));
      const Eigen::Vector2d uv = (p_world.head<2>() - light_min) / light_size_m;
      coordinates->InsertNextTuple2(uv.x(), uv.y());
    }
    data->GetPointData()->SetTCoords(coordinates);
  }

  core::SE3 T_world_mesh(const scenes::Instance& instance) const {
    if (instance.actor < 0) return instance.T_parent_mesh;
    return scene.actors.at(instance.actor).motion->T_world_actor(time) * instance.T_parent_mesh;
  }

  void place(core::Time t) {
    if (placed && t == time) return;
    placed = true;
    time = t;
    for (std::size_t i = 0; i < actors.size(); ++i) {
      actors[i]->SetUserMatrix(to_vtk(T_world_mesh(scene.instances[i]).matrix()));
    }
    paint_ground_light();
  }

  /// Shadows of the sun, sharp, and of the sky, wide, as one picture that the pavement wears.
  void paint_ground_light() {
    GroundLight sun = cast_shadows(kSun), sky = cast_shadows(Eigen::Vector3d::UnitZ());
    const double px_per_m = kShadowPixels / light_size_m;
    sun.blur(std::max(1, static_cast<int>(0.12 * px_per_m)));
    sky.blur(std::max(1, static_cast<int>(0.6 * px_per_m)));
    vtkNew<vtkImageData> picture;
    picture->SetDimensions(kShadowPixels, kShadowPixels, 1);
    picture->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    auto* const bytes = static_cast<unsigned char*>(picture->GetScalarPointer());
    for (std::size_t i = 0; i < sun.value.size(); ++i) {
      const std::size_t x = i % kShadowPixels, y = i / kShadowPixels;
      // The outermost pixels stand for everything beyond.
      const bool edge = x == 0 || y == 0 || x == kShadowPixels - 1 || y == kShadowPixels - 1;
      const float dark = edge ? 0 : 1 - (1 - 0.42f * sun.value[i]) * (1 - 0.38f * sky.value[i]);
      for (int channel = 0; channel < 3; ++channel) {
        const float tint = channel == 0 ? 1.04f : channel == 2 ? 0.94f : 1.0f;  // the sky still lights a shadow: blue
        bytes[3 * i + channel] = static_cast<unsigned char>(255 * std::max(0.0f, 1 - tint * dark));
      }
    }
    ground_light->SetInputData(picture);
  }

  /// 1 where something stands between the ground and `to_light`.
  GroundLight cast_shadows(const Eigen::Vector3d& to_light) {
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(0, 0, 0);
    for (std::size_t i = 0; i < actors.size(); ++i) {
      if (is_ground(scene.instances[i])) continue;
      vtkNew<vtkPolyDataMapper> mapper;
      mapper->SetInputData(meshes.at(scene.instances[i].mesh));
      mapper->ScalarVisibilityOff();
      vtkNew<vtkActor> shadow;
      shadow->SetMapper(mapper);
      shadow->GetProperty()->LightingOff();
      shadow->GetProperty()->SetColor(1, 1, 1);
      const Eigen::Matrix4d T = T_world_mesh(scene.instances[i]).matrix();
      const double* const box = meshes.at(scene.instances[i].mesh)->GetBounds();
      const Eigen::Vector4d middle(0.5 * (box[0] + box[1]), 0.5 * (box[2] + box[3]), 0.5 * (box[4] + box[5]), 1);
      const Eigen::Vector2d at = (T * middle).head<2>();
      Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
      const double height_m = scene.ground ? scene.ground->height_m(at.x(), at.y(), &gradient) : ground_z_m + 0.25;
      shadow->SetUserMatrix(to_vtk(project_onto(to_light, at, height_m, gradient) * T));
      renderer->AddActor(shadow);
    }
    look_from_above(renderer, {light_min, light_min.array() + light_size_m, kShadowPixels, kShadowPixels});
    const Image mask = draw(renderer, kShadowPixels, kShadowPixels, /*supersampling=*/1);
    GroundLight light(kShadowPixels);
    for (int y = 0; y < kShadowPixels; ++y) {
      for (int x = 0; x < kShadowPixels; ++x) {
        const std::size_t from = std::size_t(kShadowPixels - 1 - y) * kShadowPixels + x;
        light.value[std::size_t(y) * kShadowPixels + x] = mask.rgb[3 * from] / 255.0f;
      }
    }
    return light;
  }

  double lowest_z_m() const {
    double lowest_m = std::numeric_limits<double>::infinity();
    for (const auto& instance : scene.instances) {
      if (instance.actor >= 0) continue;
      for (const auto& vertex : scene.meshes.at(instance.mesh).vertices) {
        lowest_m = std::min(lowest_m, (instance.T_parent_mesh * vertex.cast<double>()).z());
      }
    }
    return std::isfinite(lowest_m) ? lowest_m : 0;
  }

  vtkSmartPointer<vtkRenderer> new_renderer(bool night) const {
    vtkNew<vtkRenderer> renderer;
    const Rgb low = night ? kNight : kSkyHorizon, high = night ? kNight : kSkyTop;
    renderer->SetBackground(low.x(), low.y(), low.z());
    renderer->SetBackground2(high.x(), high.y(), high.z());
    renderer->SetGradientBackground(!night);
    renderer->RemoveAllLights();
    renderer->AutomaticLightCreationOff();
    add_light(renderer, kSun, {1.0f, 0.97f, 0.92f}, 1.0);
    add_light(renderer, {0.8, -0.5, 0.35}, {0.80f, 0.88f, 1.0f}, 0.34);  // the sky, for sides that the sun does not see
    const Rgb near_color = night ? kNightGround : kDayGround;
    const vtkSmartPointer<vtkActor> ground = actor_of(far_ground(center, near_color, low));
    ground->GetProperty()->LightingOff();
    renderer->AddActor(ground);
    for (const auto& actor : actors) {
      actor->GetMapper()->SelectColorArray(night ? "night" : "day");
      renderer->AddActor(actor);
    }
    return renderer.Get();
  }

  static void add_light(vtkRenderer* renderer, const Eigen::Vector3d& from, const Rgb& color, double intensity) {
    vtkNew<vtkLight> light;
    light->SetLightTypeToSceneLight();
    light->SetPositional(false);
    light->SetPosition(from.x(), from.y(), from.z());
    light->SetFocalPoint(0, 0, 0);
    light->SetColor(color.x(), color.y(), color.z());
    light->SetIntensity(intensity);
    renderer->AddLight(light);
  }

  void look_from_above(vtkRenderer* renderer, const TopView& view) {
    vtkCamera* const camera = renderer->GetActiveCamera();
    const Eigen::Vector2d middle = 0.5 * (view.min_m + view.max_m);
    camera->ParallelProjectionOn();
    camera->SetParallelScale(0.5 * (view.max_m.y() - view.min_m.y()));
    camera->SetFocalPoint(middle.x(), middle.y(), ground_z_m);
    camera->SetPosition(middle.x(), middle.y(), ground_z_m + 200);
    camera->SetViewUp(0, 1, 0);
    camera->SetClippingRange(20, 230);
  }

  /// What the bird's view must hold, from the centre: the rectangle of interest without its near corner, which is empty
  /// ground in the foreground, and without its outermost sides.
  std::vector<Eigen::Vector3d> framed_corners() const {
    const Eigen::Vector2d half = 0.5 * (scene.interest_max - scene.interest_min);
    const double x = kFramedWidth * half.x(), y = half.y();
    std::vector<Eigen::Vector3d> corners;
    for (const double z : {0.0, kTallest_m}) {
      corners.insert(corners.end(), {{-x, y, z}, {x, y, z}, {x, -y, z}, {-x, 0, z}, {0, -y, z}});
    }
    return corners;
  }

  /// As near as the framed corners allow.
  void look_as_bird(vtkRenderer* renderer, double aspect) {
    const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(kBirdDirection).normalized();
    const Eigen::Vector3d up = kBirdDirection.cross(right);
    const double tan_y = std::tan(0.5 * kFieldOfView_deg * M_PI / 180), tan_x = tan_y * aspect;
    // An eye at focus + s * direction sees a corner c when |right·c| <= tan_x (s - direction·c), and so for up. Sides
    // are handled apart: the focus is moved until left and right, top and bottom need the same distance.
    double right_m = 0, left_m = 0, top_m = 0, bottom_m = 0;
    for (const Eigen::Vector3d& corner : framed_corners()) {
      const double depth_m = kBirdDirection.dot(corner);
      right_m = std::max(right_m, depth_m + right.dot(corner) / tan_x);
      left_m = std::max(left_m, depth_m - right.dot(corner) / tan_x);
      top_m = std::max(top_m, depth_m + up.dot(corner) / tan_y);
      bottom_m = std::max(bottom_m, depth_m - up.dot(corner) / tan_y);
    }
    const Eigen::Vector3d focus =
        center + 0.5 * tan_x * (right_m - left_m) * right + 0.5 * tan_y * (top_m - bottom_m) * up;
    const double distance_m = 0.5 * std::max(right_m + left_m, top_m + bottom_m);
    vtkCamera* const camera = renderer->GetActiveCamera();
    camera->ParallelProjectionOff();
    camera->SetViewAngle(kFieldOfView_deg);
    camera->SetFocalPoint(focus.x(), focus.y(), focus.z());
    const Eigen::Vector3d eye = focus + distance_m * kBirdDirection;
    camera->SetPosition(eye.x(), eye.y(), eye.z());
    camera->SetViewUp(0, 0, 1);
    camera->SetClippingRange(0.1 * distance_m, distance_m + kGroundRadius_m);
  }

  Image draw(vtkRenderer* renderer, int width_px, int height_px, int supersampling = kSupersampling) {
    const int width = width_px * supersampling, height = height_px * supersampling;
    gl.make_current();
    window->SetSize(width, height);
    window->AddRenderer(renderer);
    window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    window->GetPixelData(0, 0, width - 1, height - 1, /*front=*/0, pixels.Get(), /*right=*/0);
    Image image = reduce(pixels->GetPointer(0), width, height, supersampling);
    renderer->ReleaseGraphicsResources(window);
    window->RemoveRenderer(renderer);
    return image;
  }

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
  state_->look_as_bird(renderer, double(width_px) / height_px);
  return state_->draw(renderer, width_px, height_px);
}

Image Stills::top(const TopView& view) {
  const vtkSmartPointer<vtkRenderer> renderer = state_->new_renderer(/*night=*/false);
  state_->look_from_above(renderer, view);
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
  state_->look_as_bird(renderer, double(width_px) / height_px);
  return state_->draw(renderer, width_px, height_px);
}

}  // namespace tarmac::reports
