#include "tests/render/es/kit.h"

#include <array>

namespace slosh::es {

std::optional<std::string> EsContext::make(std::unique_ptr<EsContext>& out, Context& before) {
  const EGLDisplay display = eglGetCurrentDisplay();
  if (display == EGL_NO_DISPLAY) return "no EGL display is current";
  if (!eglBindAPI(EGL_OPENGL_ES_API)) return "no OpenGL ES";
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) return "no ES 3.0 context";
  out.reset(new EsContext(display, context, before));
  return std::nullopt;
}

EsContext::EsContext(EGLDisplay display, EGLContext context, Context& before)
    : display_(display), context_(context), before_(before) {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

EsContext::~EsContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
  eglBindAPI(EGL_OPENGL_API);
  before_.make_current();
}

GLuint compiled(GLenum kind, const std::string& text, std::string& log) {
  const GLuint shader = glCreateShader(kind);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  std::array<char, 4000> said{};
  glGetShaderInfoLog(shader, said.size(), nullptr, said.data());
  GLint good = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) log += said.data();
  return shader;
}

GLuint es_program(const EsProgram& wish, std::string& log) {
  const auto vertex = es_shader_source(wish.vertex, wish.defines);
  const auto fragment = es_shader_source(wish.fragment, wish.defines);
  if (!vertex || !fragment) {
    log += (vertex ? fragment : vertex).error().text();
    return 0;
  }
  const GLuint program = glCreateProgram();
  for (const auto& [kind, text] : {std::pair{GL_VERTEX_SHADER, &vertex.value().text},
                                   std::pair{GL_FRAGMENT_SHADER, &fragment.value().text}}) {
    const GLuint shader = compiled(static_cast<GLenum>(kind), *text, log);
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint good = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good) {
    std::array<char, 4000> said{};
    glGetProgramInfoLog(program, said.size(), nullptr, said.data());
    log += said.data();
    return 0;
  }
  glUseProgram(program);
  for (const EsShader* shader : {&vertex.value(), &fragment.value()}) {
    for (const EsBinding& texture : shader->textures)
      glUniform1i(glGetUniformLocation(program, texture.name.c_str()), texture.at);
    for (const EsBuffer& buffer : shader->buffers)
      glUniform1i(glGetUniformLocation(program, buffer.sampler.c_str()), buffer.unit);
    for (const EsBinding& block : shader->blocks) {
      const GLuint index = glGetUniformBlockIndex(program, block.name.c_str());
      if (index != GL_INVALID_INDEX) glUniformBlockBinding(program, index, static_cast<GLuint>(block.at));
    }
  }
  return program;
}

GLuint make_texture(glm::ivec2 size, GLenum format, GLenum filter) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, size.x, size.y);
  for (const GLenum which : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, which, static_cast<GLint>(filter));
  for (const GLenum which : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, which, GL_CLAMP_TO_EDGE);
  return name;
}

void bind_texture(int unit, GLuint texture, GLenum kind) {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(kind, texture);
  glActiveTexture(GL_TEXTURE31);  // where none of ours is: what is made later does not take its place
}

GLuint texture_of_items(const std::vector<glm::vec4>& texels) {
  constexpr int kAcross = 512;
  std::vector<glm::vec4> filled = texels;
  filled.resize((texels.size() + kAcross - 1) / kAcross * kAcross);
  const glm::ivec2 size(kAcross, static_cast<int>(filled.size()) / kAcross);
  const GLuint name = make_texture(size, GL_RGBA32F);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, filled.data());
  return name;
}

GLuint make_target(const std::vector<GLuint>& colors, GLuint depth) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  std::vector<GLenum> drawn;
  for (const GLuint color : colors) {
    drawn.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(drawn.size()));
    glFramebufferTexture2D(GL_FRAMEBUFFER, drawn.back(), GL_TEXTURE_2D, color, 0);
  }
  if (depth != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  glDrawBuffers(static_cast<GLsizei>(drawn.size()), drawn.data());
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE ? name : 0;
}

}  // namespace slosh::es
