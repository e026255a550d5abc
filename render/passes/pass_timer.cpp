#include "render/passes/pass_timer.h"

#include <utility>

namespace slosh {

PassTimer::~PassTimer() {
  if (!queries_.empty()) glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

void PassTimer::begin(const char* pass) {
  times_.push_back({pass, 0.0, 0.0});
  if (software_) {
    glFinish();
    start_ = std::chrono::steady_clock::now();
    return;
  }
  start_ = std::chrono::steady_clock::now();
  if (queries_.size() < times_.size()) {
    queries_.push_back(0);
    glCreateQueries(GL_TIME_ELAPSED, 1, &queries_.back());
  }
  glBeginQuery(GL_TIME_ELAPSED, queries_[times_.size() - 1]);
}

void PassTimer::end() {
  if (software_)
    glFinish();
  else
    glEndQuery(GL_TIME_ELAPSED);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start_;
  times_.back().cpu_milliseconds = took.count();
  if (software_) times_.back().milliseconds = took.count();
}

std::vector<PassTime> PassTimer::take() {
  for (std::size_t i = 0; i < times_.size() && !software_; ++i) {
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(queries_[i], GL_QUERY_RESULT, &nanoseconds);
    times_[i].milliseconds = 1e-6 * static_cast<double>(nanoseconds);
  }
  return std::exchange(times_, {});
}

}  // namespace slosh
