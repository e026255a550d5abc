#include "tests/lab/verbs/on_cores.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace slosh {

bool run_on_cores(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                  const std::function<void(std::size_t)>& told, const std::function<bool()>& stop) {
  std::mutex mutex;
  std::condition_variable ended;
  std::vector<std::size_t> done;  // and not told yet
  std::size_t next = 0;
  bool stopped = false;
  std::exception_ptr thrown;
  const std::size_t cores = threads > 0 ? static_cast<std::size_t>(threads)
                                        : std::max<std::size_t>(std::thread::hardware_concurrency(), 1);
  const std::size_t team = std::min(cores, count);
  std::size_t working = team;

  const auto worker = [&] {
    std::unique_lock lock(mutex);
    while (next < count && !stopped) {
      if (stop()) {
        stopped = true;
        break;
      }
      const std::size_t i = next++;
      lock.unlock();
      std::exception_ptr failure;
      try {
        work(i);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      if (failure) {
        thrown = failure;
        stopped = true;
        break;
      }
      done.push_back(i);
      ended.notify_one();
    }
    working -= 1;
    ended.notify_one();
  };
  std::vector<std::jthread> workers;
  for (std::size_t i = 0; i < team; ++i) workers.emplace_back(worker);

  std::unique_lock lock(mutex);
  while (working > 0 || !done.empty()) {
    ended.wait(lock, [&] { return working == 0 || !done.empty(); });
    std::vector<std::size_t> now;
    now.swap(done);
    lock.unlock();
    for (const std::size_t i : now) told(i);
    lock.lock();
  }
  lock.unlock();
  workers.clear();
  if (thrown) std::rethrow_exception(thrown);
  return !stopped;
}

}  // namespace slosh
