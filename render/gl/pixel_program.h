// A pass over pixels as fragments or as a compute shader, from the same file (shaders/pixel_main.glsl).
// Fragments are drawn by the part of a chip that makes pictures, which is little of a data-centre GPU;
// compute shaders run on all of it.
#pragma once

#include <string>
#include <vector>

#include "render/gl/objects.h"

namespace slosh::gl {

/// Triangles in clip space that confine a pass drawn as fragments; a compute shader goes over all pixels.
struct TileDraw {
  const VertexArray* vertices = nullptr;  ///< two floats a corner
  GLsizei corners = 0;
  void operator()() const;
};

/// What a pass over pixels writes.
struct PixelTarget {
  const Texture& texture;
  const Framebuffer& framebuffer;  ///< of that texture alone
  glm::ivec2 size;                 ///< of that texture, pixels
  GLenum format;                   ///< of that texture: a sized one that images can have
};

class PixelProgram {
 public:
  PixelProgram() = default;
  /// `file` ends with pixel_main.glsl. `tiled`: fragments are drawn over the TileDraw given to start().
  /// `prelude`: generated GLSL before the file's own. Where little is done for a pixel, `defines` may say
  /// "EACH n": a compute shader's invocation takes n of them. Errors carry the driver's log.
  static Result<PixelProgram> create(const char* file, bool compute, bool tiled = false,
                                     std::vector<std::string> defines = {}, const std::string& prelude = {});

  /// Its textures and uniforms are set by the caller before. What a compute shader writes nobody reads before
  /// finish_compute().
  void start(const PixelTarget& target, const TileDraw* tiles = nullptr) const;

  const Program& program() const { return program_; }

 private:
  Program program_;
  VertexArray no_vertices_;
  glm::ivec2 group_{0};  ///< pixels
  bool compute_ = false;
};

/// What was written by compute shaders may be read, drawn over, copied and fetched after this.
void finish_compute();

/// Runs a compute shader of 64 invocations a group, `share` for each of `count`, whose uniform `count` it
/// sets.
void run_each(const Program& program, std::size_t count, std::size_t share = 1);

/// The same without finish_compute(): for several in a row that write to different places.
void start_each(const Program& program, std::size_t count, std::size_t share = 1);

/// A compute shader whose groups take `in_group` of `count` each, with no more groups than a chip takes long
/// to start: the shader goes over the rest by turns. It sets the uniform `count`.
void start_by_turns(const Program& program, std::size_t count, std::size_t in_group);

/// So many groups of a compute shader, or fewer that go over the rest by turns: it knows itself how many
/// there are.
void start_groups_by_turns(const Program& program, std::size_t groups);

/// A compute shader that takes one row of splat_rows.glsl for each splat.
class RowProgram {
 public:
  /// `small`: at half the picture's size very many splats are a few pixels each, and their rows shorter.
  /// Errors carry the driver's log.
  static Result<RowProgram> create(const char* file, bool small,
                                   const std::vector<std::string>& defines = {});

  /// What runs for so many: its uniforms are set by the caller, but for `count`.
  const Program& of(std::size_t count) const;
  /// Nobody reads what it writes before finish_compute().
  void start(std::size_t count) const;

 private:
  bool short_rows(std::size_t count) const;

  Program few_;
  Program many_;  ///< where they are small
};

}  // namespace slosh::gl
