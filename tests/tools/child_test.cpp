#include "tools/tarmac/child.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

namespace tarmac::tools {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class Child : public testing::Test {
 protected:
  ChildRequest request(const std::string& script) {
    ChildRequest request;
    request.command = {"sh", "-c", script};
    request.working_folder = folder_.path();
    request.log_file = folder_.path() / "log.txt";
    request.limits.wall_s = 20;
    request.on_progress = [this](double fraction, const std::string& note) { progress_.emplace_back(fraction, note); };
    return request;
  }
  ChildResult run(const std::string& script, double wall_s = 20) {
    ChildRequest child = request(script);
    child.limits.wall_s = wall_s;
    return run_child(child);
  }
  /// Dead, or a zombie that nobody has reaped yet: it runs no more. Waits for it for a while.
  static bool is_gone(pid_t process) {
    std::string state;
    for (int i = 0; i < 100; ++i) {
      std::ifstream status("/proc/" + std::to_string(process) + "/stat");
      std::string pid, name;
      state.clear();
      status >> pid >> name >> state;
      if (state.empty() || state == "Z") return true;
      usleep(20000);
    }
    return false;
  }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(folder_.path() / "log.txt").rdbuf();
    return text.str();
  }
  PrivateFolder folder_;
  std::vector<std::pair<double, std::string>> progress_;
};

TEST_F(Child, ThatEndsWellIsOkAndItsWordsAreInTheLog) {
  const ChildResult result = run("echo out; echo err >&2; pwd");
  EXPECT_TRUE(result.ok());
  EXPECT_THAT(log(), testing::AllOf(HasSubstr("out"), HasSubstr("err"), HasSubstr(folder_.path().string())));
}

TEST_F(Child, ThatFailsOrCrashesSaysHow) {
  const ChildResult failed = run("exit 7");
  EXPECT_EQ(failed.end, ChildResult::End::exited);
  EXPECT_EQ(failed.code, 7);
  EXPECT_FALSE(failed.ok());
  const ChildResult crashed = run("kill -SEGV $$");
  EXPECT_EQ(crashed.end, ChildResult::End::signalled);
  EXPECT_EQ(crashed.code, SIGSEGV);
  EXPECT_THAT(crashed.message, HasSubstr("signal 11"));
}

TEST_F(Child, ThatHangsIsEndedWithWhateverItStarted) {
  const ChildResult result = run("(sleep 600; echo survived > survivor) & echo $! > grandchild; sleep 600", 0.3);
  EXPECT_EQ(result.end, ChildResult::End::timed_out);
  EXPECT_LT(result.wall_s, 300) << "the child would have slept for 600 s";
  pid_t grandchild = 0;
  std::ifstream(folder_.path() / "grandchild") >> grandchild;
  ASSERT_GT(grandchild, 0);
  EXPECT_TRUE(is_gone(grandchild));
}

TEST_F(Child, ThatIsKilledFromOutsideIsToldFromOneThatCrashes) {
  EXPECT_EQ(run("kill -KILL $$").end, ChildResult::End::killed);
}

TEST_F(Child, ThatUsesTooMuchMemoryIsEndedAndSoIsOneWhoseChildrenDo) {
  // The second one does it in a grandchild.
  const std::string eats = "exec python3 -c 'x = []\nwhile True: x.append(bytearray(1 << 20))'";
  for (const std::string& script : {eats, "(" + eats + ") & wait; exit 0"}) {
    ChildRequest request = this->request(script);
    request.limits.memory_mb = 200;
    const ChildResult result = run_child(request);
    EXPECT_EQ(result.end, ChildResult::End::out_of_memory) << result.message << log();
    EXPECT_THAT(result.message, HasSubstr("200 MB"));
  }
}

TEST_F(Child, ThatUsesTooMuchProcessorTimeIsEnded) {
  ChildRequest request = this->request("while :; do :; done");
  request.limits.cpu_s = 1;
  const ChildResult result = run_child(request);
  EXPECT_EQ(result.end, ChildResult::End::timed_out);
  EXPECT_THAT(result.message, HasSubstr("processor time"));
  EXPECT_LT(result.cpu_s, 3);
}

TEST_F(Child, EndsWithTheProcessThatStartedIt) {
  const fs::path pid_file = folder_.path() / "pid";
  const pid_t parent = fork();
  if (parent == 0) {
    run("echo $$ > pid.part; mv pid.part pid; exec sleep 600", 0);
    _exit(0);
  }
  for (int i = 0; i < 1000 && !fs::exists(pid_file); ++i) usleep(10000);
  pid_t child = 0;
  std::ifstream(pid_file) >> child;
  ASSERT_GT(child, 0);
  EXPECT_EQ(kill(child, 0), 0);
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  EXPECT_TRUE(is_gone(child));
}

TEST_F(Child, ReportsProgressThroughItsOwnDescriptor) {
  run("echo 'progress 0.25 a quarter' >&3; echo noise >&3; echo 'progress 1 done' >&3");
  ASSERT_EQ(progress_.size(), 2u);
  EXPECT_EQ(progress_[0].first, 0.25);
  EXPECT_EQ(progress_[0].second, "a quarter");
  EXPECT_EQ(progress_[1].first, 1.0);
}

TEST_F(Child, ThatDoesNotExistIsNamed) {
  ChildRequest request;
  request.command = {"no-such-program-anywhere"};
  request.working_folder = folder_.path();
  request.log_file = folder_.path() / "log.txt";
  const ChildResult result = run_child(request);
  EXPECT_EQ(result.end, ChildResult::End::not_started);
  EXPECT_THAT(result.message, HasSubstr("no-such-program-anywhere"));
}

TEST(PrivateFolder, IsGoneAfterwards) {
  fs::path path;
  {
    PrivateFolder folder;
    path = folder.path();
    std::ofstream(path / "file") << "x";
    EXPECT_TRUE(fs::exists(path));
  }
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace tarmac::tools
