// Headless contexts through EGL.
#include <dlfcn.h>
#include <epoxy/egl.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "render/context.h"

namespace slosh {
namespace {

class EglContext final : public Context {
 public:
  EglContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {
    EglContext::make_current();
    describe_current();
  }
  // The display is not terminated: EGL gives every caller the same one, and others may still draw with it.
  ~EglContext() override {
    if (eglGetCurrentContext() == context_) EglContext::release_current();
    eglDestroyContext(display_, context_);
  }

  void make_current() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_); }
  void release_current() override {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  bool has_window() const override { return false; }
  glm::ivec2 framebuffer_size() const override { return glm::ivec2(0); }
  const InputState& poll() override { return input_; }
  bool should_close() const override { return false; }
  void swap() override {}

 private:
  EGLDisplay display_;
  EGLContext context_;
  InputState input_;
};

bool has_word(const char* list, const char* word) {
  std::istringstream words(list ? list : "");
  return std::find(std::istream_iterator<std::string>(words), {}, word) !=
         std::istream_iterator<std::string>();
}

/// A 4.5 core context on `display`, or EGL_NO_CONTEXT with the reason appended to `reasons`.
EGLContext try_display(EGLDisplay display, const char* name, bool debug, std::string& reasons) {
  const auto fail = [&](const std::string& why) {
    if (!reasons.empty()) reasons += "; ";
    reasons.append(name).append(": ").append(why);
    return EGL_NO_CONTEXT;
  };
  if (display == EGL_NO_DISPLAY) return fail("no display");
  EGLint major = 0;
  EGLint minor = 0;
  if (!eglInitialize(display, &major, &minor)) return fail("cannot be initialised");
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  for (const char* needed : {"EGL_KHR_no_config_context", "EGL_KHR_surfaceless_context"}) {
    if (!has_word(extensions, needed)) return fail(std::string("lacks ") + needed);
  }
  if (!eglBindAPI(EGL_OPENGL_API)) return fail("has no desktop OpenGL");
  const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                         4,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         5,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_CONTEXT_OPENGL_DEBUG,
                                         debug ? EGL_TRUE : EGL_FALSE,
                                         EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context == EGL_NO_CONTEXT) return fail("has no OpenGL 4.5 core");
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    eglDestroyContext(display, context);
    return fail("cannot make a context current without a surface");
  }
  return context;
}

bool can_be_loaded(const char* library) {
  void* const handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  if (handle) dlclose(handle);
  return handle;
}

constexpr const char* kPackages =
    "Install libegl1, libegl-mesa0 and libgl1-mesa-dri, or the driver of your GPU";

struct Candidate {
  EGLDisplay display;
  const char* name;
};

EGLDisplay display_of(EGLDeviceEXT device) {
  return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
}

struct Devices {
  std::vector<EGLDeviceEXT> hardware, software;
};
/// What EGL lists; nothing where it lists none.
Devices find_devices() {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  Devices found;
  // EGL_EXT_device_base is what NVIDIA's says alone; the other is half of it.
  const bool listed =
      has_word(client, "EGL_EXT_device_base") || has_word(client, "EGL_EXT_device_enumeration");
  if (listed && has_word(client, "EGL_EXT_platform_base") && has_word(client, "EGL_EXT_platform_device")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
      for (EGLint i = 0; i < count; ++i) {
        const bool is_software =
            has_word(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software");
        (is_software ? found.software : found.hardware).push_back(devices[i]);
      }
    }
  }
  return found;
}

/// The GPU's number to CUDA; `otherwise` where its driver does not tell.
EGLAttrib cuda_number(EGLDeviceEXT device, std::size_t otherwise) {
  EGLAttrib number = 0;
  const bool told = has_word(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_NV_device_cuda") &&
                    eglQueryDeviceAttribEXT(device, EGL_CUDA_DEVICE_NV, &number);
  return told ? number : static_cast<EGLAttrib>(otherwise);
}

/// The display of GPU `gpu` alone; none where there is no such GPU.
std::vector<Candidate> display_on(int gpu) {
  const std::vector<EGLDeviceEXT> hardware = find_devices().hardware;
  for (std::size_t i = 0; i < hardware.size(); ++i) {
    if (cuda_number(hardware[i], i) == gpu) return {{display_of(hardware[i]), "EGL device"}};
  }
  return {};
}

/// Displays in the order they are worth trying. EGL devices of GPUs come before Mesa's software device.
std::vector<Candidate> candidate_displays() {
  std::vector<Candidate> found;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_word(client, "EGL_EXT_platform_base")) {
    found.push_back({eglGetDisplay(EGL_DEFAULT_DISPLAY), "default display"});
    return found;
  }
  const auto [hardware, software] = find_devices();
  const auto add_devices = [&](const std::vector<EGLDeviceEXT>& devices, const char* name) {
    for (EGLDeviceEXT device : devices) found.push_back({display_of(device), name});
  };
  // Mesa's surfaceless platform picks a Mesa GPU by itself; another vendor's GPU shows only as a device.
  const bool mesa_surfaceless = has_word(client, "EGL_MESA_platform_surfaceless");
  add_devices(hardware, "EGL device");
  if (mesa_surfaceless) {
    found.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
                     "surfaceless platform"});
  }
  add_devices(software, "software EGL device");
  found.push_back({eglGetDisplay(EGL_DEFAULT_DISPLAY), "default display"});
  return found;
}

}  // namespace

void set_software_threads(int threads) {
  constexpr const char* kName = "LP_NUM_THREADS";
  const std::string wish = std::to_string(threads);
  // There is no other way to tell it; context.h says when this is safe.
  // NOLINTBEGIN(concurrency-mt-unsafe)
  const char* set = std::getenv(kName);
  if (set == nullptr || wish != set) setenv(kName, wish.c_str(), 1);
  // NOLINTEND(concurrency-mt-unsafe)
}

std::optional<Error> no_headless_gl() {
  // As libepoxy looks for them.
  if (!can_be_loaded("libEGL.so.1"))
    return Error{"headless OpenGL", "there is no libEGL.so.1 that can be loaded", kPackages};
  if (!can_be_loaded("libOpenGL.so.0") && !can_be_loaded("libGL.so.1"))
    return Error{"headless OpenGL", "there is no libOpenGL.so.0 and no libGL.so.1 that can be loaded",
                 "Install libopengl0"};
  return std::nullopt;
}

Result<std::unique_ptr<Context>> make_headless_context(const HeadlessOptions& options) {
  if (options.software_threads < 0 || options.software_threads > 64) {
    return Error{"software_threads", std::to_string(options.software_threads) + " is not within 0–64",
                 "Use 0"};
  }
  if (std::optional<Error> missing = no_headless_gl()) return std::move(*missing);
  // llvmpipe reads it when its first screen is made, which the first eglInitialize does.
  if (options.software_threads > 0) set_software_threads(options.software_threads);
  std::string reasons;
  for (const Candidate& candidate : options.gpu < 0 ? candidate_displays() : display_on(options.gpu)) {
    const EGLContext context = try_display(candidate.display, candidate.name, options.debug, reasons);
    if (context != EGL_NO_CONTEXT)
      return std::unique_ptr<Context>(new EglContext(candidate.display, context));
  }
  if (options.gpu >= 0)
    return Error{"headless OpenGL on GPU " + std::to_string(options.gpu),
                 reasons.empty() ? "EGL lists no such GPU" : reasons,
                 "Choose one that `nvidia-smi -L` lists, or let the first that draws be taken"};
  return Error{"headless OpenGL", reasons.empty() ? "no EGL display" : reasons, kPackages};
}

}  // namespace slosh
