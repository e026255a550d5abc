// The one file with Xlib's names in it: after what might stumble over its macros.
#include "render/context.h"
#include "sim/math/pose.h"
#include "sim/math/result.h"

// clang-format off
#include <epoxy/egl.h>
#include <epoxy/glx.h>
#include <time.h>

#define XR_USE_PLATFORM_XLIB
#include "render/xr/binding.h"
// clang-format on

namespace slosh::xr {
namespace {

/// The configuration that a GLX context was made with; null where it cannot be told.
GLXFBConfig config_of(Display* display, GLXContext context) {
  int id = 0;
  int screen = 0;
  if (glXQueryContext(display, context, GLX_FBCONFIG_ID, &id) != 0) return nullptr;
  glXQueryContext(display, context, GLX_SCREEN, &screen);
  const int wanted[] = {GLX_FBCONFIG_ID, id, 0};
  int count = 0;
  GLXFBConfig* found = glXChooseFBConfig(display, screen, wanted, &count);
  GLXFBConfig config = found && count > 0 ? found[0] : nullptr;
  if (found) XFree(found);
  return config;
}

Result<XrSession> make(const Runtime& runtime, const void* binding) {
  auto info = typed<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
  info.next = binding;
  info.systemId = runtime.system();
  XrSession session = XR_NULL_HANDLE;
  const XrResult result = xrCreateSession(runtime.instance(), &info, &session);
  if (XR_FAILED(result)) return failed("xrCreateSession", result);
  return session;
}

}  // namespace

Result<XrSession> make_session(const Runtime& runtime, const Context& context) {
  // A runtime must be asked before it takes a session.
  const auto ask = function_of<PFN_xrGetOpenGLGraphicsRequirementsKHR>(runtime.instance(),
                                                                       "xrGetOpenGLGraphicsRequirementsKHR");
  auto needs = typed<XrGraphicsRequirementsOpenGLKHR>(XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR);
  if (!ask) return failed("xrGetOpenGLGraphicsRequirementsKHR", XR_ERROR_FUNCTION_UNSUPPORTED);
  if (const XrResult result = ask(runtime.instance(), runtime.system(), &needs); XR_FAILED(result))
    return failed("xrGetOpenGLGraphicsRequirementsKHR", result);
  if (needs.minApiVersionSupported > XR_MAKE_VERSION(4, 5, 0))
    return Error{"headset", "the runtime wants a newer OpenGL than 4.5",
                 "Update slosh, or use another runtime"};

  if (!context.has_window()) {
    if (!runtime.has_egl())
      return Error{"headset", "the runtime takes pictures of a window alone (it lacks XR_MNDX_egl_enable)",
                   "Run it with a display"};
    auto egl = typed<XrGraphicsBindingEGLMNDX>(XR_TYPE_GRAPHICS_BINDING_EGL_MNDX);
    egl.getProcAddress = reinterpret_cast<PFNEGLGETPROCADDRESSPROC>(eglGetProcAddress);
    egl.display = eglGetCurrentDisplay();
    egl.context = eglGetCurrentContext();
    egl.config = EGL_NO_CONFIG_KHR;  // as the context was made
    return make(runtime, &egl);
  }
  auto glx = typed<XrGraphicsBindingOpenGLXlibKHR>(XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR);
  glx.xDisplay = glXGetCurrentDisplay();
  glx.glxContext = glXGetCurrentContext();
  glx.glxDrawable = glXGetCurrentDrawable();
  if (!glx.xDisplay || !glx.glxContext)
    return Error{"headset", "the window is not one of X11, and a runtime takes no other",
                 "Log in to a desktop that has X11 (XWayland will do)"};
  glx.glxFBConfig = config_of(glx.xDisplay, glx.glxContext);
  int visual = 0;
  if (glx.glxFBConfig) glXGetFBConfigAttrib(glx.xDisplay, glx.glxFBConfig, GLX_VISUAL_ID, &visual);
  glx.visualid = static_cast<std::uint32_t>(visual);
  return make(runtime, &glx);
}

}  // namespace slosh::xr
