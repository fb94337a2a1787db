#include "tools/tarmac/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <sstream>
#include <system_error>

#include "tools/tarmac/interrupt.h"

extern char** environ;

namespace tarmac::tools {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kProgressDescriptor = 3;
constexpr int kPollMs = 50;

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

pid_t start(const ChildRequest& request, int progress_end, int& error) {
  std::vector<std::string> words = request.command;
  if (!request.progress_argument.empty()) {
    words.push_back(request.progress_argument);
    words.push_back(std::to_string(kProgressDescriptor));
  }
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  // The log is named from our own working folder, so it is opened before the child changes to its own.
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, request.log_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&actions, progress_end, kProgressDescriptor);
  posix_spawn_file_actions_addchdir_np(&actions, request.working_folder.c_str());
  sigset_t defaults, none;
  sigemptyset(&none);
  sigemptyset(&defaults);
  for (const int number : {SIGINT, SIGTERM, SIGPIPE}) sigaddset(&defaults, number);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);

  pid_t child = -1;
  error = ::posix_spawnp(&child, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return error == 0 ? child : -1;
}

/// Reads what the child has said of its progress; complete lines only.
class ProgressReader {
 public:
  ProgressReader(int end, const ChildRequest& request) : end_(end), request_(request) {
    ::fcntl(end, F_SETFL, O_NONBLOCK);
  }
  void wait_and_read() {
    pollfd watched{open_ ? end_ : -1, POLLIN, 0};
    ::poll(&watched, 1, kPollMs);
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

}  // namespace

ChildResult run_child(const ChildRequest& request) {
  ChildResult result;
  Pipe pipe;
  const auto began = Clock::now();
  int error = 0;
  const pid_t child = start(request, pipe.write, error);
  if (child < 0) {
    result.end = ChildResult::End::not_started;
    result.code = error;
    result.message = fmt::format("{} cannot be started: {}", request.command.at(0), std::strerror(error));
    return result;
  }
  Pipe::close(pipe.write);

  ProgressReader progress(pipe.read, request);
  const auto elapsed_s = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  int status = 0;
  struct rusage usage {};
  bool timed_out = false;
  try {
    while (::wait4(child, &status, WNOHANG, &usage) == 0) {
      throw_if_interrupted();
      if (request.timeout_s > 0 && elapsed_s() > request.timeout_s) {
        timed_out = true;
        end_group(child);
        ::wait4(child, &status, 0, &usage);
        break;
      }
      progress.wait_and_read();
    }
  } catch (...) {
    end_group(child);
    ::wait4(child, &status, 0, &usage);
    throw;
  }
  // Whatever the child left running in its group ends with it; what it said last is still in the pipe.
  ::kill(-child, SIGKILL);
  progress.wait_and_read();

  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  result.wall_s = elapsed_s();
  result.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result.peak_memory_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;
  if (timed_out) {
    result.end = ChildResult::End::timed_out;
    result.message = fmt::format("timed out after {:g} s", request.timeout_s);
  } else if (WIFSIGNALED(status)) {
    result.end = ChildResult::End::signalled;
    result.code = WTERMSIG(status);
    result.message = fmt::format("crashed: signal {} ({})", result.code, ::strsignal(result.code));
  } else {
    result.code = WEXITSTATUS(status);
    if (result.code != 0) result.message = fmt::format("ended with exit code {}", result.code);
  }
  return result;
}

PrivateFolder::PrivateFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "tarmac-XXXXXX").string();
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
