/// From rays to the echoes of beams: footprints, panes, the own vehicle, light beside its beam.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sim/lidar/aim.h"
#include "sim/lidar/beam_field.h"
#include "sim/lidar/beam_options.h"
#include "sim/lidar/effects/echoes.h"
#include "sim/lidar/footprint.h"
#include "sim/lidar/glass.h"
#include "sim/lidar/own_body.h"
#include "sim/raycast/relief.h"

namespace tarmac::sim::lidar {

/// How a sweep is cut for tracing.
struct Batches {
  std::size_t cycles = 1;            ///< in a whole one
  std::vector<std::uint32_t> tiles;  ///< of a whole one
};

/// Arrays of a sweep and of one batch, kept from sweep to sweep.
struct BeamWorkspace {
  CentreField centre;
  EchoField echoes;
  std::vector<std::uint8_t> open;  ///< sides on which a beam's outer rays are traced
  std::size_t traced_rays = 0;     ///< in the last sweep: centres, outer rays, and those beyond panes
  std::size_t split_beams = 0;     ///< beams of which outer rays were traced

  // Of one batch.
  AimedCycles aimed, body_aimed;
  raycast::Rays rays, body_rays, outer;
  raycast::Hits hits;
  std::vector<double> dx, dy, dz;     // of one of the footprint's rays, over all beams
  std::vector<double> t_m;            // one after the other
  std::vector<float> cosine, signal;  // so too; the centre's first
  std::vector<double> moment, sum;    // of a beam's rays that are not traced
  std::vector<float> outer_signal;
  std::size_t first_channel = 0, last_channel = 0;  // that met something; the end is one beyond
  std::vector<std::uint32_t> rough, on_relief;      // beams that met relief, and those whose rays are put on it
  std::vector<std::uint32_t> split;                 // beams of which rays are traced
  std::vector<std::uint32_t> mixed;                 // those of them whose parts are told apart
  std::vector<std::uint32_t> outer_end;             // of each of them: where its rays that are traced end, in `outer`
  std::vector<std::uint16_t> outer_ray;             // their numbers in the footprint
  std::vector<std::uint32_t> order;
  raycast::ReliefBatch relief;
  PaneRays panes;
  std::vector<std::vector<Part>> parts;
  std::vector<PartOfBeam> found;
  std::vector<Echo> train;
  std::vector<OwnBody::Hit> self;
  std::vector<std::uint8_t> blocked;
};

class BeamModel {
 public:
  BeamModel(const Profile& profile, const FiringTable& firing, const Aim& aim, const BeamOptions& options,
            std::shared_ptr<const OwnBody> body, std::shared_ptr<const scenes::Scene> scene);

  /// What the beams of a sweep bring back, whether the receiver notices or not. Adds the tracer's time to trace_cpu_s.
  void echoes(const FiringTable& firing, const Aim& aim, const SweepSpan& span, const SweepMotion& motion,
              const raycast::SweepTracer& tracer, const Batches& batches, BeamWorkspace& w, double& trace_cpu_s) const;

 private:
  void prepare_outer(std::size_t first, BeamWorkspace& w) const;
  template <class Work>
  void for_met(const BeamWorkspace& w, const Work& work) const;
  void find_split(std::size_t first, BeamWorkspace& w) const;
  void place_outer(const Aim& aim, std::size_t first, const Eigen::Vector3d& base, BeamWorkspace& w) const;
  void point_outer(const Aim& aim, std::size_t k, BeamWorkspace& w) const;
  void meet_relief(std::size_t k, std::size_t first, const Eigen::Vector3d& base, BeamWorkspace& w) const;
  void queue_outer(std::size_t k, std::size_t first, BeamWorkspace& w) const;
  void put_whole(std::size_t first, BeamWorkspace& w) const;
  void add_split(const raycast::SweepTracer& tracer, std::size_t first, BeamWorkspace& w, double& trace_cpu_s) const;
  void trace_outer(const raycast::SweepTracer& tracer, BeamWorkspace& w, double& trace_cpu_s) const;
  bool put_if_one(std::size_t i, std::size_t begin, std::size_t end, std::size_t first, BeamWorkspace& w) const;
  void add_parts(std::size_t i, std::size_t begin, std::size_t end, std::size_t first, BeamWorkspace& w) const;
  void put_mean(std::size_t firing, double sum, double moment, BeamWorkspace& w) const;
  /// A hit of rays[index]; `part` has the signal of a whole beam.
  void add_part(BeamWorkspace& w, std::size_t beam, Part part, std::uint16_t material, const raycast::Rays& rays,
                std::size_t index) const;
  void meet_own_body(const FiringTable& firing, const Aim& aim, const SweepSpan& span, const SweepMotion& motion,
                     std::int64_t first_cycle, std::size_t first, BeamWorkspace& w) const;
  void put_strongest(std::size_t firing, BeamWorkspace& w) const;
  void add_halos(BeamWorkspace& w) const;
  void merge_halos(std::vector<EchoField::Other>& halos, BeamWorkspace& w) const;

  BeamOptions options_;
  Footprint footprint_;
  std::vector<BeamTable> outer_;     // of the channels, where they do not change
  std::vector<std::uint8_t> sides_;  // of the centre that each of them lies on
  bool adaptive_;
  double separation_m_;
  Reflectance reflectance_;
  Glass glass_;
  Detection detection_;  // for what is strongest
  std::shared_ptr<const OwnBody> body_;
  std::shared_ptr<const scenes::Scene> scene_;
  std::vector<std::uint8_t> relief_material_, pane_material_;
  Neighbours neighbours_;
  std::vector<std::vector<Beside>> beside_;
  double range_offset_m_;
  std::size_t channels_, split_cycles_;
};

}  // namespace tarmac::sim::lidar
