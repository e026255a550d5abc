// The shader files in OpenGL ES 3.0's dialect: they compile in such a context, and what one draws there is
// what the renderer drew.
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <string>
#include <utility>

#include "render/gl/es_source.h"
#include "render/passes/frame_block.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

/// An ES 3.0 context, current while it lives; the context that was current before is so again after.
class EsContext {
 public:
  static std::optional<std::string> make(std::unique_ptr<EsContext>& out, Context& before) {
    const EGLDisplay display = eglGetCurrentDisplay();
    if (display == EGL_NO_DISPLAY) return "no EGL display is current";
    if (!eglBindAPI(EGL_OPENGL_ES_API)) return "no OpenGL ES";
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) return "no ES 3.0 context";
    out.reset(new EsContext(display, context, before));
    return std::nullopt;
  }
  ~EsContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglBindAPI(EGL_OPENGL_API);
    before_.make_current();
  }

 private:
  EsContext(EGLDisplay display, EGLContext context, Context& before)
      : display_(display), context_(context), before_(before) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }
  EGLDisplay display_;
  EGLContext context_;
  Context& before_;
};

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

/// A linked program with its samplers and blocks bound, or 0 with why in `log`.
GLuint es_program(const char* vertex, const char* fragment, const std::vector<std::string>& defines,
                  std::string& log) {
  const auto vertex_text = es_shader_source(vertex, defines);
  const auto fragment_text = es_shader_source(fragment, defines);
  if (!vertex_text || !fragment_text) {
    log += (vertex_text ? fragment_text : vertex_text).error().text();
    return 0;
  }
  const GLuint program = glCreateProgram();
  glAttachShader(program, compiled(GL_VERTEX_SHADER, vertex_text.value().text, log));
  glAttachShader(program, compiled(GL_FRAGMENT_SHADER, fragment_text.value().text, log));
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
  for (const EsBinding& texture : fragment_text.value().textures)
    glUniform1i(glGetUniformLocation(program, texture.name.c_str()), texture.at);
  for (const EsBinding& block : fragment_text.value().blocks) {
    const GLuint index = glGetUniformBlockIndex(program, block.name.c_str());
    if (index != GL_INVALID_INDEX) glUniformBlockBinding(program, index, static_cast<GLuint>(block.at));
  }
  return program;
}

/// A texture at a unit; rows top first, as read_buffer() gives them.
void texture_at(GLuint unit, const FloatImage& image) {
  FloatImage turned = image;
  const auto row = static_cast<std::size_t>(image.width * image.channels);
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y)
    std::copy_n(image.values.begin() + static_cast<std::ptrdiff_t>(y * row), row,
                turned.values.end() - static_cast<std::ptrdiff_t>((y + 1) * row));
  GLuint name = 0;
  glGenTextures(1, &name);
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexImage2D(GL_TEXTURE_2D, 0, image.channels == 1 ? GL_R32F : GL_RGB32F, image.width, image.height, 0,
               image.channels == 1 ? GL_RED : GL_RGB, GL_FLOAT, turned.values.data());
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
}

template <class Block>
void block_at(GLuint binding, const Block& block) {
  GLuint name = 0;
  glGenBuffers(1, &name);
  glBindBuffer(GL_UNIFORM_BUFFER, name);
  glBufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STATIC_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, name);
}

using EsShaders = RenderTest;

TEST_F(EsShaders, PassesOverPixelsAndMeshesCompile) {
  std::unique_ptr<EsContext> es;
  if (const auto why = EsContext::make(es, *context_)) GTEST_SKIP() << *why;
  EXPECT_NE(std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))).find("OpenGL ES 3"),
            std::string::npos);
  struct Pair {
    const char* vertex;
    const char* fragment;
    std::vector<std::string> defines;
  };
  const std::vector<std::string> far_light{"FAR_LIGHT 256", "BLURRED_FAR_LIGHT 64"};
  const Pair pairs[] = {
      {"tiles.vert", "fluid_look.frag", {}},
      {"tiles.vert", "fluid_look.frag", {"FAST"}},
      {"tiles.vert", "fluid_look.frag", {"BODIES"}},
      {"tiles.vert", "fluid_look.frag", far_light},
      {"tiles.vert", "composite.frag", {}},
      {"tiles.vert", "composite.frag", far_light},
      {"tiles.vert", "narrow_range.frag", {}},
      {"tiles.vert", "narrow_range.frag", {"FIRST"}},
      {"tiles.vert", "narrow_range.frag", {"CLEAN"}},
      {"tiles.vert", "smooth.frag", {}},
      {"tiles.vert", "curvature_flow.frag", {}},
      {"tiles.vert", "thickness.frag", {}},
      {"tiles.vert", "normal.frag", {}},
      {"chord.vert", "chord.frag", {}},
      {"fluid_shadow.vert", "fluid_shadow.frag", {}},
      {"fullscreen.vert", "background.frag", {}},
      {"fullscreen.vert", "background.frag", far_light},
      {"fullscreen.vert", "occlusion.frag", {"TAPS 8"}},
      {"fullscreen.vert", "resolve.frag", {}},
      {"fullscreen.vert", "copy.frag", {}},
      {"fullscreen.vert", "fill.frag", {}},
      {"fullscreen.vert", "display.frag", {}},
      {"fullscreen.vert", "edges.frag", {}},
      {"mesh.vert", "mesh.frag", {}},
      {"mesh.vert", "mesh.frag", {"FAST", "TEXTURED", "BASE_MAP", "NORMAL_MAP", "METAL_ROUGH_MAP"}},
      {"mesh.vert", "mesh.frag", far_light},
      {"arrow.vert", "arrow.frag", {}},
      {"foam.vert", "foam.frag", {"FAST"}},
  };
  for (const Pair& pair : pairs) {
    std::string log;
    EXPECT_NE(es_program(pair.vertex, pair.fragment, pair.defines, log), 0u)
        << pair.vertex << ", " << pair.fragment << ": " << log;
  }
}

TEST_F(EsShaders, WhatEsLacksIsNamed) {
  for (const auto& [file, what] :
       {std::pair{"splat.vert", "storage buffers"}, std::pair{"splat.comp", "storage buffers"},
        std::pair{"translucent.frag", "two outputs"}}) {
    const auto text = es_shader_source(file);
    ASSERT_FALSE(text) << file;
    EXPECT_NE(text.error().text().find(what), std::string::npos) << text.error().text();
  }
  const std::vector<std::string> mixed{"MIXED 1"};
  EXPECT_FALSE(es_shader_source("fluid_look.frag", mixed)) << "takes its textures by a loop's number";
  const std::vector<std::string> compute{"COMPUTE"};
  EXPECT_FALSE(es_shader_source("copy.frag", compute));
  EXPECT_TRUE(es_shader_source("copy.frag"));
  EXPECT_FALSE(es_shader_source("no such file"));
}

TEST_F(EsShaders, BindingsAreToldInPlaceOfTheText) {
  const EmbeddedShader files[] = {{"a",
                                   "layout(std140, binding = 3) uniform Block { vec4 x; };\n"
                                   "layout(binding = 7) uniform sampler2D seen;  // what for\n"
                                   "layout(location = 0) out vec4 color;\n"}};
  const auto text = es_shader_source("a", {}, files);
  ASSERT_TRUE(text);
  EXPECT_EQ(text.value().text.find("binding"), std::string::npos);
  EXPECT_NE(text.value().text.find("layout(location = 0) out"), std::string::npos);
  EXPECT_EQ(text.value().textures, (std::vector<EsBinding>{{"seen", 7}}));
  EXPECT_EQ(text.value().blocks, (std::vector<EsBinding>{{"Block", 3}}));
}

TEST_F(EsShaders, TheFluidLooksAsTheRendererDrewIt) {
  RenderOptions options = small();
  options.shadow_size = 0;
  options.layers = false;
  options.quality = Quality::kFull;
  options.pixel_passes = PixelPasses::kFragments;
  const auto renderer = make(options);
  kit::DamBreak scene(*renderer, 2500, kWidth, kHeight);
  scene.frame.meshes.resize(3);  // without the glass, which is blended over the fluid
  renderer->draw(scene.frame);
  const FloatImage drawn = renderer->read_buffer(Buffer::kFinalColor);
  const std::pair<GLuint, FloatImage> read[] = {{0, renderer->read_buffer(Buffer::kFrontDepth)},
                                                {1, renderer->read_buffer(Buffer::kSmoothDepth)},
                                                {2, renderer->read_buffer(Buffer::kBackDepth)},
                                                {3, renderer->read_buffer(Buffer::kSceneDepth)},
                                                {4, renderer->read_buffer(Buffer::kSceneColor)}};
  const FloatImage thickness = renderer->read_buffer(Buffer::kThickness);

  std::unique_ptr<EsContext> es;
  if (const auto why = EsContext::make(es, *context_)) GTEST_SKIP() << *why;
  std::string log;
  const GLuint program = es_program("fullscreen.vert", "fluid_look.frag", {"BODIES"}, log);
  ASSERT_NE(program, 0u) << log;
  for (const auto& [unit, image] : read) texture_at(unit, image);
  block_at(0, make_frame_block(scene.frame, options, {}, false));
  const FluidLook& look = scene.frame.fluids.front();
  block_at(1, std::array<glm::vec4, 4 * kMaxFluidLooks>{
                  glm::vec4(look.color, look.displacement), glm::vec4(look.extinction, look.scattering),
                  glm::vec4(look.specular, look.specular_exponent),
                  glm::vec4(look.gloss, look.refraction, look.roughness, 0.0f)});
  GLuint target = 0;
  GLuint color = 0;
  glGenFramebuffers(1, &target);
  glGenRenderbuffers(1, &color);
  glBindRenderbuffer(GL_RENDERBUFFER, color);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, kWidth, kHeight);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    GTEST_SKIP() << "no float pictures in this ES 3.0";
  glViewport(0, 0, kWidth, kHeight);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<glm::vec4> pixels(static_cast<std::size_t>(kWidth * kHeight));
  glReadPixels(0, 0, kWidth, kHeight, GL_RGBA, GL_FLOAT, pixels.data());
  ASSERT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));

  int fluid = 0;
  int off = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto top_first = static_cast<std::size_t>((kHeight - 1 - y) * kWidth + x);
      if (thickness.values[top_first] <= 0.0f) continue;
      ++fluid;
      const glm::vec3 here(pixels[static_cast<std::size_t>(y * kWidth + x)]);
      const glm::vec3 there = glm::make_vec3(&drawn.values[3 * top_first]);
      // Half floats there, whole ones here.
      off += glm::length(here - there) > 2e-3f * glm::length(there) + 1e-4f ? 1 : 0;
    }
  }
  EXPECT_GT(fluid, 3000);
  EXPECT_LT(off, fluid / 1000 + 1) << "of " << fluid << " pixels";
}

}  // namespace
}  // namespace slosh
