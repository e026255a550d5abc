// A user's OpenColorIO configuration: found by name, refused with a sentence, drawn with.
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "net/text/clean.h"
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
              ("slosh-color-" + std::to_string(getpid()) + "-" + std::to_string(++count_) + ".ocio")) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  static inline int count_ = 0;
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

// A file from a stranger, in which displays, views and keys are called what would move a terminal.
TEST(ColorConfigs, NamesOfAStrangersFileAreShownAsText) {
  const std::string name = R"("\e]0;owned\x07\x9b2J\u202e`touch obeyed`")";
  const std::string shown = "?]0;owned??2J`touch obeyed`";
  std::string hostile = kConfig;
  const auto rename = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = hostile.find(from, at)) != std::string::npos; at += to.size())
      hostile.replace(at, from.size(), to);
  };
  rename("Projector", name);
  rename("Half", name);
  hostile += "    \"\\e[2Junknown\": 1\n";
  const File file(hostile);
  const auto error = [](const ColorConfig& asked) {
    const auto found = find_display_view(asked);
    return found ? std::string() : found.error().text();
  };
  ::testing::internal::CaptureStderr();
  std::string all;
  for (const ColorConfig& asked :
       {ColorConfig{file.path(), "Phone", ""},
        ColorConfig{file.path(), "\x1b]0;owned\x07\u009b2J`touch obeyed`", "x"},
        ColorConfig{file.path(), "", "no \x1b[2J view"}, ColorConfig{"/nowhere/\x1b[2J.ocio", "", ""}}) {
    const std::string said = error(asked);
    EXPECT_NE(said, "");
    EXPECT_EQ(text_problem(said), "") << clean_text(said, 4000);
    all += said;
  }
  EXPECT_NE(all.find(shown), std::string::npos) << all;
  std::string broken = hostile;
  broken.replace(broken.find("!<View>"), 7, "!<\x1b[2J>");
  broken += "\x1b[2J: [";
  const File second(broken);
  EXPECT_EQ(text_problem(error({second.path(), "", ""})), "");
  const std::string warned = ::testing::internal::GetCapturedStderr();
  for (std::size_t at = 0, end = 0; at < warned.size(); at = end + 1) {
    end = std::min(warned.find('\n', at), warned.size());
    EXPECT_EQ(text_problem(warned.substr(at, end - at)), "") << "what the library says by itself";
  }
  EXPECT_NE(warned.find("unknown"), std::string::npos) << "the library warns: " << warned;
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
