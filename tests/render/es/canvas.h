// Textures that are drawn into by programs of the ES dialect, each made once: what every pass does.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/render/es/kit.h"

namespace slosh::es {

class Canvas {
 public:
  /// size: of a target that none is told for. What goes wrong is appended to `log`.
  Canvas(glm::ivec2 size, std::string& log);

  /// False: the driver refuses it.
  bool use(const char* vertex, const char* fragment, const std::vector<std::string>& defines);
  GLuint program() const { return program_; }
  GLint at(const char* uniform) const { return glGetUniformLocation(program_, uniform); }
  void set(const char* uniform, float value) const { glUniform1f(at(uniform), value); }
  void set(const char* uniform, int value) const { glUniform1i(at(uniform), value); }
  void set(const char* uniform, glm::vec2 value) const { glUniform2fv(at(uniform), 1, &value.x); }
  void set(const char* uniform, glm::vec3 value) const { glUniform3fv(at(uniform), 1, &value.x); }
  void set(const char* uniform, glm::vec4 value) const { glUniform4fv(at(uniform), 1, &value.x); }
  void set(const char* uniform, const glm::mat4& value) const {
    glUniformMatrix4fv(at(uniform), 1, GL_FALSE, &value[0].x);
  }

  void target(const std::vector<GLuint>& colors, GLuint depth = 0);
  void target(const std::vector<GLuint>& colors, GLuint depth, glm::ivec2 size);
  void clear_to(GLuint texture, glm::ivec2 size, float value);
  /// Triangles' corners that the vertex shader counts.
  void corners(GLsizei count) const;
  /// Points of a vec4 each.
  void points(const std::vector<glm::vec4>& at) const;
  /// A pass over all pixels of a target that is set.
  void pixels(const char* file, const std::vector<std::string>& defines, const std::vector<GLuint>& read);

 private:
  glm::ivec2 size_;
  std::string& log_;
  std::map<std::string, GLuint> programs_;
  GLuint program_ = 0;
  GLuint nothing_ = 0;
};

}  // namespace slosh::es
