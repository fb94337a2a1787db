/// From the echoes of beams to the returns that a sensor reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/lidar/beam_field.h"
#include "sim/lidar/beam_options.h"
#include "sim/lidar/effects/echoes.h"
#include "sim/lidar/firing.h"

namespace tarmac::sim::lidar {

struct NoiseOptions {
  double range_scale = 1;
  double channel_bias_scale = 1;
  bool quantisation = true;
  bool dropout = true;
  bool intensity = true;
  void visit(core::OptionVisitor& v);
};

/// Returns as arrays.
struct Returns {
  Echoes echoes;
  std::vector<std::uint32_t> firing;  ///< in the batch, of the second ones; empty: one a firing, in their order
  std::vector<double> true_range_m;   ///< before bias, noise and rounding
  std::vector<ReturnKind> kind;
  std::vector<std::uint32_t> instance;
  std::vector<float> nx, ny, nz;
  std::size_t size() const { return kind.size(); }
  void resize(std::size_t n);
  void put(std::size_t i, const Echo& echo, double range_m);
};

/// Which of the echoes that were detected are points (`returns`):
///   strongest   the one of the highest signal over noise
///   first, last the nearest, the farthest
///   dual        the strongest, then the last one; where the strongest is the last, the second strongest
/// Of each echo it is drawn whether it is detected, with the firing's number and the echo's place in the order of
/// strength; the strongest one's draw is the one that it has without this.
class Receiver {
 public:
  Receiver(const Profile& profile, const FiringTable& firing, const NoiseOptions& noise, const BeamOptions& options,
           std::uint16_t sensor, std::uint64_t seed);

  /// Arrays between calls.
  struct Scratch {
    struct Candidate {
      std::uint32_t firing;
      double range_m, snr;
      Echo echo;
    };
    std::vector<Candidate> more, all;
    std::vector<float> draws;
  };
  /// The returns of `count` firings of the field from `first` on, which have the number `number` in the recording.
  void operator()(const EchoField& field, std::size_t first, std::size_t count, std::uint64_t number, Scratch& scratch,
                  Returns& firsts, Returns& seconds) const;
  bool reported(double range_m) const { return range_m >= min_range_m_ && range_m <= max_range_m_; }

 private:
  struct Noise {
    RangeNoise by_range;
    SnrNoise by_snr;
    Intensity intensity;
  };
  Noise noise_of(const Profile& profile, const char* name, std::uint16_t sensor, std::uint64_t seed) const;
  void take(const EchoField& field, std::size_t first, std::size_t count, std::uint64_t number, Returns& out) const;
  void find_more(const EchoField& field, std::size_t first, std::size_t count, std::uint64_t number,
                 Scratch& scratch) const;
  void add_false_alarms(std::size_t count, std::uint64_t number, Scratch& scratch) const;
  void choose(std::uint32_t firing, std::uint64_t number, std::vector<Scratch::Candidate>& candidates, Returns& firsts,
              Returns& seconds) const;
  void measure(const Noise& noise, Returns& returns) const;

  NoiseOptions noise_options_;
  BeamOptions options_;
  double min_range_m_, max_range_m_, range_step_m_, range_offset_m_;
  std::size_t channels_;
  Detection detection_;
  core::RandomStream other_detection_, false_alarms_;
  ChannelBias channel_bias_;
  Brightness brightness_;
  Noise first_, second_;
};

}  // namespace tarmac::sim::lidar
