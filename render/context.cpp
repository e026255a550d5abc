#include "render/context.h"

#include <epoxy/gl.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <mutex>
#include <set>
#include <string_view>
#include <tuple>

namespace slosh {
namespace {

/// Logs each warning or error of GL once a process: a broken call would repeat every frame.
void GLAPIENTRY log_gl_message(GLenum source, GLenum kind, GLuint id, GLenum severity, GLsizei length,
                               const GLchar* message, const void*) {
  if (severity != GL_DEBUG_SEVERITY_HIGH && severity != GL_DEBUG_SEVERITY_MEDIUM) return;
  static std::mutex mutex;
  static std::set<std::tuple<GLenum, GLenum, GLuint, std::string>> said;
  const std::string text(
      message, length < 0 ? std::char_traits<char>::length(message) : static_cast<std::size_t>(length));
  const std::lock_guard lock(mutex);
  if (!said.insert({source, kind, id, text}).second) return;
  if (kind == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH) {
    spdlog::error("OpenGL: {}", text);
  } else {
    spdlog::warn("OpenGL: {}", text);
  }
}

std::string gl_string(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "unknown";
}

}  // namespace

void Context::describe_current() {
  const std::string renderer = gl_string(GL_RENDERER);
  description_ = renderer + ", " + gl_string(GL_VERSION);
  for (std::string_view name : {"llvmpipe", "softpipe", "swrast", "Software Rasterizer"}) {
    if (renderer.find(name) != std::string::npos) is_software_ = true;
  }
  glEnable(GL_DEBUG_OUTPUT);
  glDebugMessageCallback(log_gl_message, nullptr);
}

bool display_available() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
    const char* value = std::getenv(name);
    if (value && *value) return true;
  }
  return false;
}

}  // namespace slosh
