#include <fmt/format.h>

#include <iterator>

#include "metrics/degeneracy/degeneracy.h"

namespace tarmac::metrics {

namespace {

void append_names(const char* prefix, int n, std::string& text) {
  for (int k = 1; k <= n; ++k) fmt::format_to(std::back_inserter(text), ",{}_{}", prefix, k);
}

void append_header(std::string& text) {
  text += "source,sweep,t_s,rows,class_6dof,class_12dof,condition_6dof,condition_12dof";
  append_names("lambda_6dof", 6, text);
  append_names("lambda_12dof", 12, text);
  append_names("lambda_12dof_mean", 6, text);
  append_names("lambda_12dof_difference", 6, text);
  for (const char* name : kDirectionNames) fmt::format_to(std::back_inserter(text), ",weak_6dof_{}", name);
  for (const char* name : kDirectionNames) fmt::format_to(std::back_inserter(text), ",weak_difference_{}", name);
  text += "\n";
}

/// Empty fields where there is no spectrum.
void append_values(const std::optional<Spectrum>& spectrum, int n, std::string& text) {
  for (int k = 0; k < n; ++k) {
    text += ',';
    if (spectrum) fmt::format_to(std::back_inserter(text), "{:.6g}", spectrum->values[k]);
  }
}

void append_shares(const std::optional<Spectrum>& spectrum, double limit, std::string& text) {
  const core::Vector6 shares = spectrum ? weak_shares(*spectrum, limit) : core::Vector6::Zero();
  for (int k = 0; k < 6; ++k) {
    text += ',';
    if (spectrum) fmt::format_to(std::back_inserter(text), "{:.4f}", shares[k]);
  }
}

void append_condition(const std::optional<Spectrum>& spectrum, std::string& text) {
  text += ',';
  if (spectrum) fmt::format_to(std::back_inserter(text), "{:.6g}", spectrum->condition());
}

void append_line(const char* source, const SweepVerdict& v, std::string& text) {
  fmt::format_to(std::back_inserter(text), "{},{},{:.9f},{},{},{}", source, v.index, v.t_s, v.rows, name_of(v.pose),
                 name_of(v.difference));
  const auto of = [&v](std::optional<Spectrum> BlockAnalysis::*member) {
    return v.blocks ? (*v.blocks).*member : std::optional<Spectrum>();
  };
  const std::optional<Spectrum> pose = v.blocks ? std::optional(v.blocks->pose) : std::nullopt;
  append_condition(pose, text);
  append_condition(of(&BlockAnalysis::two_pose), text);
  append_values(pose, 6, text);
  append_values(of(&BlockAnalysis::two_pose), 12, text);
  append_values(of(&BlockAnalysis::mean), 6, text);
  append_values(of(&BlockAnalysis::difference), 6, text);
  append_shares(pose, kOracleDegenerateBelow, text);
  append_shares(of(&BlockAnalysis::difference), kOracleShearDegenerateBelow, text);
  text += "\n";
}

}  // namespace

std::string to_csv(const DegeneracyReport& report) {
  std::string text;
  append_header(text);
  for (const SweepVerdict& v : report.oracle) append_line("oracle", v, text);
  for (const SweepVerdict& v : report.solve) append_line("solve", v, text);
  if (!report.solves_with_surface)
    for (const SweepVerdict& v : report.surface) append_line("surface", v, text);
  return text;
}

}  // namespace tarmac::metrics
