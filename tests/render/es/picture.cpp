#include "tests/render/es/picture.h"

#include <algorithm>
#include <array>

#include "render/color/display_transform.h"
#include "render/passes/frame_block.h"
#include "render/passes/smooth_centers.h"
#include "render/passes/splats.h"
#include "tests/render/es/canvas.h"
#include "tests/render/es/shadows.h"

namespace slosh::es {
namespace {

/// As passes/surface_filter.cpp and passes/thickness_pass.cpp have them: reach and range in splat radii, taps
/// a side; a summed sphere's radius over a particle's.
constexpr glm::vec3 kFilter(3.8f, 5.0f, 20.0f);
constexpr float kWideChord = 1.5f;
/// As renderer_parts.h has it, m.
constexpr float kOcclusion = 0.06f;
/// As passes/mixing_pass.cpp: particle radii, the first unit of shares.
constexpr float kMixing = 3.6f;
constexpr int kSharesUnit = 12;

class Drawing {
 public:
  Drawing(const Frame& frame, const RenderOptions& options, const KeptMeshes& kept, std::string& log)
      : frame_(frame),
        options_(options),
        size_(options.width, options.height),
        log_(log),
        canvas_(size_, log),
        shadows_(shadows_of(frame, kept, options.shadow_size)) {
    block_at(0, make_frame_block(frame, options, shadows_.view, true));
    std::array<glm::vec4, 4 * kMaxFluidLooks> looks{};
    for (std::size_t i = 0; i < std::min(frame.fluids.size(), kMaxFluidLooks); ++i) {
      const FluidLook& look = frame.fluids[i];
      looks[4 * i] = glm::vec4(look.color, look.displacement);
      looks[4 * i + 1] = glm::vec4(look.extinction, look.scattering);
      looks[4 * i + 2] = glm::vec4(look.specular, look.specular_exponent);
      looks[4 * i + 3] = glm::vec4(look.gloss, look.refraction, look.roughness, 0.0f);
    }
    block_at(1, looks);
    for (const KeptMeshes::Mesh& mesh : kept.meshes) arrays_.push_back(array_of(mesh));
    for (const KeptMeshes::Mesh& mesh : kept.meshes)
      counts_.push_back(static_cast<GLsizei>(3 * mesh.triangles.size()));
  }

  void light() {
    const GLuint map = make_texture(glm::ivec2(shadows_.view.size), GL_DEPTH_COMPONENT32F, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    canvas_.target({}, map, glm::ivec2(shadows_.view.size));
    glClear(GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(2.0f, 4.0f);
    if (!canvas_.use("depth_only.vert", "nothing.frag", {})) return;
    for (const MeshInstance* mesh : shadows_.casters) {
      canvas_.set("clip_from_model", shadows_.view.clip_from_world * mesh->model);
      draw_triangles(*mesh, 0, counts_.at(mesh->mesh));
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_TEST);
    bind_texture(8, map);
    bind_texture(9, fluid_shadow(frame_, options_, shadows_.view, canvas_));
  }

  void opaque_meshes() {
    canvas_.target({mesh_color_, scene_depth_}, depth_);
    const glm::vec4 black(0.0f);
    const glm::vec4 none(kNoFluidDepth);
    const float farthest = 1.0f;
    glClearBufferfv(GL_COLOR, 0, &black.x);
    glClearBufferfv(GL_COLOR, 1, &none.x);
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    if (!canvas_.use("mesh.vert", "mesh.frag", {})) return;
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    for (const GLenum culled : {GL_BACK, GL_FRONT}) {
      glCullFace(culled);
      for (const MeshInstance& mesh : frame_.meshes)
        if (mesh.look.opacity >= 1.0f) draw(mesh);
    }
    glDisable(GL_CULL_FACE);
    // The triangle on the far plane writes no depths.
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, 0, 0);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LEQUAL);
    if (canvas_.use("fullscreen.vert", "background.frag", {})) canvas_.corners(3);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
    canvas_.target({occlusion_}, 0, half_);
    if (!canvas_.use("fullscreen.vert", "occlusion.frag", {"TAPS 8"})) return;
    canvas_.set("reach", kOcclusion);
    canvas_.pixels("occlusion.frag", {"TAPS 8"}, {scene_depth_});
    canvas_.target({color_});
    canvas_.pixels("resolve.frag", {}, {mesh_color_, occlusion_});
  }

  void fluid_depths() {
    prepare_splats(frame_, options_, splats_);
    all_ = splats_.spheres;
    SmoothCenters centers;
    centers.sort(frame_);
    centers.move(frame_, splats_);
    std::vector<glm::vec4> shapes;
    for (const SplatShape& shape : splats_.shapes) {
      shapes.emplace_back(shape.outline, shape.depth_radius);
      shapes.emplace_back(shape.tilt, shape.unused);
    }
    bind_texture(kEsBufferUnit, texture_of_items(splats_.spheres));
    bind_texture(kEsBufferUnit + 1, texture_of_items(shapes));
    glEnable(GL_BLEND);
    const auto count = static_cast<GLsizei>(3 * splats_.spheres.size());
    canvas_.clear_to(front_, size_, kNoFluidDepth);
    glBlendEquation(GL_MIN);
    if (canvas_.use("splat.vert", "splat.frag", {"FRONT", "SHAPED"})) canvas_.corners(count);
    canvas_.clear_to(back_, half_, 0.0f);
    glBlendEquation(GL_MAX);
    if (canvas_.use("splat.vert", "splat.frag", {})) canvas_.corners(count);
    glBlendEquation(GL_FUNC_ADD);
    chords();
    glDisable(GL_BLEND);
  }

  void surface_filter() {
    const float radius = options_.splat_scale * frame_.particle_radius;
    const std::vector<std::string> turns[] = {{"FIRST"}, {}, {"CLEAN"}};
    GLuint from = front_;
    for (int i = 0; i < 3; ++i) {
      const GLuint to = smooth_[i % 2];
      canvas_.clear_to(to, size_, kNoFluidDepth);
      if (!canvas_.use("fullscreen.vert", "narrow_range.frag", turns[i])) return;
      canvas_.set("kernel", kFilter * glm::vec3(radius, radius, 1.0f));
      if (i < 2) glUniform2i(canvas_.at("axis"), 1 - i, i);
      bind_texture(0, from);
      bind_texture(1, scene_depth_);
      canvas_.corners(3);
      from = to;
    }
    surface_ = from;
  }

  /// Far before near; of each the far side first, and each side twice: the share of what is behind, and the
  /// light added.
  void glass(bool behind) {
    std::vector<const MeshInstance*> panes;
    for (const MeshInstance& mesh : frame_.meshes)
      if (mesh.look.opacity < 1.0f) panes.push_back(&mesh);
    canvas_.target({color_}, depth_);
    bind_texture(0, surface_);
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glEnable(GL_CULL_FACE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(0.0f, -16.0f);
    for (const MeshInstance* pane : panes) {
      for (const GLenum culled : {GL_FRONT, GL_BACK}) {
        glCullFace(culled);
        // By triangles: where some of one pane lie over each other, each is laid over those before it.
        for (GLsizei corner = 0; corner < counts_.at(pane->mesh); corner += 3) {
          for (const bool second : {true, false}) {
            glBlendFunc(second ? GL_ZERO : GL_ONE, second ? GL_SRC_COLOR : GL_ONE);
            if (!canvas_.use("mesh.vert", "translucent.frag", pane_defines(behind, second))) return;
            canvas_.set("has_fluid", 1);
            draw(*pane, corner, 3);
          }
        }
      }
    }
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
  }

  /// Shares of the fluids in the surface, four a texture; how many textures.
  int mixing() {
    if (frame_.fluids.size() < 2) return 0;
    const int layers = 1 + static_cast<int>(frame_.fluids.size() - 1) / 4;
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    for (int i = 0; i < layers; ++i) {
      const GLuint shares = make_texture(half_, GL_RGBA16F);
      canvas_.clear_to(shares, half_, 0.0f);
      if (!canvas_.use("mixing.vert", "mixing.frag", {})) return 0;
      canvas_.set("pixels", 2);
      canvas_.set("radius", kMixing * frame_.particle_radius);
      canvas_.set("first", 4 * i);
      bind_texture(0, surface_);
      canvas_.corners(static_cast<GLsizei>(3 * splats_.spheres.size()));
      bind_texture(kSharesUnit + i, shares);
    }
    glDisable(GL_BLEND);
    return layers;
  }

  void composite() {
    std::vector<std::string> defines{"BODIES"};
    if (const int layers = mixing()) defines.push_back("MIXED " + std::to_string(layers));
    canvas_.target({scene_color_});
    canvas_.pixels("copy.frag", {}, {color_});
    canvas_.target({color_});
    if (!canvas_.use("fullscreen.vert", "fluid_look.frag", defines)) return;
    canvas_.set("share_pixels", 2);
    const GLuint read[] = {front_, surface_, back_, scene_depth_, scene_color_, chord_};
    for (int unit = 0; unit < 6; ++unit) bind_texture(unit, read[unit]);
    canvas_.corners(3);
  }

  void display() {
    const auto table = make_display_table(options_.display, options_.color);
    if (!table) {
      log_ += table.error().text();
      return;
    }
    constexpr int n = kDisplayTableSize;
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_3D, name);
    glTexStorage3D(GL_TEXTURE_3D, 1, GL_RGBA8, n, n, n);
    // ES takes no floats for eight bits.
    std::vector<std::uint8_t> bytes;
    for (const glm::vec3& color : table.value()) {
      for (int k = 0; k < 3; ++k)
        bytes.push_back(static_cast<std::uint8_t>(glm::clamp(color[k], 0.0f, 1.0f) * 255.0f + 0.5f));
      bytes.push_back(255);
    }
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, n, n, n, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    for (const GLenum which : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTexParameteri(GL_TEXTURE_3D, which, GL_LINEAR);
    for (const GLenum which : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
      glTexParameteri(GL_TEXTURE_3D, which, GL_CLAMP_TO_EDGE);
    bind_texture(1, name, GL_TEXTURE_3D);
    canvas_.target({sharp_});
    if (!canvas_.use("fullscreen.vert", "display.frag", {})) return;
    bind_texture(0, color_);
    canvas_.set("exposure", options_.exposure);
    canvas_.set("dither", options_.dither ? 1.0f / 255.0f : 0.0f);
    canvas_.set("table_scale", glm::vec2((n - 1.0f) / n, 0.5f / n));
    canvas_.corners(3);
    canvas_.target({shown_});
    canvas_.pixels("edges.frag", {}, {sharp_});
  }

  EsPicture fetched() {
    EsPicture out;
    const auto pixels = static_cast<std::size_t>(size_.x * size_.y);
    out.light.resize(pixels);
    canvas_.target({color_});
    glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_FLOAT, out.light.data());
    std::vector<glm::vec4> depths(pixels);
    canvas_.target({surface_});
    glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_FLOAT, depths.data());
    for (const glm::vec4& depth : depths) out.surface.push_back(depth.x);
    std::vector<std::uint8_t> bytes(4 * pixels);
    canvas_.target({shown_});
    glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    out.shown = {size_.x, size_.y, {}};
    const std::ptrdiff_t row = 4 * std::ptrdiff_t{size_.x};
    for (std::ptrdiff_t y = size_.y; y-- > 0;)
      out.shown.rgba.insert(out.shown.rgba.end(), bytes.begin() + y * row, bytes.begin() + (y + 1) * row);
    if (const GLenum error = glGetError(); error != GL_NO_ERROR) log_ += "error " + std::to_string(error);
    return out;
  }

 private:
  static GLuint array_of(const KeptMeshes::Mesh& mesh) {
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    std::array<GLuint, 3> buffers{};
    glGenBuffers(3, buffers.data());
    for (GLuint i = 0; i < 2; ++i) {
      const std::vector<glm::vec3>& values = i == 0 ? mesh.positions : mesh.normals;
      glBindBuffer(GL_ARRAY_BUFFER, buffers[i]);
      glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(glm::vec3)), values.data(),
                   GL_STATIC_DRAW);
      glEnableVertexAttribArray(i);
      glVertexAttribPointer(i, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(glm::uvec3)),
                 mesh.triangles.data(), GL_STATIC_DRAW);
    return array;
  }

  void chords() {
    canvas_.clear_to(chord_, half_, 0.0f);
    glBlendFunc(GL_ONE, GL_ONE);
    if (!canvas_.use("chord.vert", "chord.frag", {})) return;
    canvas_.set("sphere", glm::vec2(kWideChord * frame_.particle_radius, frame_.particle_radius));
    canvas_.set("pixels", 2);
    bind_texture(0, scene_depth_);
    canvas_.points(all_);
  }

  static std::vector<std::string> pane_defines(bool behind, bool second) {
    std::vector<std::string> defines;
    if (behind) defines.emplace_back("BEHIND");
    if (second) defines.emplace_back(kSecondOutput);
    return defines;
  }
  void draw(const MeshInstance& mesh) { draw(mesh, 0, counts_.at(mesh.mesh)); }
  void draw(const MeshInstance& mesh, GLsizei first, GLsizei count) {
    canvas_.set("model", mesh.model);
    canvas_.set("base", glm::vec4(mesh.look.base_color, glm::clamp(mesh.look.opacity, 0.0f, 1.0f)));
    canvas_.set("roughness", glm::vec2(mesh.look.metallic, mesh.look.roughness));
    draw_triangles(mesh, first, count);
  }
  void draw_triangles(const MeshInstance& mesh, GLsizei first, GLsizei count) const {
    glBindVertexArray(arrays_.at(mesh.mesh));
    const auto* from = reinterpret_cast<const void*>(sizeof(GLuint) * static_cast<std::size_t>(first));
    glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, from);
  }
  const Frame& frame_;
  const RenderOptions& options_;
  glm::ivec2 size_;
  glm::ivec2 half_ = (size_ + 1) / 2;
  std::string& log_;
  Canvas canvas_;
  Shadows shadows_;
  std::vector<GLuint> arrays_;
  std::vector<GLsizei> counts_;
  Splats splats_;
  std::vector<glm::vec4> all_;
  // As passes/targets.h has them; none of depths needs to be looked up between texels.
  GLuint mesh_color_ = make_texture(size_, GL_RGBA16F);
  GLuint occlusion_ = make_texture(half_, GL_R8, GL_LINEAR);
  GLuint color_ = make_texture(size_, GL_RGBA16F);
  GLuint scene_color_ = make_texture(size_, GL_RGBA16F);
  GLuint scene_depth_ = make_texture(size_, GL_R32F);
  GLuint depth_ = make_texture(size_, GL_DEPTH_COMPONENT32F);
  GLuint front_ = make_texture(size_, GL_R32F);
  std::array<GLuint, 2> smooth_{make_texture(size_, GL_R32F), make_texture(size_, GL_R32F)};
  GLuint back_ = make_texture(half_, GL_R32F);
  GLuint chord_ = make_texture(half_, GL_R16F, GL_LINEAR);
  GLuint sharp_ = make_texture(size_, GL_RGBA8, GL_LINEAR);
  GLuint shown_ = make_texture(size_, GL_RGBA8);
  GLuint surface_ = 0;
};

}  // namespace

MeshHandle KeptMeshes::add_mesh(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                std::span<const glm::uvec3> triangles, std::span<const glm::vec2>) {
  meshes.push_back({{positions.begin(), positions.end()},
                    {normals.begin(), normals.end()},
                    {triangles.begin(), triangles.end()}});
  return static_cast<MeshHandle>(meshes.size() - 1);
}

RenderOptions options_in_es(RenderOptions options) {
  options.quality = Quality::kFull;
  options.pixel_passes = PixelPasses::kFragments;
  options.display_by = DisplayBy::kTable;
  return options;
}

std::optional<EsPicture> draw_in_es(const Frame& frame, const RenderOptions& options, const KeptMeshes& kept,
                                    std::string& log) {
  glActiveTexture(GL_TEXTURE31);
  Drawing drawing(frame, options, kept, log);
  drawing.light();
  drawing.opaque_meshes();
  drawing.fluid_depths();
  drawing.surface_filter();
  drawing.glass(true);
  drawing.composite();
  drawing.glass(false);
  drawing.display();
  EsPicture out = drawing.fetched();
  if (!log.empty()) return std::nullopt;
  return out;
}

}  // namespace slosh::es
