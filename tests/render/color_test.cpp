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
  EXPECT_EQ(error({"/nowhere/studio.ocio", "", ""}).find(".. "), std::string::npos) << "one stop is enough";
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

constexpr const char* kGammaConfig = R"(ocio_profile_version: 2
roles:
  aces_interchange: aces
  default: aces
  scene_linear: aces
displays:
  Projector:
    - !<View> {name: Gamma, colorspace: gamma}
    - !<View> {name: Curve, colorspace: curve}
colorspaces:
  - !<ColorSpace>
    name: aces
  - !<ColorSpace>
    name: gamma
    from_scene_reference: !<GroupTransform>
      children:
        - !<MatrixTransform> {matrix: [0.02, 0.01, 0, 0, 0, 0.03, 0, 0, 0.01, 0.01, 0.01, 0, 0, 0, 0, 1]}
        - !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1], direction: inverse}
  - !<ColorSpace>
    name: curve
    from_scene_reference: !<FileTransform> {src: LUT, interpolation: linear}
)";

/// How the picture of an empty room differs from the transform applied to its light on the CPU, in 255ths.
struct Off {
  double most = 0.0;
  double mean = 0.0;
};

class DisplayShaders : public RenderTest {
 protected:
  Off off(const RenderOptions& options) {
    auto renderer = make(options);
    renderer->draw(frame_of({}, {}, 0.01f));
    const FloatImage light = renderer->read_buffer(Buffer::kFinalColor);
    const Image image = renderer->read_back();
    std::vector<glm::vec3> linear;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x)
        linear.push_back(options.exposure *
                         glm::vec3(light.at(x, y, 0), light.at(x, y, 1), light.at(x, y, 2)));
    }
    const auto expected = display_colors(options.display, linear, options.color);
    EXPECT_TRUE(expected) << expected.error().text();
    Off found;
    for (std::size_t i = 0; expected && i < linear.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const double apart =
            std::abs(image.rgba[4 * i + static_cast<std::size_t>(c)] - 255.0 * expected.value()[i][c]);
        found.most = std::max(found.most, apart);
        found.mean += apart / (3.0 * static_cast<double>(linear.size()));
      }
    }
    return found;
  }
  RenderOptions plain() const {
    RenderOptions options = small();
    options.antialias = options.dither = false;
    return options;
  }
};

TEST_F(DisplayShaders, AMatrixAndAGammaAreExactToTheEight) {
  const File file(kGammaConfig);
  const ColorConfig gamma{file.path(), "Projector", "Gamma"};
  // By hand: Rec.709 to ACES2065-1 (Bradford), the config's matrix, its gamma.
  const glm::vec3 light(20.0f, 7.0f, 2.0f);
  const glm::mat3 to_aces = glm::transpose(glm::mat3(0.4396329, 0.3829886, 0.1773785, 0.0897764, 0.8134394,
                                                     0.0967841, 0.0175412, 0.1115466, 0.8709123));
  const glm::mat3 own = glm::transpose(glm::mat3(0.02, 0.01, 0, 0, 0.03, 0, 0.01, 0.01, 0.01));
  const glm::vec3 right = glm::pow(own * to_aces * light, glm::vec3(1.0f / 2.2f));
  const auto by_cpu = display_colors(Display::kAces, {&light, 1}, gamma);
  ASSERT_TRUE(by_cpu) << by_cpu.error().text();
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(by_cpu.value()[0][c], right[c], 2e-4f);
  const auto text = display_shader(Display::kAces, gamma);
  ASSERT_TRUE(text) << text.error().text();
  ASSERT_TRUE(text.value()) << "it needs no textures";
  std::printf("a matrix and a gamma take %zu characters, ACES %zu, sRGB %zu\n", text.value()->size(),
              display_shader(Display::kAces).value()->size(), display_shader(Display::kSrgb).value()->size());
  // Light far above the table's 32 times white comes out right by the text.
  RenderOptions options = plain();
  options.color = gamma;
  for (const float exposure : {1.0f, 60.0f}) {
    options.exposure = exposure;
    options.display_by = DisplayBy::kSmaller;
    const Off shown = off(options);
    options.display_by = DisplayBy::kTable;
    const Off baked = off(options);
    std::printf("exposure %g: off by %.2f at most, %.3f on the mean by the text; %.2f, %.3f by the table\n",
                double{exposure}, shown.most, shown.mean, baked.most, baked.mean);
    EXPECT_LT(shown.most, 0.51) << "rounded to the nearest of 255";
    EXPECT_GT(baked.most, shown.most);
  }
}

TEST_F(DisplayShaders, TheBuiltInOnesAreExactByTheirTextAndNearByTheTable) {
  for (const Display display : {Display::kAces, Display::kSrgb}) {
    RenderOptions options = plain();
    options.display = display;
    options.display_by = DisplayBy::kText;
    const Off shown = off(options);
    options.display_by = DisplayBy::kTable;
    const Off baked = off(options);
    std::printf("%s: off by %.2f at most, %.3f on the mean by the text; %.2f, %.3f by the table\n",
                display == Display::kAces ? "ACES" : "sRGB", shown.most, shown.mean, baked.most, baked.mean);
    EXPECT_LT(shown.most, 0.55);
    EXPECT_LT(baked.most, 4.0);
  }
}

TEST_F(DisplayShaders, AViewOfALookUpTableHasTheBakedOne) {
  const std::filesystem::path lut =
      std::filesystem::temp_directory_path() / ("slosh-curve-" + std::to_string(getpid()) + ".spi1d");
  std::ofstream(lut) << "Version 1\nFrom 0.0 1.0\nLength 3\nComponents 1\n{\n0.0\n0.7\n1.0\n}\n";
  std::string config = kGammaConfig;
  config.replace(config.find("LUT"), 3, lut.string());
  const File file(config);
  RenderOptions options = plain();
  options.color = {file.path(), "Projector", "Curve"};
  const auto text = display_shader(Display::kAces, options.color);
  ASSERT_TRUE(text) << text.error().text();
  EXPECT_FALSE(text.value()) << "it needs a texture of its own";
  options.display_by = DisplayBy::kText;
  EXPECT_LT(off(options).most, 4.5);
  std::filesystem::remove(lut);
}

}  // namespace
}  // namespace slosh
