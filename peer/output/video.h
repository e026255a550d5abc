// Pictures to an mp4, through ffmpeg.
#pragma once

#include <filesystem>
#include <memory>

#include "peer/output/child_process.h"
#include "render/image.h"

namespace slosh {

/// H.264, yuv420p, playable in browsers. The file is whole after finish(), and also when this program dies:
/// ffmpeg sees its input end and completes the file.
class Video {
 public:
  /// Odd sizes are padded by a pixel (yuv420p needs even ones). Errors: ffmpeg is missing.
  static Result<std::unique_ptr<Video>> start(const std::filesystem::path& file, int width, int height,
                                              double frames_per_second);
  /// False when ffmpeg is gone or the picture has another size.
  bool add(const Image& image);
  /// Errors: ffmpeg failed. No picture was added: no file, no error.
  Result<bool> finish() { return ffmpeg_->finish(); }

 private:
  Video(std::unique_ptr<ChildProcess> ffmpeg, int width, int height)
      : ffmpeg_(std::move(ffmpeg)), width_(width), height_(height) {}
  std::unique_ptr<ChildProcess> ffmpeg_;
  int width_;
  int height_;
};

}  // namespace slosh
