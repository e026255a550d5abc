// A headless context shared by one program's tests, and the few things they all do.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "render/environment.h"
#include "render/renderer.h"
#include "tests/render/scene_kit.h"

namespace slosh {

class RenderTest : public ::testing::Test {
 protected:
  static constexpr int kWidth = 192;
  static constexpr int kHeight = 144;

  static void SetUpTestSuite() {
    HeadlessOptions options;
    options.software_threads = 2;
    auto made = make_headless_context(options);
    ASSERT_TRUE(made) << made.error().text();
    context_ = std::move(made.value());
  }
  static void TearDownTestSuite() { context_.reset(); }

  static RenderOptions small() {
    RenderOptions options;
    options.width = kWidth;
    options.height = kHeight;
    options.shadow_size = 256;
    return options;
  }
  /// As bright from every side: nothing of a room is seen in what mirrors or bends light.
  static std::shared_ptr<const Environment> even_room() {
    return std::make_shared<Environment>(Environment{4, 2, std::vector<glm::vec3>(8, glm::vec3(0.5f))});
  }
  /// Eq 15 and nothing else.
  static RenderOptions paper() {
    RenderOptions options = section_five(small());
    options.display = Display::kSrgb;
    return options;
  }
  static std::unique_ptr<Renderer> make(const RenderOptions& options) {
    auto made = Renderer::create(*context_, options);
    EXPECT_TRUE(made) << made.error().text();
    return std::move(made.value());
  }
  /// Nothing, looked at from +z.
  static Frame empty_frame(int width, int height) {
    Frame frame;
    frame.view = kit::make_view({0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}, width, height);
    return frame;
  }
  /// Particles of one fluid, looked at from +z.
  static Frame frame_of(const std::vector<glm::vec3>& particles, const std::vector<std::uint8_t>& fluids,
                        float radius) {
    Frame frame = empty_frame(kWidth, kHeight);
    frame.particles = particles;
    frame.particle_fluid = fluids;
    frame.fluids = {kit::water()};
    frame.particle_radius = radius;
    return frame;
  }
  static MeshInstance place(Renderer& renderer, const kit::Shape& shape, const MeshLook& look = {}) {
    return {renderer.add_mesh(shape.positions, shape.normals, shape.triangles), glm::mat4(1.0f), look};
  }

  static inline std::unique_ptr<Context> context_;
};

}  // namespace slosh
