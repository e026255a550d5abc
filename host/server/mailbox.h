// Work that other threads leave for the network's thread.
#pragma once

#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace slosh {

/// Any thread posts, one thread runs. `wake` is called after each post, by whoever posts.
class Mailbox {
 public:
  using Work = std::function<void()>;

  void set_wake(Work wake) {
    const std::lock_guard lock(mutex_);
    wake_ = std::move(wake);
  }
  void post(Work work) {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(work));
    if (wake_) wake_();
  }
  void wake() {
    const std::lock_guard lock(mutex_);
    if (wake_) wake_();
  }
  void run_all() {
    std::vector<Work> work;
    {
      const std::lock_guard lock(mutex_);
      work.swap(waiting_);
    }
    for (Work& each : work) each();
  }

 private:
  std::mutex mutex_;
  std::vector<Work> waiting_;
  Work wake_;
};

}  // namespace slosh
