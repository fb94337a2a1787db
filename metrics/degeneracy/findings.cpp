// Degenerate stretches in words.
#include <fmt/format.h>

#include <algorithm>

#include "metrics/degeneracy/degeneracy.h"
#include "metrics/degeneracy/detector.h"

namespace tarmac::metrics {

namespace {

constexpr const char* kTopic = "degeneracy";
constexpr std::size_t kMostStretches = 10;  // the longest are told

/// Verdicts [first, last).
struct Stretch {
  std::size_t first = 0, last = 0;
  std::size_t size() const { return last - first; }
};

std::vector<Stretch> stretches_of(const std::vector<SweepVerdict>& verdicts) {
  std::vector<Stretch> found;
  Stretch now;
  for (std::size_t i = 0; i <= verdicts.size(); ++i) {
    if (i < verdicts.size() && verdicts[i].pose == DegeneracyClass::degenerate) {
      now.last = i + 1;
      continue;
    }
    if (now.size() >= kEventSweeps) found.push_back(now);
    now = {i + 1, i + 1};
  }
  return found;
}

/// What is free over the stretch: the mean of the sweeps' shares.
std::string directions_of(const std::vector<SweepVerdict>& verdicts, const Stretch& stretch, double limit) {
  core::Vector6 shares = core::Vector6::Zero();
  for (std::size_t i = stretch.first; i < stretch.last; ++i) shares += weak_shares(verdicts[i].blocks->pose, limit);
  return weak_directions(shares / static_cast<double>(stretch.size()));
}

/// How many of the oracle's sweeps a method's source flags, in percent; none where the source says nothing.
Finding::Number flagged(const char* source, const std::vector<SweepVerdict>& oracle, const Stretch& stretch,
                        const std::vector<SweepVerdict>& method) {
  std::size_t known = 0, flags = 0;
  for (const SweepVerdict& v : method) {
    const bool inside = v.index >= oracle[stretch.first].index && v.index <= oracle[stretch.last - 1].index;
    if (!inside || v.pose == DegeneracyClass::unknown) continue;
    ++known;
    flags += v.pose == DegeneracyClass::degenerate;
  }
  Finding::Number number{fmt::format("flagged by the {} residuals", source), {}, "%", {}, {}};
  if (known) number.value = 100.0 * static_cast<double>(flags) / static_cast<double>(known);
  return number;
}

Finding::Number count(const char* name, std::size_t n) {
  return {name, static_cast<double>(n), "1", {}, {}};
}

std::string span_of(const std::vector<SweepVerdict>& verdicts, const Stretch& stretch) {
  return fmt::format("from {:.1f} s to {:.1f} s", verdicts[stretch.first].t_s, verdicts[stretch.last - 1].t_s);
}

/// The longest ones, in order of time.
std::vector<Stretch> longest(std::vector<Stretch> stretches) {
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const Stretch& a, const Stretch& b) { return a.size() > b.size(); });
  if (stretches.size() > kMostStretches) stretches.resize(kMostStretches);
  std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) { return a.first < b.first; });
  return stretches;
}

std::vector<Finding> by_oracle(const DegeneracyReport& report) {
  const std::vector<Stretch> all = stretches_of(report.oracle);
  if (all.empty())
    return {{kTopic,
             Finding::Verdict::nothing_found,
             fmt::format("The geometry holds every direction: by exact normals no {} sweeps in a row are degenerate.",
                         kEventSweeps),
             {}}};
  std::vector<Finding> findings;
  for (const Stretch& stretch : longest(all)) {
    Finding finding{
        kTopic,
        Finding::Verdict::found,
        fmt::format("By exact normals the geometry does not hold {} {}.",
                    directions_of(report.oracle, stretch, kOracleDegenerateBelow), span_of(report.oracle, stretch)),
        {count("sweeps", stretch.size()), count("stretches in all", all.size())}};
    finding.evidence.push_back(flagged("solve", report.oracle, stretch, report.solve));
    if (!report.solves_with_surface)
      finding.evidence.push_back(flagged("surface", report.oracle, stretch, report.surface));
    findings.push_back(std::move(finding));
  }
  return findings;
}

std::vector<Finding> by_method(const std::vector<SweepVerdict>& surface, double limit) {
  const std::vector<Stretch> all = stretches_of(surface);
  std::vector<Finding> findings;
  for (const Stretch& stretch : longest(all))
    findings.push_back({kTopic,
                        Finding::Verdict::found,
                        fmt::format("The method's own surface residuals do not hold {} {}; there is no truth to check "
                                    "that by.",
                                    directions_of(surface, stretch, limit), span_of(surface, stretch)),
                        {count("sweeps", stretch.size()), count("stretches in all", all.size())}});
  if (findings.empty())
    findings.push_back({kTopic,
                        Finding::Verdict::nothing_found,
                        fmt::format("By the method's own surface residuals no {} sweeps in a row are degenerate; there "
                                    "is no truth to check that by.",
                                    kEventSweeps),
                        {}});
  return findings;
}

bool any_known(const std::vector<SweepVerdict>& verdicts) {
  return std::any_of(verdicts.begin(), verdicts.end(), [](const SweepVerdict& v) { return v.blocks.has_value(); });
}

}  // namespace

std::vector<Finding> findings_of(const DegeneracyReport& report) {
  if (any_known(report.oracle)) return by_oracle(report);
  if (any_known(report.surface)) return by_method(report.surface, report.method_threshold);
  return {{kTopic,
           Finding::Verdict::cannot_be_told,
           "There is no truth, and the method recorded no point-to-surface residuals.",
           {}}};
}

}  // namespace tarmac::metrics
