#include "peer/app/window_film.h"

#include <algorithm>

#include "net/clock.h"

namespace slosh {

namespace {
constexpr std::int64_t kLongestGap = 1'000'000'000;  // ns
}

bool WindowFilm::due() const {
  return !folder_.empty() && (frames_ == 0 || steady_now_ns() >= next_ns_);
}

void WindowFilm::add(Image image) {
  if (folder_.empty()) return;
  const std::int64_t now = steady_now_ns();
  const std::int64_t period = to_nanoseconds(1.0 / frames_per_second_);
  if (frames_ == 0) next_ns_ = now;
  // Where pictures come slower than the film runs, each stands in it for as long as it was on show. A longer
  // gap, a headset taken off, is left out.
  std::int64_t missed = std::max<std::int64_t>((now - next_ns_) / period, 0);
  if (missed * period > kLongestGap) {
    missed = 0;
    next_ns_ = now;
  }
  next_ns_ += (missed + 1) * period;
  for (; video_ && missed > 0; --missed, ++frames_) (void)video_->add(image_);
  image_ = std::move(image);
  if (!video_) {
    Result<std::unique_ptr<Video>> started =
        Video::start(folder_ / "view.mp4", image_.width, image_.height, frames_per_second_);
    if (!started) {
      problem_ = started.error().text();
      folder_.clear();
      return;
    }
    video_ = std::move(started.value());
  }
  // The window was resized, or the headset taken off: the film keeps its size and waits until the picture has
  // it again.
  (void)video_->add(image_);
  frames_ += 1;
}

void WindowFilm::finish(RunSummary& summary) {
  if (video_) {
    const Result<bool> finished = video_->finish();
    if (!finished) problem_ = finished.error().text();
    const Result<std::filesystem::path> written = write_png(folder_ / "final.png", image_);
    if (!written) problem_ = written.error().text();
    if (problem_.empty()) summary.files.insert(summary.files.end(), {"view.mp4", "final.png"});
  }
  if (!problem_.empty()) summary.problems.push_back("the film: " + problem_);
}

}  // namespace slosh
