/// An OpenGL context without window, display server or graphics card.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace tarmac::reports {

/// Pictures cannot be drawn on this machine; the message says which packages are missing.
class RenderingUnavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr const char* kEglLibrary = "libEGL.so.1";

/// EGL's surfaceless platform with Mesa's software rasteriser: the same pixels on every machine with one Mesa version.
/// The EGL library is opened at run time, so that a machine without it can do everything but draw.
class OffscreenGl {
 public:
  /// Throws RenderingUnavailable. Another library than kEglLibrary is for tests.
  explicit OffscreenGl(const std::string& egl_library);
  ~OffscreenGl();
  OffscreenGl(const OffscreenGl&) = delete;
  OffscreenGl& operator=(const OffscreenGl&) = delete;

  void make_current();
  bool is_current() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tarmac::reports
