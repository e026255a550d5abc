#include "render/passes/arrow_pass.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "render/passes/kept_picture.h"

namespace slosh {
namespace {

constexpr int kSides = 16;

struct Ring {
  float along;   ///< m from the arrow's start
  float radius;  ///< m
};

/// The surface between two rings round an axis; a ring of radius 0 is a point.
void append_band(const glm::mat3& axes, const glm::vec3& start, const Ring& a, const Ring& b,
                 const glm::vec3& color, std::vector<ArrowVertex>& out) {
  const glm::vec2 slope =
      glm::normalize(glm::vec2(b.along - a.along, a.radius - b.radius));  // outward, along
  const auto vertex = [&](const Ring& ring, int side) {
    const float angle = glm::two_pi<float>() * static_cast<float>(side) / kSides;
    const glm::vec3 outward = axes[0] * std::cos(angle) + axes[1] * std::sin(angle);
    return ArrowVertex{start + axes[2] * ring.along + outward * ring.radius,
                       outward * slope.x + axes[2] * slope.y, color};
  };
  for (int side = 0; side < kSides; ++side) {
    const ArrowVertex a0 = vertex(a, side);
    const ArrowVertex a1 = vertex(a, side + 1);
    const ArrowVertex b0 = vertex(b, side);
    const ArrowVertex b1 = vertex(b, side + 1);
    out.insert(out.end(), {a0, a1, b1, a0, b1, b0});
  }
}

/// The pixels that they may cover.
PixelBox box_of(std::span<const ArrowVertex> vertices, const View& view, glm::ivec2 size) {
  const glm::mat4 clip_from_world = view.projection * view.view;
  const glm::vec2 picture(size);
  glm::vec2 low(picture), high(0.0f);
  for (const ArrowVertex& vertex : vertices) {
    const glm::vec4 clip = clip_from_world * glm::vec4(vertex.position, 1.0f);
    if (!(clip.w > view.near_plane)) return {glm::ivec2(0), size};  // goes past the eye
    const glm::vec2 pixel =
        glm::clamp((0.5f * glm::vec2(clip) / clip.w + 0.5f) * picture, glm::vec2(0.0f), picture);
    low = glm::min(low, pixel);
    high = glm::max(high, pixel);
  }
  return PixelBox{glm::ivec2(low), glm::ivec2(glm::ceil(high))}.grown(1, size);
}

/// Confines what is drawn to a box, within the one that it is confined to already.
class Confined {
 public:
  explicit Confined(const PixelBox& box) : was_(glIsEnabled(GL_SCISSOR_TEST)) {
    glGetIntegerv(GL_SCISSOR_BOX, &before_.x);
    PixelBox in = box;
    if (was_) {
      in.low = glm::max(in.low, glm::ivec2(before_));
      in.high = glm::min(in.high, glm::ivec2(before_.x + before_.z, before_.y + before_.w));
    }
    const glm::ivec2 size = in.size();
    glEnable(GL_SCISSOR_TEST);
    glScissor(in.low.x, in.low.y, size.x, size.y);
  }
  ~Confined() {
    glScissor(before_.x, before_.y, before_.z, before_.w);
    if (!was_) glDisable(GL_SCISSOR_TEST);
  }
  Confined(const Confined&) = delete;
  Confined& operator=(const Confined&) = delete;

 private:
  GLboolean was_;
  glm::ivec4 before_{0};
};

}  // namespace

void append_arrow(const Arrow& arrow, float eye_distance, std::vector<ArrowVertex>& out) {
  const glm::vec3 way = arrow.to - arrow.from;
  const float length = glm::length(way);
  if (!std::isfinite(length) || !std::isfinite(glm::dot(arrow.from, arrow.to)) || length < 1e-5f) return;
  const float width = std::clamp(0.03f * length, 0.0015f * eye_distance, 0.0035f * eye_distance);
  const float head = std::min(5.0f * width, 0.6f * length);

  glm::mat3 axes;
  axes[2] = way / length;
  const glm::vec3 other =
      std::abs(axes[2].y) < 0.9f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(1.0f, 0.0f, 0.0f);
  axes[0] = glm::normalize(glm::cross(other, axes[2]));
  axes[1] = glm::cross(axes[2], axes[0]);
  const Ring rings[] = {
      {0.0f, 0.0f}, {0.0f, width}, {length - head, width}, {length - head, 2.4f * width}, {length, 0.0f}};
  for (std::size_t i = 0; i + 1 < std::size(rings); ++i) {
    append_band(axes, arrow.from, rings[i], rings[i + 1], arrow.color, out);
  }
}

Result<ArrowPass> ArrowPass::create(const std::vector<std::string>& defines) {
  auto program = gl::Program::create("arrow.vert", "arrow.frag", defines);
  if (!program) return program.error();
  ArrowPass pass;
  pass.program_ = std::move(program.value());
  pass.array_ = gl::make_vertex_array();
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glEnableVertexArrayAttrib(pass.array_.name(), attribute);
    glVertexArrayAttribFormat(pass.array_.name(), attribute, 3, GL_FLOAT, GL_FALSE,
                              attribute * sizeof(glm::vec3));
    glVertexArrayAttribBinding(pass.array_.name(), attribute, 0);
  }
  return pass;
}

void ArrowPass::draw(const Frame& frame, const Targets& targets, const gl::Texture* fluid) {
  vertices_.clear();
  for (const Arrow& arrow : frame.arrows) {
    const float distance = -(frame.view.view * glm::vec4(arrow.from, 1.0f)).z;
    append_arrow(arrow, std::clamp(distance, frame.view.near_plane, frame.view.far_plane), vertices_);
  }
  if (vertices_.empty()) return;
  buffer_.upload(std::span<const ArrowVertex>(vertices_));
  glVertexArrayVertexBuffer(array_.name(), 0, buffer_.name(), 0, sizeof(ArrowVertex));

  program_.use();
  program_.set("has_fluid", fluid ? 1 : 0);
  gl::bind_textures({fluid ? fluid : &targets.scene_depth, &targets.scene_depth});
  const float farthest = 1.0f;
  // Arrows hide each other but are seen through the scene: they get the depth buffer to themselves, which
  // takes longer to clear than they do to draw.
  const Confined confined(box_of(vertices_, frame.view, targets.size));
  glClearNamedFramebufferfv(targets.blend_target.name(), GL_DEPTH, 0, &farthest);
  glBindFramebuffer(GL_FRAMEBUFFER, targets.blend_target.name());
  glViewport(0, 0, targets.size.x, targets.size.y);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(array_.name());
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices_.size()));
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace slosh
