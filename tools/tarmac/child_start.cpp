#include "tools/tarmac/child_start.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <vector>

extern char** environ;

namespace tarmac::tools {
namespace {

constexpr int kProgressDescriptor = 3;
// The resident memory is watched; the limit on what may be allocated at all is the net below, for bursts.
constexpr double kAllocationFactor = 2;
constexpr double kAllocationMarginMb = 512;

/// Where the program lies: looked up here, for between fork and exec nothing may allocate.
std::string find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = (folder.empty() ? "." : folder) + "/" + name;
    if (::access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return {};
}

/// All that the child needs, ready before the fork.
struct Prepared {
  std::string program, working_folder, log_file;
  std::vector<std::string> words;
  std::vector<char*> argv;
  rlimit cpu{}, data{}, file{};
  bool limits_cpu = false, limits_data = false, limits_file = false;
  int progress_end = -1, error_end = -1;
  pid_t parent = 0;

  Prepared(const ChildRequest& request, int progress, int error)
      : program(find_program(request.command.at(0))),
        working_folder(request.working_folder.string()),
        log_file(request.log_file.string()),
        words(request.command),
        progress_end(progress),
        error_end(error),
        parent(::getpid()) {
    if (!request.progress_argument.empty()) {
      words.push_back(request.progress_argument);
      words.push_back(std::to_string(kProgressDescriptor));
    }
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const ChildLimits& limits = request.limits;
    if (limits.cpu_s > 0) {
      const auto seconds = static_cast<rlim_t>(std::ceil(limits.cpu_s));
      cpu = {seconds, seconds + 5};  // SIGXCPU, and SIGKILL for who ignores it
      limits_cpu = true;
    }
    if (limits.memory_mb > 0) {
      const auto bytes = static_cast<rlim_t>((kAllocationFactor * limits.memory_mb + kAllocationMarginMb) * 1048576.0);
      data = {bytes, bytes};
      limits_data = true;
    }
    if (limits.file_mb > 0) {
      const auto bytes = static_cast<rlim_t>(limits.file_mb * 1048576.0);
      file = {bytes, bytes};
      limits_file = true;
    }
  }
};

[[noreturn]] void give_up(int error_end) {
  const int error = errno;
  [[maybe_unused]] const auto written = ::write(error_end, &error, sizeof error);
  ::_exit(127);
}

/// In the child: system calls only, for other threads of the parent may have held any lock at the fork.
[[noreturn]] void become(const Prepared& p) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != p.parent) ::_exit(127);  // it ended between fork and here
  for (const int number : {SIGINT, SIGTERM, SIGPIPE}) ::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int null = ::open("/dev/null", O_RDONLY);
  // The log is named from our own working folder, so it is opened before the child changes to its own.
  const int log = ::open(p.log_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (null < 0 || log < 0) give_up(p.error_end);
  if (::dup2(null, STDIN_FILENO) < 0 || ::dup2(log, STDOUT_FILENO) < 0 || ::dup2(log, STDERR_FILENO) < 0) {
    give_up(p.error_end);
  }
  if (p.progress_end == kProgressDescriptor) {
    ::fcntl(kProgressDescriptor, F_SETFD, 0);
  } else if (::dup2(p.progress_end, kProgressDescriptor) < 0) {
    give_up(p.error_end);
  }
  if (::chdir(p.working_folder.c_str()) != 0) give_up(p.error_end);
  if (p.limits_cpu) ::setrlimit(RLIMIT_CPU, &p.cpu);
  if (p.limits_data) ::setrlimit(RLIMIT_DATA, &p.data);
  if (p.limits_file) ::setrlimit(RLIMIT_FSIZE, &p.file);
  ::execve(p.program.c_str(), p.argv.data(), environ);
  give_up(p.error_end);
}

}  // namespace

StartedChild start_child(const ChildRequest& request, int progress_end) {
  StartedChild started;
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  // Descriptor 3 becomes the progress pipe in the child: this one must lie elsewhere.
  const int error_end = ::fcntl(ends[1], F_DUPFD_CLOEXEC, kProgressDescriptor + 1);
  ::close(ends[1]);
  const Prepared prepared(request, progress_end, error_end);
  if (prepared.program.empty()) {
    started.error = ENOENT;
  } else {
    started.pid = ::fork();
    if (started.pid == 0) become(prepared);
    if (started.pid < 0) started.error = errno;
  }
  ::close(error_end);
  int error = 0;
  ssize_t n = 0;
  do {
    n = ::read(ends[0], &error, sizeof error);
  } while (n < 0 && errno == EINTR);
  ::close(ends[0]);
  if (started.pid > 0 && n == sizeof error) {
    ::waitpid(started.pid, nullptr, 0);
    started = {-1, -1, error};
  }
  if (started.pid > 0) started.pidfd = static_cast<int>(::syscall(SYS_pidfd_open, started.pid, 0));
  return started;
}

}  // namespace tarmac::tools
