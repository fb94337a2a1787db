/// The program's commands. Each returns an exit code (0 success, 3 some runs failed or are missing) and throws
/// InputError (2).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tarmac::tools {

struct CommonArguments {
  bool quiet = false;
  bool json = false;
  int jobs = 0;                    ///< threads; 0 = all cores
  std::vector<std::string> words;  ///< the command line as given, for provenance
  int threads() const;
};

struct ScenarioArguments {
  std::string scenario;
  std::string out;
  std::string seeds;  ///< "" = the scenario's own
  std::vector<std::string> sets;
  std::string config;  ///< file with an `estimators:` block
  std::string estimators = "all";
  std::string diagnostics = "full";
  std::string estimator_program;  ///< another build's tarmac-estimate; empty = this one's
  bool fast = false;
  bool force = false;        ///< simulate although the disk seems to have too little room
  bool point_truth = false;  ///< simulate only
};
int run_command(const ScenarioArguments& arguments, const CommonArguments& common);
int simulate_command(const ScenarioArguments& arguments, const CommonArguments& common);

struct EstimateArguments {
  std::string recording;  ///< a run's folder, a recording folder, or a plain folder
  std::string out;
  std::string estimators = "all";
  std::string config;
  std::vector<std::string> sets;  ///< "kiss-icp.voxel_size_m=0.5"
  std::string diagnostics = "full";
};
int estimate_command(const EstimateArguments& arguments, const CommonArguments& common);

struct EvaluateArguments {
  std::vector<std::string> folders;
  std::string truth, estimate;  ///< the other form: two trajectory files
  std::string align;            ///< of the two files; "" = se3
};
int evaluate_command(const EvaluateArguments& arguments, const CommonArguments& common);

struct ReportArguments {
  std::vector<std::string> folders;
  std::string out;
};
int report_command(const ReportArguments& arguments, const CommonArguments& common);

struct SweepArguments {
  std::string sweep;
  std::string out;
  std::vector<std::string> sets;
  std::string config;
  std::string shard;  ///< "i/n"; empty = all
  std::string cache;  ///< empty = DIR/recordings
  double cache_limit_gb = 20;
  std::string estimator_program;
  bool resume = false, rerun_failed = false, dry_run = false, fast = false;
};
int sweep_command(const SweepArguments& arguments, const CommonArguments& common);
struct CompareArguments {
  std::vector<std::string> folders;  ///< A and B; one alone: two estimators of it
  std::string out, markdown;         ///< page and Markdown; "" = none
  std::string a, b;                  ///< estimators
  std::vector<std::string> metrics;
  std::string case_name;
};
/// In tools/compare.
int compare_command(const CompareArguments& arguments, const CommonArguments& common);

int list_command(const std::string& kind, const CommonArguments& common);
struct DescribeArguments {
  std::string kind, name, picture;
  std::string eye, look_at;  ///< "x,y,z" [m]: where the picture is seen from; "" = the view of the kind
};
int describe_command(const DescribeArguments& arguments, const CommonArguments& common);

struct TransferArguments {
  std::string format;  ///< plain | kitti | tum; export: or exr
  std::string from, to;
  std::string estimator;  ///< export tum: which; "" = truth
  // Of export exr:
  std::int64_t sweep = -1;  ///< index; -1 = all
  int lidar = 0;
  bool no_truth = false;
};
int import_command(const TransferArguments& arguments, const CommonArguments& common);
int export_command(const TransferArguments& arguments, const CommonArguments& common);

struct TableArguments {
  std::string folder;
  std::vector<std::string> by = {"case", "estimator"};
  std::vector<std::string> metrics;  ///< empty: the headline ones
  std::vector<std::string> scenarios, cases, estimators, statuses;
  std::string seeds;               ///< "" = all
  std::vector<std::string> where;  ///< "motion.peak=3"
  std::string sort;                ///< a column's name
  bool reverse = false;
  bool cells = false;  ///< one line a cell
  bool dump = false;
  std::string csv;  ///< a file, or - for standard output
};
int table_command(const TableArguments& arguments, const CommonArguments& common);
struct QueryArguments {
  std::string folder, sql, csv;
};
int query_command(const QueryArguments& arguments, const CommonArguments& common);
struct MergeArguments {
  std::vector<std::string> folders;
  std::string out;
};
int merge_command(const MergeArguments& arguments, const CommonArguments& common);

struct GateArguments {
  std::string folder;  ///< a sweep's
  std::string gate;    ///< file, or its name
  std::string junit, markdown;
  std::string link;  ///< what the Markdown points to for more
};
/// Returns 1 when a row failed.
int gate_command(const GateArguments& arguments, const CommonArguments& common);
struct BaselineArguments {
  std::vector<std::string> folders;
  std::string out;
  std::string gate;  ///< whose metrics to keep; "" = the headline metrics
  bool allow_incomplete = false;
};
int baseline_update_command(const BaselineArguments& arguments, const CommonArguments& common);

struct BenchArguments {
  std::vector<std::string> benches;  ///< sim, estimators, metrics, store, trajectories, window; empty = all
};
/// In tools/bench.
int bench_command(const BenchArguments& arguments, const CommonArguments& common);

}  // namespace tarmac::tools
