// A user's OpenColorIO configuration: found by name, refused with a sentence, drawn with.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "render/color/display_transform.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

constexpr const char* kConfig = R"(ocio_profile_version: 2
roles:
  aces_interchange: aces
  default: aces
  scene_linear: aces
displays:
  Projector:
    - !<View> {name: Half, colorspace: half}
    - !<View> {name: Raw, colorspace: aces}
  Monitor:
    - !<View> {name: Raw, colorspace: aces}
colorspaces:
  - !<ColorSpace>
    name: aces
  - !<ColorSpace>
    name: half
    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
)";

/// A file that is there while the test runs.
class File {
 public:
  explicit File(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("slosh-color-" + std::to_string(getpid()) + ".ocio")) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

TEST(ColorConfigs, DisplayAndViewAreFoundByNameOrTheFirst) {
  const File file(kConfig);
  const auto first = find_display_view({file.path(), "", ""});
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_EQ(first.value().display, "Projector");
  EXPECT_EQ(first.value().view, "Half");
  const auto named = find_display_view({file.path(), "Monitor", ""});
  ASSERT_TRUE(named) << named.error().text();
  EXPECT_EQ(named.value().view, "Raw");
}

TEST(ColorConfigs, WhatIsNotThereIsNamedWithWhatIs) {
  const File file(kConfig);
  const auto error = [](const ColorConfig& asked) {
    const auto found = find_display_view(asked);
    return found ? std::string() : found.error().text();
  };
  EXPECT_NE(error({file.path(), "Projector", "Film"}).find("has no view 'Film'"), std::string::npos);
  EXPECT_NE(error({file.path(), "Projector", "Film"}).find("'Half', 'Raw'"), std::string::npos);
  EXPECT_NE(error({file.path(), "Phone", ""}).find("'Projector', 'Monitor'"), std::string::npos);
  EXPECT_NE(error({"/nowhere/studio.ocio", "", ""}).find("/nowhere/studio.ocio"), std::string::npos);
  const File cut(std::string(kConfig).substr(0, 200));
  EXPECT_NE(error({cut.path(), "", ""}), "");
  std::string no_role = kConfig;
  no_role.replace(no_role.find("  aces_interchange: aces\n"), 25, "");
  const File mute(no_role);
  EXPECT_NE(error({mute.path(), "", ""}).find("aces_interchange"), std::string::npos);
}

TEST(ColorConfigs, LightGoesThroughTheUsersView) {
  const File file(kConfig);
  const ColorConfig half{file.path(), "Projector", "Half"};
  const std::vector<glm::vec3> grey{glm::vec3(0.4f), glm::vec3(5.0f)};
  const auto shown = display_colors(Display::kAces, grey, half);
  ASSERT_TRUE(shown) << shown.error().text();
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(shown.value()[0][c], 0.2f, 2e-3f) << "grey stays grey from one white to the other";
    EXPECT_EQ(shown.value()[1][c], 1.0f);
  }
}

class ColorPictures : public RenderTest {};

TEST_F(ColorPictures, AreDrawnWithIt) {
  const File file(kConfig);
  RenderOptions options = small();
  options.antialias = false;
  options.color = {file.path(), "Projector", "Half"};
  auto renderer = make(options);
  renderer->draw(frame_of({}, {}, 0.01f));
  const FloatImage light = renderer->read_buffer(Buffer::kFinalColor);
  const Image image = renderer->read_back();
  for (int y = 5; y < kHeight; y += 20) {
    const glm::vec3 linear(light.at(50, y, 0), light.at(50, y, 1), light.at(50, y, 2));
    const auto expected = display_colors(Display::kAces, std::span(&linear, 1), options.color);
    ASSERT_TRUE(expected);
    for (int c = 0; c < 3; ++c) {
      const std::size_t at = std::size_t{4} * (static_cast<std::size_t>(y) * kWidth + 50);
      EXPECT_NEAR(image.rgba[at + static_cast<std::size_t>(c)], 255.0f * expected.value()[0][c], 4.0f);
    }
  }
  options.color.view = "Film";
  EXPECT_FALSE(renderer->set_options(options));
  EXPECT_EQ(renderer->options().color.view, "Half") << "the old ones stay";
}

}  // namespace
}  // namespace slosh
