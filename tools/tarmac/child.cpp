#include "tools/tarmac/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include "tools/tarmac/child_start.h"
#include "tools/tarmac/interrupt.h"

namespace tarmac::tools {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kPollMs = 50;
constexpr int kFamilyEvery = 4;  // polls between two looks at what the child has started itself

/// A pipe whose ends close themselves.
struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    read = ends[0];
    write = ends[1];
  }
  ~Pipe() {
    close(read);
    close(write);
  }
  static void close(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
};

/// Reads what the child has said of its progress; complete lines only.
class ProgressReader {
 public:
  ProgressReader(int end, const ChildRequest& request) : end_(end), request_(request) {
    ::fcntl(end, F_SETFL, O_NONBLOCK);
  }
  /// Waits for words, for the child's end (where `pidfd` tells of it), or for a moment.
  void wait_and_read(int pidfd) {
    pollfd watched[2] = {{open_ ? end_ : -1, POLLIN, 0}, {pidfd, POLLIN, 0}};
    ::poll(watched, 2, kPollMs);
    read();
  }
  void read() {
    char buffer[4096];
    ssize_t n = 0;
    while (open_ && (n = ::read(end_, buffer, sizeof buffer)) > 0) text_.append(buffer, static_cast<std::size_t>(n));
    if (open_ && n == 0) open_ = false;
    for (std::size_t line_end; (line_end = text_.find('\n')) != std::string::npos; text_.erase(0, line_end + 1)) {
      report(text_.substr(0, line_end));
    }
  }

 private:
  void report(const std::string& line) const {
    std::istringstream in(line);
    std::string word, note;
    double fraction = 0;
    if (!(in >> word >> fraction) || word != "progress") return;
    std::getline(in >> std::ws, note);
    if (request_.on_progress) request_.on_progress(fraction, note);
  }
  int end_;
  bool open_ = true;
  const ChildRequest& request_;
  std::string text_;
};

void end_group(pid_t child) {
  ::kill(-child, SIGKILL);
  ::kill(child, SIGKILL);
}

double resident_mb(const std::string& pid) {
  std::ifstream in("/proc/" + pid + "/statm");
  double total = 0, resident = 0;
  in >> total >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1048576.0;
}

/// The most that a process has had since it became the program that it is; 0 once it has ended.
double peak_resident_mb(const std::string& pid) {
  std::ifstream in("/proc/" + pid + "/status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0;
}

/// Of a process and all that it has started.
double family_resident_mb(const std::string& pid) {
  double sum_mb = resident_mb(pid);
  std::error_code gone;
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + pid + "/task", gone)) {
    std::ifstream children(task.path() / "children");
    for (std::string child; children >> child;) sum_mb += family_resident_mb(child);
  }
  return sum_mb;
}

/// Watches a child until it ends or breaks a limit.
class Watch {
 public:
  Watch(const ChildRequest& request, const StartedChild& child, ProgressReader& progress)
      : request_(request), child_(child), progress_(progress) {}
  ~Watch() {
    if (child_.pidfd >= 0) ::close(child_.pidfd);
  }

  void until_the_end() {
    try {
      for (int round = 1; ::wait4(child_.pid, &status_, WNOHANG, &usage_) == 0; ++round) {
        throw_if_interrupted();
        peak_mb_ = std::max(peak_mb_, peak_resident_mb(std::to_string(child_.pid)));
        if (breaks_a_limit(round)) {
          end_group(child_.pid);
          ::wait4(child_.pid, &status_, 0, &usage_);
          break;
        }
        progress_.wait_and_read(child_.pidfd);
      }
    } catch (...) {
      end_group(child_.pid);
      ::wait4(child_.pid, &status_, 0, &usage_);
      throw;
    }
    // Whatever the child left running in its group ends with it; what it said last is still in the pipe.
    ::kill(-child_.pid, SIGKILL);
    progress_.read();
  }

  ChildResult result() const {
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    ChildResult result;
    result.wall_s = elapsed_s();
    result.cpu_s = seconds(usage_.ru_utime) + seconds(usage_.ru_stime);
    // The account at the end is exact, but begins with what this process had when it forked: where it says no more than
    // that, what was seen while the child ran has to do.
    const double accounted_mb = static_cast<double>(usage_.ru_maxrss) / 1024.0;
    result.peak_memory_mb = accounted_mb > own_peak_mb_ ? accounted_mb : peak_mb_;
    const ChildLimits& limits = request_.limits;
    const int signal = WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
    // A burst between two looks shows in the end's account.
    const bool burst = limits.memory_mb > 0 && result.peak_memory_mb > limits.memory_mb;
    if (burst || broken_ != ChildResult::End::exited) {
      result.end = burst ? ChildResult::End::out_of_memory : broken_;
      result.message = result.end == ChildResult::End::timed_out
                           ? fmt::format("timed out after {:g} s", limits.wall_s)
                           : fmt::format("used more than {:g} MB of memory", limits.memory_mb);
    } else if (signal != 0 && limits.cpu_s > 0 && (signal == SIGXCPU || result.cpu_s >= limits.cpu_s)) {
      result.end = ChildResult::End::timed_out;
      result.message = fmt::format("used more than {:g} s of processor time", limits.cpu_s);
    } else if (signal != 0) {
      result.end = signal == SIGKILL ? ChildResult::End::killed : ChildResult::End::signalled;
      result.code = signal;
      result.message = fmt::format("{}: signal {} ({})", signal == SIGKILL ? "killed from outside" : "crashed", signal,
                                   ::strsignal(signal));
    } else {
      result.code = WEXITSTATUS(status_);
      if (result.code != 0) result.message = fmt::format("ended with exit code {}", result.code);
    }
    return result;
  }

 private:
  double elapsed_s() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }
  bool breaks_a_limit(int round) {
    const ChildLimits& limits = request_.limits;
    if (limits.wall_s > 0 && elapsed_s() > limits.wall_s) broken_ = ChildResult::End::timed_out;
    if (limits.memory_mb > 0) {
      const std::string pid = std::to_string(child_.pid);
      const double used_mb = round % kFamilyEvery == 0 ? family_resident_mb(pid) : resident_mb(pid);
      if (used_mb > limits.memory_mb) broken_ = ChildResult::End::out_of_memory;
    }
    return broken_ != ChildResult::End::exited;
  }

  const ChildRequest& request_;
  const StartedChild child_;
  ProgressReader& progress_;
  const Clock::time_point began_ = Clock::now();
  const double own_peak_mb_ = peak_resident_mb("self");
  double peak_mb_ = 0;
  int status_ = 0;
  struct rusage usage_ {};
  ChildResult::End broken_ = ChildResult::End::exited;
};

}  // namespace

ChildResult run_child(const ChildRequest& request) {
  Pipe pipe;
  const StartedChild child = start_child(request, pipe.write);
  if (child.pid < 0) {
    ChildResult result;
    result.end = ChildResult::End::not_started;
    result.code = child.error;
    result.message = fmt::format("{} cannot be started: {}", request.command.at(0), std::strerror(child.error));
    return result;
  }
  Pipe::close(pipe.write);
  ProgressReader progress(pipe.read, request);
  Watch watch(request, child, progress);
  watch.until_the_end();
  return watch.result();
}

PrivateFolder::PrivateFolder() : PrivateFolder(std::filesystem::temp_directory_path()) {}

PrivateFolder::PrivateFolder(const std::filesystem::path& below) {
  std::string pattern = (below / "tarmac-XXXXXX").string();
  if (!::mkdtemp(pattern.data())) {
    throw std::system_error(errno, std::generic_category(), "a private working folder cannot be made: " + pattern);
  }
  path_ = pattern;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void lend_files(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::filesystem::create_directories(to);
  for (const auto& entry : std::filesystem::directory_iterator(from)) {
    const std::filesystem::path target = to / entry.path().filename();
    std::error_code error;
    std::filesystem::create_hard_link(entry.path(), target, error);
    if (error) std::filesystem::copy_file(entry.path(), target);
  }
}

std::filesystem::path program_folder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

}  // namespace tarmac::tools
