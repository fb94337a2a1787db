// The program from outside: what it writes, what it says, how it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "core/estimate.h"
#include "core/files.h"
#include "core/recording.h"
#include "tools/tarmac/child.h"

namespace tarmac::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// Five seconds of a 16-beam sensor: enough for every file, quick enough for many runs.
constexpr const char* kScenario = R"(name: short-drive
why: the program's own tests
surprise: any failure
duration_s: 5
scene: {kind: stand}
motion:
  kind: drive
  rest_s: 1.5
  start: {x_m: -60, y_m: -30}
  path: [{straight_m: 60}]
  speed: [{to_m_s: 4, peak_m_s2: 2.5}]
rig:
  lidar: {model: vlp-16, T_body_lidar: {xyz_m: [1.2, 0, 1.9]}}
  imu: {model: adis16470, T_body_imu: {xyz_m: [0.3, 0, 0.6]}}
)";

struct Ended {
  int code = 0;
  std::string text;
};

class Program : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new PrivateFolder;
    core::write_file(path("short.yaml"), kScenario);
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static fs::path path(const std::string& name) { return folder_->path() / name; }
  static std::vector<std::string> command(std::vector<std::string> words) {
    words.insert(words.begin(), (program_folder() / "tarmac").string());
    return words;
  }
  static Ended tarmac(std::vector<std::string> words) {
    ChildRequest request;
    request.command = command(std::move(words));
    request.working_folder = folder_->path();
    request.log_file = path("log.txt");
    request.limits.wall_s = 240;
    const ChildResult result = run_child(request);
    EXPECT_NE(result.end, ChildResult::End::timed_out);
    EXPECT_NE(result.end, ChildResult::End::signalled) << core::read_file(path("log.txt"));
    return {result.code, core::read_file(path("log.txt"))};
  }
  /// The finished run that several tests look at.
  static const fs::path& finished_run() {
    static const fs::path run = [] {
      const Ended ended = tarmac({"run", "short.yaml", "-o", "run", "--jobs", "2"});
      EXPECT_EQ(ended.code, 0) << ended.text;
      return path("run");
    }();
    return run;
  }
  static PrivateFolder* folder_;
};
PrivateFolder* Program::folder_ = nullptr;

TEST_F(Program, RunWritesEveryFileOfTheContract) {
  const fs::path run = finished_run();
  for (const char* file :
       {"scenario.yaml", "provenance.json", "report.html", "recording/manifest.json", "truth/truth.tum",
        "truth/motion.yaml", "kiss-icp/trajectory.bin", "kiss-icp/trajectory.tum", "kiss-icp/reference.tum",
        "kiss-icp/diagnostics.bin", "kiss-icp/evaluation.json", "kiss-icp/timing.json", "kiss-icp/log.txt",
        "rigid-icp/evaluation.json", "dead-reckoning/evaluation.json"}) {
    EXPECT_TRUE(fs::is_regular_file(run / file)) << file;
  }
  EXPECT_EQ(fs::read_symlink(path("latest")), "run");
}

TEST_F(Program, SameSeedGivesTheSameBytesAtAnyNumberOfThreads) {
  const fs::path run = finished_run();
  ASSERT_EQ(tarmac({"run", "short.yaml", "-o", "again", "--jobs", "1"}).code, 0);
  for (const char* file : {"recording/lidar0.chunks", "recording/imu0.chunks", "recording/manifest.json",
                           "truth/truth.tum", "kiss-icp/trajectory.bin", "rigid-icp/trajectory.bin",
                           "dead-reckoning/trajectory.bin", "kiss-icp/diagnostics.bin", "kiss-icp/evaluation.json"}) {
    EXPECT_EQ(core::hash_hex(core::read_file(run / file)), core::hash_hex(core::read_file(path("again") / file)))
        << file;
  }
  ASSERT_EQ(tarmac({"simulate", "short.yaml", "-o", "other", "--seed", "2"}).code, 0);
  EXPECT_NE(core::Recording::open(path("other") / "recording").hash(), core::Recording::open(run / "recording").hash());
}

TEST_F(Program, EstimatesAreTheSameBytesWithTheTruthDeleted) {
  const fs::path run = finished_run();
  fs::create_directory(path("blind"));
  fs::copy(run / "recording", path("blind") / "recording", fs::copy_options::recursive);
  ASSERT_EQ(tarmac({"estimate", "blind", "-o", "blind-out", "-e", "all"}).code, 0);
  int compared = 0;
  for (const char* name : {"kiss-icp", "rigid-icp", "dead-reckoning"}) {
    EXPECT_EQ(core::read_file(run / name / "trajectory.bin"),
              core::read_file(path("blind-out") / name / "trajectory.bin"))
        << name;
    ++compared;
  }
  EXPECT_EQ(compared, 3);
}

TEST_F(Program, RecordingTellsNothingOfTheScenario) {
  const std::string manifest = core::read_file(finished_run() / "recording" / "manifest.json");
  for (const char* word : {"short-drive", "seed", "stand", "label", "instance", "scenario", "truth"}) {
    EXPECT_EQ(manifest.find(word), std::string::npos) << word;
  }
}

TEST_F(Program, FaultsOfTheCommandLineReachRecordingTruthAndReport) {
  // Stamps before the recording's begin, sweeps and packets that never came: all is scored all the same.
  const Ended ended = tarmac({"run", "short.yaml", "-o", "faulty", "-e", "kiss-icp,dead-reckoning", "--jobs", "2",
                              "--set", "faults.lidar.clock_offset_ms=-5", "--set", "faults.imu.clock_offset_ms=5",
                              "--set", "faults.lidar.lost_sweeps=0.1", "--set", "faults.lidar.lost_packets=0.05",
                              "--set", "faults.lidar.sweep_jitter_ms=0.2"});
  ASSERT_EQ(ended.code, 0) << ended.text;
  const std::string log = core::read_file(path("faulty") / "truth" / "faults.json");
  for (const char* kind : {"clock-offset", "lost-sweeps", "lost-packets", "sweep-jitter"})
    EXPECT_THAT(log, HasSubstr(std::string("\"kind\": \"") + kind));
  EXPECT_THAT(core::read_file(path("faulty") / "scenario.yaml"), HasSubstr("clock_offset_ms: -5"));
  EXPECT_THAT(core::read_file(path("faulty") / "recording" / "manifest.json"), testing::Not(HasSubstr("fault")));
  EXPECT_THAT(core::read_file(path("faulty") / "kiss-icp" / "evaluation.json"), HasSubstr("point_error_rms_m"));
  EXPECT_TRUE(fs::is_regular_file(path("faulty") / "report.html"));
}

TEST_F(Program, ForeignProgramsAreScoredAndTheirFailuresAreRecorded) {
  const fs::path run = finished_run();
  // The truth itself as an outside program's answer: whatever the scores say of it, they say of the path through
  // `command:`.
  const std::string truth = (run / "truth" / "truth.tum").string();
  core::write_file(path("tools.yaml"),
                   "estimators:\n"
                   "  copies-truth: {command: [sh, -c, 'cp " +
                       truth +
                       " {output}'], frame: body}\n"
                       "  crashes: {command: [sh, -c, 'kill -SEGV $$']}\n"
                       "  hangs: {command: [sleep, '1000'], timeout_s: 0.5}\n"
                       "  says-nan: {command: [sh, -c, 'echo 1.0 nan 0 0 0 0 0 1 > {output}']}\n"
                       "  babbles: {command: [sh, -c, 'echo hello > {output}']}\n"
                       "  is-silent: {command: ['true']}\n"
                       "  is-missing: {command: [no-such-program-anywhere]}\n");
  const Ended ended =
      tarmac({"estimate", "run", "-o", "foreign", "-e",
              "copies-truth,crashes,hangs,says-nan,babbles,is-silent,is-missing", "--config", "tools.yaml"});
  EXPECT_EQ(ended.code, 3) << ended.text;
  const auto status = [](const std::string& name) {
    return nlohmann::json::parse(core::read_file(path("foreign") / name / "outcome.json"))
        .at("status")
        .get<std::string>();
  };
  EXPECT_EQ(status("copies-truth"), "ok") << ended.text;
  EXPECT_EQ(status("crashes"), "crashed");
  EXPECT_EQ(status("hangs"), "timed_out");
  EXPECT_EQ(status("says-nan"), "bad_output");
  EXPECT_EQ(status("babbles"), "bad_output");
  EXPECT_EQ(status("is-silent"), "no_output");
  EXPECT_EQ(status("is-missing"), "failed");

  EXPECT_EQ(tarmac({"evaluate", "foreign", "--quiet"}).code, 3);
  const auto evaluation = nlohmann::json::parse(core::read_file(path("foreign") / "copies-truth" / "evaluation.json"));
  std::map<std::string, double> values;
  for (const auto& row : evaluation.at("rows")) {
    if (row.at("value").is_number()) values[row.at("metric").get<std::string>()] = row.at("value").get<double>();
  }
  // truth.tum at 1 kHz, interpolated: micrometres.
  ASSERT_TRUE(values.contains("ate_first_pose_rmse_m"));
  EXPECT_LT(values["ate_first_pose_rmse_m"], 1e-4);
  EXPECT_LT(values["point_error_rms_m"], 1e-3);
  EXPECT_EQ(tarmac({"report", "foreign", "-o", "foreign.html"}).code, 0);
}

TEST_F(Program, BadInputIsRefusedWithFileLineAndField) {
  const auto expect_refused = [&](std::vector<std::string> words, const testing::Matcher<std::string>& text) {
    const Ended ended = tarmac(words);
    EXPECT_EQ(ended.code, 2) << ended.text;
    EXPECT_THAT(ended.text, text);
  };
  const std::string good = kScenario;
  const auto scenario = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    core::write_file(path("bad.yaml"), text);
  };
  scenario("model: vlp-16", "model: vlp16");
  expect_refused({"run", "bad.yaml", "-o", "bad"},
                 AllOf(HasSubstr("bad.yaml:13"), HasSubstr("rig.lidar.model"), HasSubstr("vlp-16")));
  scenario("kind: stand", "kind: stant");
  expect_refused({"run", "bad.yaml", "-o", "bad"},
                 AllOf(HasSubstr("bad.yaml:5"), HasSubstr("scene.kind"), HasSubstr("stand")));
  scenario("to_m_s: 4", "to_m_s: -4");
  expect_refused({"run", "bad.yaml", "-o", "bad"},
                 AllOf(HasSubstr("bad.yaml:11"), HasSubstr("motion.speed.0.to_m_s"), HasSubstr("at least 0")));
  scenario("rest_s: 1.5", "rest: 1.5");
  expect_refused({"run", "bad.yaml", "-o", "bad"}, AllOf(HasSubstr("bad.yaml:8"), HasSubstr("did you mean 'rest_s'")));
  expect_refused({"run", "short.yaml", "-o", "bad", "-e", "kiss"}, HasSubstr("kiss-icp"));
  expect_refused({"run", "short.yaml", "-o", "bad", "--set", "rig.lidar.model=[1]"},
                 HasSubstr("--set rig.lidar.model"));
  expect_refused({"run", "short.yaml", "-o", "bad", "--set", "faults.lidar.clock_ofset_ms=5"},
                 AllOf(HasSubstr("--set faults.lidar.clock_ofset_ms"), HasSubstr("did you mean 'clock_offset_ms'")));
  expect_refused({"run", "no-such-scenario"}, HasSubstr("no-such-scenario"));
  expect_refused({"estimate", "short.yaml", "-o", "bad"}, HasSubstr("short.yaml"));
  expect_refused({"evaluate", "."}, HasSubstr("provenance.json"));
  expect_refused({"evaluate", "--truth", "short.yaml", "--estimate", "short.yaml"}, HasSubstr("short.yaml"));
  expect_refused({"describe", "sensor", "vlp-61"}, HasSubstr("vlp-16"));
  expect_refused({"describe", "aircraft", "b777-300e"}, HasSubstr("did you mean b777-300er?"));
  expect_refused({"describe", "scene", "corridor", "-o", "c.png", "--eye", "1,2"}, HasSubstr("--look-at"));
  expect_refused({"describe", "scene", "corridor", "-o", "c.png", "--eye", "1,2", "--look-at", "-1,0,1"},
                 AllOf(HasSubstr("--eye 1,2"), HasSubstr("12,-30,1.7")));
  expect_refused({"describe", "scene", "corridor", "--eye", "-1,2,3", "--look-at", "-1,0,1"}, HasSubstr("-o"));
  expect_refused({"describe", "scene", "all", "-o", "c.png", "--eye", "-1,2,3", "--look-at", "-1,0,1"},
                 HasSubstr("contact sheet"));
  expect_refused({"describe", "fault", "lida"}, HasSubstr("did you mean 'lidar'"));
  expect_refused({"fly"}, HasSubstr("fly"));
  expect_refused({"run"}, HasSubstr("scenario"));
  expect_refused({"simulate", "short.yaml"}, HasSubstr("--out"));
  expect_refused({"evaluate", ".", "--align", "sim3"}, HasSubstr("--align"));
  expect_refused({"run", "short.yaml", "-o", "bad", "--set", "duration_s=0.01"}, HasSubstr("whole sweep"));
  core::write_file(path("names.yaml"), "estimators: {truth: {command: [a]}, ../up: {command: [a]}}\n");
  expect_refused({"run", "short.yaml", "-o", "bad", "-e", "truth", "--config", "names.yaml"},
                 HasSubstr("cannot name an estimator"));
  expect_refused({"run", "short.yaml", "-o", "bad", "-e", "../up", "--config", "names.yaml"},
                 HasSubstr("cannot name an estimator"));
  expect_refused({"simulat"}, HasSubstr("did you mean 'simulate'"));
  EXPECT_FALSE(fs::exists(path("bad"))) << "something was written for a scenario that is refused";
}

TEST_F(Program, RefusedInputLeavesAnEarlierRunAsItWas) {
  fs::copy(finished_run(), path("kept"), fs::copy_options::recursive);
  const std::string before = core::read_file(path("kept") / "provenance.json");
  EXPECT_EQ(tarmac({"run", "short.yaml", "-o", "kept", "--set", "duration_s=0.01"}).code, 2);
  EXPECT_EQ(tarmac({"run", "short.yaml", "-o", "kept", "--seed", "1..2"}).code, 2)
      << "one seed and several in one folder";
  EXPECT_EQ(core::read_file(path("kept") / "provenance.json"), before);
  EXPECT_TRUE(fs::is_regular_file(path("kept") / "kiss-icp" / "evaluation.json"));
  EXPECT_TRUE(fs::is_regular_file(path("kept") / "report.html"));
}

TEST_F(Program, EstimatesOfAnotherRecordingAreNotScored) {
  fs::copy(finished_run(), path("mixed"), fs::copy_options::recursive);
  std::string outcome = core::read_file(path("mixed") / "rigid-icp" / "outcome.json");
  const std::string hash = core::Recording::open(path("mixed") / "recording").hash();
  outcome.replace(outcome.find(hash), hash.size(), "0123456789abcdef");
  core::write_file(path("mixed") / "rigid-icp" / "outcome.json", outcome);
  const Ended ended = tarmac({"evaluate", "mixed"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.text, AllOf(HasSubstr("rigid-icp"), HasSubstr("0123456789abcdef")));
}

TEST_F(Program, TruthOfAnotherVersionIsNotScored) {
  fs::copy(finished_run(), path("older"), fs::copy_options::recursive);
  std::string motion = core::read_file(path("older") / "truth" / "scenario.yaml");
  motion.replace(motion.find("to_m_s: 4"), 9, "to_m_s: 5");
  core::write_file(path("older") / "truth" / "scenario.yaml", motion);
  const Ended ended = tarmac({"evaluate", "older"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.text, HasSubstr("truth.tum"));
}

TEST_F(Program, TruncatedRecordingIsRefused) {
  const fs::path run = finished_run();
  fs::create_directory(path("cut"));
  fs::copy(run / "recording", path("cut") / "recording", fs::copy_options::recursive);
  const fs::path stream = path("cut") / "recording" / "lidar0.chunks";
  fs::resize_file(stream, fs::file_size(stream) / 2);
  const Ended ended = tarmac({"estimate", "cut", "-o", "cut-out", "-e", "kiss-icp"});
  EXPECT_EQ(ended.code, 2) << ended.text;
  EXPECT_THAT(ended.text, AllOf(HasSubstr("lidar0.chunks"), HasSubstr("footer")));
}

TEST_F(Program, InterruptLeavesNothingThatIsTakenForWhole) {
  // Over a finished run: its marks of being whole must be gone, not only never written.
  fs::copy(finished_run(), path("stopped"), fs::copy_options::recursive);
  ChildRequest request;
  std::string line = "exec";
  for (const std::string& word : command({"run", "short.yaml", "--set", "duration_s=60", "-o", "stopped"}))
    line += " '" + word + "'";
  request.command = {"sh", "-c",
                     "(" + line +
                         ") & child=$!; i=0; while [ -e stopped/provenance.json ] && [ $i -lt 600 ]; do "
                         "sleep 0.05; i=$((i+1)); done; sleep 0.3; kill -TERM $child; wait $child"};
  request.working_folder = folder_->path();
  request.log_file = path("stopped.log");
  request.limits.wall_s = 60;
  const ChildResult result = run_child(request);
  EXPECT_EQ(result.code, 130) << core::read_file(path("stopped.log"));
  EXPECT_FALSE(fs::exists(path("stopped") / "provenance.json"));
  EXPECT_FALSE(fs::exists(path("stopped") / "report.html"));
  EXPECT_FALSE(fs::exists(path("stopped") / "recording" / "manifest.json"));
  EXPECT_FALSE(fs::exists(path("stopped") / "kiss-icp"));
  EXPECT_EQ(tarmac({"estimate", "stopped", "-o", "stopped-out"}).code, 2);
  EXPECT_EQ(tarmac({"evaluate", "stopped"}).code, 2);
}

TEST_F(Program, PlainExportComesBackAsTheSameEstimates) {
  const fs::path run = finished_run();
  ASSERT_EQ(tarmac({"export", "run", "--format", "plain", "-o", "plain"}).code, 0);
  ASSERT_EQ(tarmac({"estimate", "plain", "-o", "from-plain", "-e", "kiss-icp"}).code, 0);
  const core::Estimate ours = core::load_estimate(run / "kiss-icp" / "trajectory.bin");
  const core::Estimate back = core::load_estimate(path("from-plain") / "kiss-icp" / "trajectory.bin");
  ASSERT_EQ(ours.sweeps.size(), back.sweeps.size());
  // Float32 seconds move point times by nanoseconds; the estimates differ by next to nothing.
  for (std::size_t i = 0; i < ours.sweeps.size(); ++i) {
    EXPECT_LT((ours.sweeps[i].T_map_body.translation() - back.sweeps[i].T_map_body.translation()).norm(), 0.02) << i;
  }
  ASSERT_EQ(tarmac({"export", "run", "--format", "tum", "-e", "kiss-icp", "-o", "kiss.tum"}).code, 0);
  const Ended scored = tarmac({"evaluate", "--truth", "run/truth/truth.tum", "--estimate", "kiss.tum", "--json"});
  EXPECT_EQ(scored.code, 0) << scored.text;
  EXPECT_THAT(scored.text, HasSubstr("ate_se3_rmse_m"));
}

TEST_F(Program, BenchPrintsRowsAndRefusesWhatItDoesNotKnow) {
  const Ended typo = tarmac({"bench", "simm"});
  EXPECT_EQ(typo.code, 2);
  EXPECT_THAT(typo.text, AllOf(HasSubstr("simm"), HasSubstr("did you mean 'sim'?"), HasSubstr("estimators")));
  const Ended ended = tarmac({"bench", "metrics", "--json", "--quiet"});
  ASSERT_EQ(ended.code, 0) << ended.text;
  const auto rows = nlohmann::json::parse(ended.text);
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("bench"), "metrics");
    EXPECT_EQ(row.at("unit"), "ms");
    EXPECT_GT(row.at("value").get<double>(), 0);
  }
  EXPECT_EQ(rows[0].at("metric"), "evaluate_4541_ms");
  // The process does the same work, and starts and reads files besides.
  EXPECT_GT(rows[1].at("value").get<double>(), rows[0].at("value").get<double>());
}

TEST_F(Program, ListsAndDescribesWhatThereIs) {
  EXPECT_THAT(tarmac({"list"}).text, AllOf(HasSubstr("kiss-icp"), HasSubstr("ouster-os1-64-gen2"), HasSubstr("stand"),
                                           HasSubstr("end_error_percent")));
  EXPECT_THAT(tarmac({"describe", "estimator", "kiss-icp"}).text,
              AllOf(HasSubstr("voxel_size_m"), HasSubstr("default 1")));
  EXPECT_THAT(tarmac({"describe", "sensor", "vlp-16"}).text, HasSubstr("16"));
  EXPECT_THAT(tarmac({"describe", "aircraft", "b777-300er"}).text, AllOf(HasSubstr("73.86"), HasSubstr("6 wheels")));
  EXPECT_THAT(tarmac({"describe", "equipment", "apron-bus"}).text, HasSubstr("13.9 x 3 x 3.2"));
  EXPECT_THAT(tarmac({"list", "equipment"}).text, HasSubstr("refueller"));
  EXPECT_THAT(tarmac({"describe", "fault", "lidar"}).text, HasSubstr("faults.lidar.point_time_unit"));
  EXPECT_THAT(tarmac({"--version"}).text, HasSubstr("tarmac"));
  for (const char* kind : {"scenarios", "scenes", "motions", "sensors", "imus", "faults", "estimators", "metrics"}) {
    EXPECT_EQ(tarmac({"list", kind, "--json"}).code, 0) << kind;
  }
}

}  // namespace
}  // namespace tarmac::tools
