#include "peer/output/video.h"

namespace slosh {

Result<std::unique_ptr<Video>> Video::start(const std::filesystem::path& file, int width, int height,
                                            double frames_per_second) {
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  // One thread at a quick preset: the encoder shares its cores with the simulation.
  Result<std::unique_ptr<ChildProcess>> ffmpeg = ChildProcess::start(
      {"ffmpeg", "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgba",
       "-video_size", size, "-framerate", std::to_string(frames_per_second), "-i", "pipe:0", "-vf",
       // The pictures are sRGB over all of 0–255; films are BT.709 over 16–235, and say so.
       "pad=ceil(iw/2)*2:ceil(ih/2)*2,"
       "scale=in_range=full:out_color_matrix=bt709:out_range=tv",
       "-c:v", "libx264", "-preset", "veryfast", "-crf", "20", "-pix_fmt", "yuv420p", "-colorspace", "bt709",
       "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv", "-threads", "1",
       "-movflags", "+faststart", std::filesystem::absolute(file).string()});
  if (!ffmpeg) return ffmpeg.error();
  return std::unique_ptr<Video>(new Video(std::move(ffmpeg.value()), width, height));
}

bool Video::add(const Image& image) {
  if (image.width != width_ || image.height != height_) return false;
  return ffmpeg_->write(image.rgba.data(), image.rgba.size());
}

}  // namespace slosh
