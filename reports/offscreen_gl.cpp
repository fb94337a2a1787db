#include "reports/offscreen_gl.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>

#define EGL_NO_X11
#define MESA_EGL_NO_X11_HEADERS
#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace tarmac::reports {

namespace {

[[noreturn]] void unavailable(const std::string& what) {
  throw RenderingUnavailable(fmt::format(
      "pictures cannot be drawn here: {}. Install libegl1, libegl-mesa0 and libgl1-mesa-dri (no display is needed)",
      what));
}

}  // namespace

struct OffscreenGl::State {
  void* library = nullptr;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  ~State() {
    if (context != EGL_NO_CONTEXT) {
      call<decltype(&eglMakeCurrent)>("eglMakeCurrent")(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      call<decltype(&eglDestroyContext)>("eglDestroyContext")(display, context);
    }
    // The display stays initialised: it belongs to the process, and another context may be on it.
    // The library stays open: Mesa's driver registers handlers that run at exit.
  }

  template <class Function>
  Function call(const char* name) const {
    void* const address = dlsym(library, name);
    if (!address) unavailable(fmt::format("the EGL library has no function {}", name));
    return reinterpret_cast<Function>(address);
  }

  std::string last_error() const {
    return fmt::format("EGL error 0x{:04x}", call<decltype(&eglGetError)>("eglGetError")());
  }

  void open_display() {
    const auto address_of = call<decltype(&eglGetProcAddress)>("eglGetProcAddress");
    const auto platform_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(address_of("eglGetPlatformDisplayEXT"));
    if (!platform_display) unavailable("EGL knows no platform displays");
    display = platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY) unavailable("EGL has no surfaceless display (" + last_error() + ")");
    if (!call<decltype(&eglInitialize)>("eglInitialize")(display, nullptr, nullptr)) {
      unavailable("EGL's surfaceless display does not start (" + last_error() + ")");
    }
  }

  void open_context() {
    if (!call<decltype(&eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API)) unavailable("EGL offers no desktop OpenGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!call<decltype(&eglChooseConfig)>("eglChooseConfig")(display, wanted, &config, 1, &count) || count == 0) {
      unavailable("EGL has no configuration for OpenGL");
    }
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    context = call<decltype(&eglCreateContext)>("eglCreateContext")(display, config, EGL_NO_CONTEXT, version);
    if (context == EGL_NO_CONTEXT) unavailable("EGL makes no OpenGL 3.3 context (" + last_error() + ")");
  }
};

OffscreenGl::OffscreenGl(const std::string& egl_library) : state_(std::make_unique<State>()) {
  // The software rasteriser everywhere: a picture must not depend on the graphics card at hand.
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", /*overwrite=*/1);
  state_->library = dlopen(egl_library.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (!state_->library) unavailable(fmt::format("{} cannot be opened", egl_library));
  state_->open_display();
  state_->open_context();
  make_current();
}

OffscreenGl::~OffscreenGl() = default;

void OffscreenGl::make_current() {
  const auto make_current = state_->call<decltype(&eglMakeCurrent)>("eglMakeCurrent");
  if (!make_current(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context)) {
    unavailable("the OpenGL context cannot be made current (" + state_->last_error() + ")");
  }
}

bool OffscreenGl::is_current() const {
  return state_->call<decltype(&eglGetCurrentContext)>("eglGetCurrentContext")() == state_->context;
}

}  // namespace tarmac::reports
