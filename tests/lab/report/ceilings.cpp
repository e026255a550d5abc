#include "tests/lab/report/ceilings.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>
#include <vector>

namespace slosh::report {
namespace {

/// work(thread) on all of them at once; returns s.
double time_on_threads(int threads, const std::function<void(int)>& work) {
  std::vector<std::thread> team;
  const auto begin = std::chrono::steady_clock::now();
  for (int t = 1; t < threads; ++t) team.emplace_back(work, t);
  work(0);
  for (std::thread& each : team) each.join();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// The widest vector that is one register, and as many as hide a multiply-add's latency.
#ifdef __AVX512F__
constexpr int kVectorBytes = 64;
#else
constexpr int kVectorBytes = 32;
#endif
using Lanes = float __attribute__((vector_size(kVectorBytes)));
constexpr int kChains = 10;
constexpr int kRounds = 4'000'000;

/// Returns a value that depends on all of it.
float multiply_and_add(int thread) {
  Lanes chain[kChains];
  for (int k = 0; k < kChains; ++k) chain[k] = Lanes{} + static_cast<float>(k + thread);
  const Lanes factor = Lanes{} + 0.999f, term = Lanes{} + 0.001f;
  for (int i = 0; i < kRounds; ++i) {
    for (Lanes& each : chain) each = each * factor + term;
  }
  Lanes sum{};
  for (const Lanes& each : chain) sum += each;
  return sum[0];
}

}  // namespace

Ceilings cpu_ceilings(int threads, std::size_t megabytes) {
  if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const std::size_t count = megabytes * 1'000'000 / sizeof(float);
  std::vector<float> a(count), b(count, 1.0f), c(count, 2.0f);
  const auto part = [&](int t) {
    return count * static_cast<std::size_t>(t) / static_cast<std::size_t>(threads);
  };
  constexpr int kRepeats = 5;
  double triad = 1e9, compute = 1e9;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    triad = std::min(triad, time_on_threads(threads, [&](int t) {
                       float* __restrict const to = a.data();
                       const float* __restrict const x = b.data();
                       const float* __restrict const y = c.data();
                       for (std::size_t i = part(t); i < part(t + 1); ++i) to[i] = x[i] + 0.5f * y[i];
                     }));
    compute = std::min(compute, time_on_threads(threads, [&](int t) {
                         // Kept, or the compiler would leave all of it out.
                         volatile float kept = multiply_and_add(t);
                         (void)kept;
                       }));
  }
  const double lanes = sizeof(Lanes) / sizeof(float);
  return {3.0 * static_cast<double>(count * sizeof(float)) / triad,
          2.0 * lanes * kChains * kRounds * threads / compute};
}

}  // namespace slosh::report
