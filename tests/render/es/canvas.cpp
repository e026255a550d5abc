#include "tests/render/es/canvas.h"

namespace slosh::es {

Canvas::Canvas(glm::ivec2 size, std::string& log) : size_(size), log_(log) {
  glGenVertexArrays(1, &nothing_);
}

bool Canvas::use(const char* vertex, const char* fragment, const std::vector<std::string>& defines) {
  std::string key = std::string(vertex) + " " + fragment;
  for (const std::string& define : defines) key += " " + define;
  const auto [known, anew] = programs_.try_emplace(key, 0);
  if (anew) known->second = es_program({vertex, fragment, defines}, log_);
  program_ = known->second;
  glUseProgram(program_);
  return program_ != 0;
}

void Canvas::target(const std::vector<GLuint>& colors, GLuint depth) {
  target(colors, depth, size_);
}

void Canvas::target(const std::vector<GLuint>& colors, GLuint depth, glm::ivec2 size) {
  if (make_target(colors, depth) == 0) log_ += "no float pictures in this ES 3.0; ";
  glViewport(0, 0, size.x, size.y);
}

void Canvas::clear_to(GLuint texture, glm::ivec2 size, float value) {
  target({texture}, 0, size);
  const glm::vec4 all(value);
  glClearBufferfv(GL_COLOR, 0, &all.x);
}

void Canvas::corners(GLsizei count) const {
  glBindVertexArray(nothing_);
  glDrawArrays(GL_TRIANGLES, 0, count);
}

void Canvas::points(const std::vector<glm::vec4>& at) const {
  GLuint array = 0;
  GLuint buffer = 0;
  glGenVertexArrays(1, &array);
  glGenBuffers(1, &buffer);
  glBindVertexArray(array);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(at.size() * sizeof(glm::vec4)), at.data(),
               GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, nullptr);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(at.size()));
}

void Canvas::pixels(const char* file, const std::vector<std::string>& defines,
                    const std::vector<GLuint>& read) {
  if (!use("fullscreen.vert", file, defines)) return;
  for (std::size_t unit = 0; unit < read.size(); ++unit) bind_texture(static_cast<int>(unit), read[unit]);
  corners(3);
}

}  // namespace slosh::es
