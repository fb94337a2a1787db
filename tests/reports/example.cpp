#include "tests/reports/example.h"

#include <cmath>
#include <limits>

namespace tarmac::reports::example {

namespace {

constexpr int kSweeps = 40;

metrics::Row row(const std::string& metric, const std::string& unit, double value) {
  metrics::Row out;
  out.metric = metric;
  out.unit = unit;
  out.value = value;
  return out;
}

metrics::Row missing(const std::string& metric, const std::string& status) {
  metrics::Row out;
  out.metric = metric;
  out.status = status;
  return out;
}

template <class Function>
metrics::Series series(const std::string& name, const std::string& x_label, const std::string& y_label, int count,
                       const Function& xy) {
  metrics::Series out{name, x_label, y_label, {}, {}, {}, {}};
  for (int k = 0; k < count; ++k) {
    const auto [x, y] = xy(k);
    out.x.push_back(x);
    out.y.push_back(y);
  }
  return out;
}

using Pair = std::pair<double, double>;

std::vector<metrics::Series> all_series(double size) {
  std::vector<metrics::Series> list;
  list.push_back(series("path_true", "x [m]", "y [m]", kSweeps, [](int k) { return Pair(0.5 * k - 10, -12); }));
  list.push_back(series("path_estimate", "x [m]", "y [m]", kSweeps,
                        [&](int k) { return k < 2 ? Pair(NAN, NAN) : Pair(0.5 * k - 10, -12 + 0.01 * size * k); }));
  for (const char* name : {"error_vs_distance", "drift_vs_distance"}) {
    list.push_back(series(name, "distance [m]", "error [m]", 20, [&](int k) { return Pair(k, size * k); }));
  }
  for (const char* name : {"reference_error_by_phase", "deskew_error_by_phase"}) {
    list.push_back(series(name, "phase", "error [m]", 8, [&](int k) { return Pair((k + 0.5) / 8, size); }));
    list.back().low.assign(8, 0.5 * size);
    list.back().high.assign(8, 2 * size);
  }
  for (const char* name :
       {"deskew_error_vs_time", "sweep_time_vs_time", "iterations_vs_time", "speed_vs_time", "yaw_rate_vs_time"}) {
    list.push_back(series(name, "time [s]", "value [m]", kSweeps, [&](int k) { return Pair(0.1 * k, size + k); }));
  }
  return list;
}

/// Straight on at constant velocity.
class Drive final : public scenes::ActorMotion {
 public:
  core::SE3 T_world_actor(core::Time t) const override {
    core::SE3 T = core::SE3::Identity();
    T.translation() << kCartAtZero.x() + 2 * core::to_s(t), kCartAtZero.y(), 0;
    return T;
  }
  double acceleration_bound_m_s2(core::Time, core::Time, double) const override { return 0; }
};

scenes::Mesh box(const std::string& name, const Eigen::Vector3f& min_m, const Eigen::Vector3f& max_m,
                 std::uint16_t material) {
  scenes::Mesh mesh;
  mesh.name = name;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.emplace_back(k & 1 ? max_m.x() : min_m.x(), k & 2 ? max_m.y() : min_m.y(),
                               k & 4 ? max_m.z() : min_m.z());
  }
  const std::uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  mesh.materials.assign(mesh.triangles.size(), material);
  return mesh;
}

scenes::Material material(const std::string& name, const Eigen::Vector3f& color) {
  scenes::Material out;
  out.name = name;
  out.color = color;
  return out;
}

}  // namespace

metrics::Evaluation evaluation(const std::string& estimator, std::uint64_t seed, double end_error_percent) {
  metrics::Evaluation out;
  out.scenario = "example";
  out.seed = seed;
  out.estimator = estimator;
  out.coverage = 0.95;
  out.rows = {row("end_error_percent", "%", end_error_percent),
              row("ate_se3_rmse_m", "m", 0.1 * end_error_percent),
              row("deskew_error_rms_m", "m", 0.02),
              row("sweep_time_p50_ms", "ms", 31),
              row("coverage_percent", "%", 95),
              missing("ate_none_rmse_m", "n/a: no initial pose is given")};
  out.series = all_series(0.01 * end_error_percent);
  return out;
}

metrics::Evaluation failed(const std::string& estimator, std::uint64_t seed, const std::string& status,
                           const std::string& message) {
  metrics::Evaluation out;
  out.scenario = "example";
  out.seed = seed;
  out.estimator = estimator;
  out.status = status;
  out.message = message;
  out.rows = {missing("end_error_percent", "failed: " + status)};
  return out;
}

ReportInput input() {
  ReportInput out;
  out.title = "example";
  out.why = "to see the page";
  out.surprise = "an empty page";
  for (std::uint64_t seed : {1, 2}) {
    ReportRun run;
    run.folder = "out/seed-" + std::to_string(seed);
    run.provenance_json = R"({"command": "tarmac run example.yaml --seed 1..2", "recording_hash": "0123456789abcdef"})";
    run.evaluations.push_back(evaluation("steady", seed, 0.2 + 0.01 * static_cast<double>(seed)));
    run.evaluations.push_back(seed == 1 ? evaluation("shaky", seed, 0.9)
                                        : failed("shaky", seed, "crashed", "signal 11 after sweep 7"));
    out.runs.push_back(run);
  }
  return out;
}

scenes::Scene scene() {
  scenes::Scene out;
  out.name = "example";
  out.materials = {material("apron", {0.6f, 0.6f, 0.6f}), material("block", {0.9f, 0.1f, 0.1f}),
                   material("cart", {0.1f, 0.1f, 0.9f})};
  out.meshes = {box("apron", {-20, -20, -0.3f}, {20, 20, 0}, 0), box("block", {-2, -1, 0}, {2, 1, 3}, 1),
                box("cart", {-1.5f, -1, 0.2f}, {1.5f, 1, 1.5f}, 2)};
  scenes::Instance apron, block, cart;
  apron.label = scenes::Label::pavement;
  block.mesh = 1;
  block.T_parent_mesh.translation() << kBlock.x(), kBlock.y(), 0;
  cart.mesh = 2;
  cart.actor = 0;
  out.instances = {apron, block, cart};
  out.actors = {{"cart", std::make_shared<Drive>(), 2.5}};
  out.interest_min = {-20, -20};
  out.interest_max = {20, 20};
  return out;
}

}  // namespace tarmac::reports::example
