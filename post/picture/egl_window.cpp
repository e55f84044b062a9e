// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/picture/egl_window.hpp"

// GLEW must come before any other header of OpenGL.
#include <vtk_glew.h>
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkObjectFactory.h>

#include "base/error.hpp"

namespace hilo {
namespace {

[[noreturn]] void no_egl(const std::string& what) {
  throw Error("picture", "cannot draw without a display: " + what, "install libegl1 and libgl1-mesa-dri", Exit::resources);
}

/// The context and a token surface to make it current with; all drawing goes to framebuffer objects.
struct Egl {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLSurface surface = EGL_NO_SURFACE;
  EGLContext context = EGL_NO_CONTEXT;

  void open() {
    const auto platform_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (!platform_display) no_egl("EGL has no platform displays");
    display = platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) no_egl("EGL has no surfaceless platform");
    if (!eglBindAPI(EGL_OPENGL_API)) no_egl("EGL has no OpenGL");
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_ALPHA_SIZE,
                             8,
                             EGL_NONE};
    EGLConfig config;
    EGLint found = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &found) || found == 0) no_egl("no RGBA8 pixel buffers");
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (context == EGL_NO_CONTEXT) no_egl("no OpenGL 3.2 context");
    const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, size);
    if (surface == EGL_NO_SURFACE || !eglMakeCurrent(display, surface, surface, context)) no_egl("the context cannot be made current");
  }
  void close() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
    display = EGL_NO_DISPLAY;
  }
};

class EglWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static EglWindow* New();
  vtkTypeMacro(EglWindow, vtkGenericOpenGLRenderWindow);

  void open() { egl_.open(); }
  bool IsCurrent() override { return egl_.context != EGL_NO_CONTEXT && eglGetCurrentContext() == egl_.context; }
  void MakeCurrent() override {
    if (egl_.display != EGL_NO_DISPLAY && !IsCurrent()) eglMakeCurrent(egl_.display, egl_.surface, egl_.surface, egl_.context);
  }
  int SupportsOpenGL() override { return 1; }
  vtkTypeBool IsDirect() override { return 1; }
  void Frame() override {}

  /// VTK's own version treats GLEW's missing GLX display as a failure; the function pointers are loaded by then.
  void OpenGLInitContext() override {
    if (Initialized) return;
    MakeCurrent();
    glewExperimental = GL_TRUE;
    const GLenum status = glewInit();
    GlewInitValid = status == GLEW_OK || status == GLEW_ERROR_NO_GLX_DISPLAY;
    if (!GlewInitValid || !GLEW_VERSION_3_2) no_egl("OpenGL 3.2 functions are missing");
    MaximumHardwareLineWidth = 1;
    Initialized = true;
  }

 protected:
  EglWindow() {
    ReadyForRendering = true;
    FrameBlitMode = NoBlit;
    SwapBuffers = 0;
  }
  ~EglWindow() override {
    Finalize();
    egl_.close();
  }

 private:
  Egl egl_;
};
vtkStandardNewMacro(EglWindow);

}  // namespace

vtkSmartPointer<vtkRenderWindow> egl_window(int width, int height) {
  const auto window = vtkSmartPointer<EglWindow>::New();
  window->open();
  window->SetSize(width, height);
  window->SetMultiSamples(8);
  return window;
}

}  // namespace hilo
