#include "host/server/net_loop.h"

#include <time.h>

#include <chrono>
#include <future>
#include <memory>

#include "net/clock.h"

namespace slosh {
namespace {

/// ns that last words have at most: an endpoint lets each connection wait for its answer for 8 round trips, a
/// second at most. Whoever goes on sending after that is told again, for kAgain: over a link that loses
/// packets one word is not enough, and who never hears it tries to come back for minutes.
constexpr std::int64_t kFarewell = 2'000'000'000;
constexpr std::int64_t kAgain = 100'000'000;

double thread_seconds() {
  timespec spent{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

}  // namespace

void NetLoop::start() {
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
}

void NetLoop::run() {
  while (!stop_.load(std::memory_order_relaxed)) {
    endpoint_.run_once(server_.next_turn_ns());
    server_.turn();
    quit_.store(server_.quit_asked(), std::memory_order_relaxed);
    cpu_seconds_.store(thread_seconds(), std::memory_order_relaxed);
    if (pulse_ != nullptr) pulse_->fetch_add(1, std::memory_order_relaxed);
  }
  if (pulse_ != nullptr) pulse_->store(0, std::memory_order_relaxed);
}

void NetLoop::stop(const std::string& why) {
  if (!thread_.joinable()) return;
  stop_.store(true, std::memory_order_relaxed);
  server_.mailbox().wake();
  thread_.join();
  // The thread is over: its work is this one's now.
  server_.end(why);
  if (endpoint_.endpoint_stats().connections == 0) return;
  const auto run_until = [this](std::int64_t until, auto&& done) {
    while (!done() && steady_now_ns() < until)
      endpoint_.run_once(std::min(until, steady_now_ns() + 20'000'000));
  };
  run_until(steady_now_ns() + kFarewell, [this] { return endpoint_.endpoint_stats().connections == 0; });
  run_until(steady_now_ns() + kAgain, [] { return false; });
}

template <class T, class Work>
T NetLoop::on_thread(Work work) {
  if (!thread_.joinable()) return work();
  auto promise = std::make_shared<std::promise<T>>();
  std::future<T> answer = promise->get_future();
  server_.mailbox().post([promise, work] { promise->set_value(work()); });
  if (answer.wait_for(std::chrono::seconds(5)) != std::future_status::ready) return T{};
  return answer.get();
}

Outcome NetLoop::ask(const std::string& line) {
  return on_thread<Outcome>([this, line] { return server_.command(line); });
}

ServerFigures NetLoop::figures() {
  return on_thread<ServerFigures>([this] { return server_.figures(); });
}

}  // namespace slosh
