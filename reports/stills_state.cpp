#include "reports/stills_state.h"

#include <fmt/format.h>
#include <vtkAutoInit.h>
#include <vtkCallbackCommand.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "reports/stills_cameras.h"

VTK_MODULE_INIT(vtkRenderingOpenGL2)

namespace tarmac::reports {

namespace {

// The light of a bright, slightly hazy day, and a night version of it under the coloured maps.
const Rgb kSkyTop{0.60f, 0.72f, 0.83f}, kSkyHorizon{0.90f, 0.92f, 0.92f};
const Rgb kDayGround{0.66f, 0.68f, 0.63f}, kNightGround{0.085f, 0.10f, 0.115f};
const Rgb kNight{0.055f, 0.066f, 0.078f};
const Eigen::Vector3d kSun = Eigen::Vector3d(-0.62, -0.55, 0.80).normalized();  ///< from the scene to the sun
constexpr int kShadowPixels = 2048;

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

double distance_to_triangle_m(const Eigen::Vector3d& p, const Eigen::Vector3d (&corners)[3]) {
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  bool above = normal.squaredNorm() > 0;
  double nearest2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d &from = corners[k], edge = corners[(k + 1) % 3] - from;
    above = above && normal.cross(edge).dot(p - from) >= 0;
    const double share = std::clamp(edge.dot(p - from) / std::max(edge.squaredNorm(), 1e-12), 0.0, 1.0);
    nearest2 = std::min(nearest2, (from + share * edge - p).squaredNorm());
  }
  return above ? std::abs(normal.normalized().dot(p - corners[0])) : std::sqrt(nearest2);
}

}  // namespace

Stills::State::State(const scenes::Scene& scene_in, const std::string& egl_library) : scene(scene_in), gl(egl_library) {
  keep_quiet_about_glew();
  connect(window);
  window->SetMapped(1);
  window->SetIsDirect(1);
  window->SetOwnContext(0);
  window->SetMultiSamples(0);
  window->InitializeFromCurrentContext();
}

void Stills::State::connect(vtkGenericOpenGLRenderWindow* target) {
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

void Stills::State::build() {
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

bool Stills::State::is_ground(const scenes::Instance& instance) {
  return instance.label == scenes::Label::pavement || instance.label == scenes::Label::marking ||
         instance.label == scenes::Label::terrain;
}

bool Stills::State::is_shown(const scenes::Instance& instance) const {
  return !scene.meshes.at(instance.mesh).name.ends_with("ceiling");
}

vtkSmartPointer<vtkActor> Stills::State::instance_actor(const scenes::Instance& instance) {
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

void Stills::State::add_ground_coordinates(vtkPolyData* data, const core::SE3& T_world_mesh) const {
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetNumberOfComponents(2);
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    const Eigen::Vector3d p_world = T_world_mesh * Eigen::Map<const Eigen::Vector3d>(data->GetPoint(i));
    const Eigen::Vector2d uv = (p_world.head<2>() - light_min) / light_size_m;
    coordinates->InsertNextTuple2(uv.x(), uv.y());
  }
  data->GetPointData()->SetTCoords(coordinates);
}

core::SE3 Stills::State::T_world_mesh(const scenes::Instance& instance) const {
  if (instance.actor < 0) return instance.T_parent_mesh;
  return scene.actors.at(instance.actor).motion->T_world_actor(time) * instance.T_parent_mesh;
}

void Stills::State::place(core::Time t) {
  if (placed && t == time) return;
  placed = true;
  time = t;
  for (std::size_t i = 0; i < actors.size(); ++i) {
    actors[i]->SetUserMatrix(to_vtk(T_world_mesh(scene.instances[i]).matrix()));
  }
  paint_ground_light();
}

void Stills::State::paint_ground_light() {
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

GroundLight Stills::State::cast_shadows(const Eigen::Vector3d& to_light) {
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(0, 0, 0);
  for (std::size_t i = 0; i < actors.size(); ++i) {
    if (is_ground(scene.instances[i]) || !is_shown(scene.instances[i])) continue;
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
  look_from_above(renderer, {light_min, light_min.array() + light_size_m, kShadowPixels, kShadowPixels}, ground_z_m);
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

double Stills::State::lowest_z_m() const {
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const auto& instance : scene.instances) {
    if (instance.actor >= 0) continue;
    for (const auto& vertex : scene.meshes.at(instance.mesh).vertices) {
      lowest_m = std::min(lowest_m, (instance.T_parent_mesh * vertex.cast<double>()).z());
    }
  }
  return std::isfinite(lowest_m) ? lowest_m : 0;
}

double Stills::State::distance_m(const Eigen::Vector3d& p_world) const {
  double nearest_m = 1e3;
  for (const scenes::Instance& instance : scene.instances) {
    const scenes::Mesh& mesh = scene.meshes.at(instance.mesh);
    const Eigen::Vector3d p = T_world_mesh(instance).inverse() * p_world;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Eigen::Vector3d corners[3] = {mesh.vertices[a].cast<double>(), mesh.vertices[b].cast<double>(),
                                          mesh.vertices[c].cast<double>()};
      nearest_m = std::min(nearest_m, distance_to_triangle_m(p, corners));
    }
  }
  return nearest_m;
}

vtkSmartPointer<vtkRenderer> Stills::State::new_renderer(bool night, bool with_ceilings) const {
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
  for (std::size_t i = 0; i < actors.size(); ++i) {
    if (!with_ceilings && !is_shown(scene.instances[i])) continue;
    actors[i]->GetMapper()->SelectColorArray(night ? "night" : "day");
    renderer->AddActor(actors[i]);
  }
  return renderer.Get();
}

vtkSmartPointer<vtkRenderer> Stills::State::new_silhouette_renderer() const {
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  for (std::size_t i = 0; i < actors.size(); ++i) {
    if (is_ground(scene.instances[i]) || !is_shown(scene.instances[i])) continue;
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(meshes.at(scene.instances[i].mesh));
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> outline;
    outline->SetMapper(mapper);
    outline->GetProperty()->LightingOff();
    outline->GetProperty()->SetColor(0.16, 0.22, 0.30);
    outline->SetUserMatrix(to_vtk(T_world_mesh(scene.instances[i]).matrix()));
    renderer->AddActor(outline);
  }
  return renderer.Get();
}

void Stills::State::add_light(vtkRenderer* renderer, const Eigen::Vector3d& from, const Rgb& color, double intensity) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToSceneLight();
  light->SetPositional(false);
  light->SetPosition(from.x(), from.y(), from.z());
  light->SetFocalPoint(0, 0, 0);
  light->SetColor(color.x(), color.y(), color.z());
  light->SetIntensity(intensity);
  renderer->AddLight(light);
}

Image Stills::State::draw(vtkRenderer* renderer, int width_px, int height_px, int supersampling) {
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

}  // namespace tarmac::reports
