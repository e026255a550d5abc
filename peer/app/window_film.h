// The film of a window or a headset, when a folder was given: what is on show, at a fixed rate of wall time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "peer/output/summary.h"
#include "peer/output/video.h"
#include "render/image.h"

namespace slosh {

class WindowFilm {
 public:
  WindowFilm(std::filesystem::path folder, double frames_per_second)
      : folder_(std::move(folder)), frames_per_second_(frames_per_second) {}

  /// Whether there is to be a film.
  bool wanted() const { return !folder_.empty(); }
  /// Whether the picture on show now is to be one of the film's: then add() it.
  bool due() const;
  void add(Image image);
  void finish(RunSummary& summary);

 private:
  std::filesystem::path folder_;
  double frames_per_second_;
  std::unique_ptr<Video> video_;
  Image image_;
  std::int64_t next_ns_ = 0;
  std::uint64_t frames_ = 0;
  std::string problem_;
};

}  // namespace slosh
