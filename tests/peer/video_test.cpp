// A film's colours: what the file says of them, and what a player makes of them.
#include "peer/output/video.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "peer/output/child_process.h"

namespace slosh {
namespace {

std::string output_of(const std::vector<std::string>& command) {
  Result<std::unique_ptr<ChildProcess>> child = ChildProcess::start(command);
  EXPECT_TRUE(child);
  const Result<bool> ended = child.value()->finish();
  EXPECT_TRUE(ended) << ended.error().text();
  return child.value()->output();
}

class VideoTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::signal(SIGPIPE, SIG_IGN);
    film_ = std::filesystem::path(::testing::TempDir()) / "video_test_film.mp4";
    Image image{64, 48, std::vector<std::uint8_t>(std::size_t{4} * 64 * 48)};
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
      image.rgba[i] = 200;
      image.rgba[i + 1] = 40;
      image.rgba[i + 2] = 60;
      image.rgba[i + 3] = 255;
    }
    Result<std::unique_ptr<Video>> video = Video::start(film_, 64, 48, 25.0);
    ASSERT_TRUE(video) << video.error().text();
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(video.value()->add(image));
    const Result<bool> finished = video.value()->finish();
    ASSERT_TRUE(finished) << finished.error().text();
  }
  std::filesystem::path film_;
};

TEST_F(VideoTest, TheFileSaysWhatItsColoursAre) {
  const std::string tags = output_of({"ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries",
                                      "stream=color_range,color_space,color_transfer,color_primaries", "-of",
                                      "default", film_.string()});
  for (const char* tag :
       {"color_range=tv", "color_space=bt709", "color_transfer=iec61966-2-1", "color_primaries=bt709"})
    EXPECT_NE(tags.find(tag), std::string::npos) << tag << " in\n" << tags;
}

TEST_F(VideoTest, APlayerThatBelievesTheTagsShowsTheColour) {
  // By BT.709 and 16–235: without believing what the file does not say.
  const std::string pixels =
      output_of({"ffmpeg", "-v", "error", "-i", film_.string(), "-frames:v", "1", "-vf",
                 "scale=in_color_matrix=bt709:in_range=tv", "-pix_fmt", "rgb24", "-f", "rawvideo", "-"});
  ASSERT_EQ(pixels.size(), std::size_t{3} * 64 * 48);
  const std::size_t middle = std::size_t{3} * (24 * 64 + 32);
  const int expected[3] = {200, 40, 60};
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(static_cast<unsigned char>(pixels[middle + c]), expected[c], 4) << c;
}

}  // namespace
}  // namespace slosh
