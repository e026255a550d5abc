// Drops of foam over what was drawn before them.
#include <cmath>

#include "tests/render/render_test.h"

namespace slosh {
namespace {

class FoamPicture : public RenderTest {
 protected:
  void SetUp() override { renderer_ = make(small()); }
  /// Brightness of the picture's middle.
  float middle(const Frame& frame) {
    renderer_->draw(frame);
    return renderer_->read_buffer(Buffer::kFinalColor).at(kWidth / 2, kHeight / 2, 2);
  }
  std::unique_ptr<Renderer> renderer_;
};

TEST_F(FoamPicture, ADropIsWhiteWhereItIsAndNowhereElse) {
  Frame frame = frame_of({}, {}, 0.01f);
  MeshLook black;
  black.base_color = glm::vec3(0.0f);
  frame.meshes = {place(*renderer_, kit::make_box({-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, -0.2f}), black)};
  const float without = middle(frame);
  const FloatImage before = renderer_->read_buffer(Buffer::kFinalColor);
  std::vector<FoamPoint> foam = {{{0.0f, 0.0f, 0.0f}, 0.03f, 1.0f}};
  frame.foam = foam;
  EXPECT_GT(middle(frame), without + 0.15f);
  const FloatImage after = renderer_->read_buffer(Buffer::kFinalColor);
  EXPECT_EQ(after.at(kWidth / 4, kHeight / 2, 2), before.at(kWidth / 4, kHeight / 2, 2));
  foam[0].opacity = 0.5f;
  const float half = middle(frame);
  foam[0].opacity = 1.0f;
  EXPECT_NEAR(half - without, 0.5f * (middle(frame) - without), 0.02f);
  foam[0].position.z = -0.25f;
  EXPECT_EQ(middle(frame), without) << "behind the box's face";
  foam[0].position.x = std::nanf("");
  EXPECT_EQ(middle(frame), without);
}

TEST_F(FoamPicture, UnderTheSurfaceItFades) {
  std::vector<glm::vec3> points;
  for (int z = 0; z < 8; ++z)
    for (int y = -8; y <= 8; ++y)
      for (int x = -8; x <= 8; ++x) points.emplace_back(0.02f * glm::vec3(x, y, -z));
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.0124f);
  const float without = middle(frame);
  std::vector<FoamPoint> foam = {{{0.0f, 0.0f, 0.02f}, 0.01f, 1.0f}};
  frame.foam = foam;
  const float above = middle(frame) - without;
  foam[0].position.z = -0.02f;
  const float below = middle(frame) - without;
  foam[0].position.z = -0.12f;
  const float deep = middle(frame) - without;
  EXPECT_GT(above, 0.1f);
  EXPECT_LT(below, 0.8f * above);
  EXPECT_LT(std::abs(deep), 0.05f * above);
}

}  // namespace
}  // namespace slosh
