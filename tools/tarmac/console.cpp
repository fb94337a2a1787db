#include "tools/tarmac/console.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include "tools/tarmac/interrupt.h"

namespace tarmac::tools {
namespace {

constexpr int kBarWidth = 28;
constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr double kPlainStep = 0.25;

std::size_t terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col : 80;
}

/// The state behind one progress callback; callbacks may come from several threads.
class Bar {
 public:
  Bar(std::string label, bool terminal) : label_(std::move(label)), terminal_(terminal) {}

  void report(double fraction, const std::string& note) {
    const std::lock_guard lock(mutex_);
    fraction = std::clamp(fraction, 0.0, 1.0);
    const bool done = fraction >= 1.0;
    if (done && finished_) return;
    finished_ = done;
    terminal_ ? draw(fraction, note, done) : print(fraction, note, done);
  }

 private:
  using Clock = std::chrono::steady_clock;

  void draw(double fraction, const std::string& note, bool done) {
    const auto now = Clock::now();
    if (!done && now - last_ < kRedraw) return;
    last_ = now;
    const int filled = static_cast<int>(fraction * kBarWidth);
    std::string line = fmt::format("{:<14} [{:=<{}}{:<{}}] {:3.0f} %  {}  {}", label_, "", filled, "",
                                   kBarWidth - filled, 100 * fraction, remaining(fraction, done), note);
    line.resize(std::min(line.size(), terminal_columns() - 1));  // a line that wraps could not be drawn over
    fmt::print(stderr, "\r{}\x1b[K", line);
    if (done) fmt::print(stderr, "\n");
    std::fflush(stderr);
  }
  void print(double fraction, const std::string& note, bool done) {
    if (!done && fraction < next_plain_) return;
    next_plain_ = fraction + kPlainStep;
    fmt::print(stderr, "{}: {:.0f} %{}{}\n", label_, 100 * fraction, note.empty() ? "" : ", ", note);
  }
  std::string remaining(double fraction, bool done) const {
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - start_).count();
    if (done) return fmt::format("{:.1f} s", elapsed_s);
    if (fraction < 0.01) return "";
    return fmt::format("{:.0f} s left", elapsed_s * (1 - fraction) / fraction);
  }

  std::string label_;
  bool terminal_;
  bool finished_ = false;
  double next_plain_ = kPlainStep;
  Clock::time_point start_ = Clock::now(), last_{};
  std::mutex mutex_;
};

}  // namespace

Console::Console(bool quiet) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) != 0) {}

void Console::say(const std::string& line) const {
  if (!quiet_) warn(line);
}

void Console::warn(const std::string& line) const {
  fmt::print(stderr, "{}{}\n", terminal_ ? "\r\x1b[K" : "", line);  // not behind a bar's rest
}

core::Progress Console::progress(const std::string& label) const {
  if (quiet_) return [](double, const std::string&) { throw_if_interrupted(); };
  return [bar = std::make_shared<Bar>(label, terminal_)](double fraction, const std::string& note) {
    throw_if_interrupted();
    bar->report(fraction, note);
  };
}

}  // namespace tarmac::tools
