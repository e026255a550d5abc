#include "render/gl/objects.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "render/gl/shader_source.h"

namespace slosh::gl {
namespace {

using Shader = Object<[](GLuint name) { glDeleteShader(name); }>;

std::string info_log(GLuint name, decltype(glGetShaderiv) get, decltype(glGetShaderInfoLog) get_log) {
  GLint length = 0;
  get(name, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  get_log(name, length, nullptr, log.data());
  log.resize(log.find_last_not_of(std::string_view(" \n\0", 3)) + 1);
  return log;
}

Result<Shader> compile(GLenum kind, const char* file, const std::string& text) {
  Shader shader(glCreateShader(kind));
  const char* source = text.c_str();
  glShaderSource(shader.name(), 1, &source, nullptr);
  glCompileShader(shader.name());
  GLint good = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &good);
  if (good) return shader;
  return Error{std::string("shader ") + file, info_log(shader.name(), glGetShaderiv, glGetShaderInfoLog),
               "Report this with the name of your graphics driver"};
}

/// `what`: the files, for the error.
Result<bool> link(GLuint program, std::initializer_list<GLuint> shaders, const std::string& what) {
  for (const GLuint shader : shaders) glAttachShader(program, shader);
  glLinkProgram(program);
  GLint good = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (good) return true;
  return Error{what, info_log(program, glGetProgramiv, glGetProgramInfoLog),
               "Report this with the name of your graphics driver"};
}

}  // namespace

Texture make_texture(glm::ivec2 size, GLenum internal_format, GLenum filter) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glTextureStorage2D(name, 1, internal_format, size.x, size.y);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return Texture(name);
}

Buffer make_buffer() {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  return Buffer(name);
}

VertexArray make_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return VertexArray(name);
}

Framebuffer make_framebuffer(std::initializer_list<const Texture*> colors, const Texture* depth) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  std::vector<GLenum> targets;
  for (const Texture* color : colors) {
    const GLenum target = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(targets.size());
    glNamedFramebufferTexture(name, target, color->name(), 0);
    targets.push_back(target);
  }
  if (depth) glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth->name(), 0);
  if (targets.empty()) targets.push_back(GL_NONE);
  glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(targets.size()), targets.data());
  glNamedFramebufferReadBuffer(name, targets.front());
  return Framebuffer(name);
}

Result<Program> Program::create(const char* vertex, const char* fragment, std::vector<std::string> defines) {
  return create_with(vertex, fragment, std::move(defines), "");
}

Result<Program> Program::create_with(const char* vertex, const char* fragment,
                                     std::vector<std::string> defines, const std::string& prelude) {
  auto vertex_text = shader_source(vertex, defines);
  if (!vertex_text) return vertex_text.error();
  auto fragment_text = shader_source(fragment, defines);
  if (!fragment_text) return fragment_text.error();
  const std::size_t after_version = fragment_text.value().find('\n') + 1;
  fragment_text.value().insert(after_version, prelude);

  auto vertex_shader = compile(GL_VERTEX_SHADER, vertex, vertex_text.value());
  if (!vertex_shader) return vertex_shader.error();
  auto fragment_shader = compile(GL_FRAGMENT_SHADER, fragment, fragment_text.value());
  if (!fragment_shader) return fragment_shader.error();

  Program program(glCreateProgram());
  const auto linked = link(program.name(), {vertex_shader.value().name(), fragment_shader.value().name()},
                           std::string("shaders ") + vertex + " and " + fragment);
  if (!linked) return linked.error();
  return program;
}

Result<Program> Program::create_compute(const char* file, std::vector<std::string> defines,
                                        const std::string& prelude) {
  defines.emplace_back("COMPUTE");
  auto text = shader_source(file, defines);
  if (!text) return text.error();
  text.value().insert(text.value().find('\n') + 1, prelude);
  auto shader = compile(GL_COMPUTE_SHADER, file, text.value());
  if (!shader) return shader.error();
  Program program(glCreateProgram());
  const auto linked = link(program.name(), {shader.value().name()}, std::string("shader ") + file);
  if (!linked) return linked.error();
  return program;
}

void Program::set(const char* uniform, int value) const {
  glProgramUniform1i(name(), glGetUniformLocation(name(), uniform), value);
}
void Program::set(const char* uniform, float value) const {
  glProgramUniform1f(name(), glGetUniformLocation(name(), uniform), value);
}
void Program::set(const char* uniform, const glm::vec2& value) const {
  glProgramUniform2fv(name(), glGetUniformLocation(name(), uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const glm::ivec2& value) const {
  glProgramUniform2iv(name(), glGetUniformLocation(name(), uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const glm::ivec3& value) const {
  glProgramUniform3iv(name(), glGetUniformLocation(name(), uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const glm::vec3& value) const {
  glProgramUniform3fv(name(), glGetUniformLocation(name(), uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const glm::vec4& value) const {
  glProgramUniform4fv(name(), glGetUniformLocation(name(), uniform), 1, glm::value_ptr(value));
}
void Program::set(const char* uniform, const glm::mat4& value) const {
  glProgramUniformMatrix4fv(name(), glGetUniformLocation(name(), uniform), 1, GL_FALSE,
                            glm::value_ptr(value));
}

void bind_textures(std::initializer_list<const Texture*> textures) {
  GLuint unit = 0;
  for (const Texture* texture : textures) glBindTextureUnit(unit++, texture->name());
}

void StreamBuffer::upload(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;
  if (!buffer_) buffer_ = make_buffer();
  // Orphaning the old storage lets the driver go on drawing from it.
  if (bytes.size() > capacity_) capacity_ = bytes.size() + bytes.size() / 2;
  glNamedBufferData(buffer_.name(), static_cast<GLsizeiptr>(capacity_), nullptr, GL_STREAM_DRAW);
  glNamedBufferSubData(buffer_.name(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

void StreamBuffer::reserve(std::size_t bytes) {
  if (!buffer_) buffer_ = make_buffer();
  if (bytes <= capacity_) return;
  capacity_ = bytes + bytes / 2;
  glNamedBufferData(buffer_.name(), static_cast<GLsizeiptr>(capacity_), nullptr, GL_STREAM_DRAW);
}

void StreamBuffer::zero(std::size_t bytes) {
  if (bytes == 0) return;
  reserve(bytes);
  glClearNamedBufferSubData(buffer_.name(), GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER,
                            GL_UNSIGNED_INT, nullptr);
}

}  // namespace slosh::gl
