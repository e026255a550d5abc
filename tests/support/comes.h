// Waiting for what other threads and other programs bring about.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace slosh::test {

/// Asks `there` again and again until it says yes. Its patience is only reached on failure; under sanitizers
/// a second of a world may take a minute.
inline bool comes(const std::function<bool()>& there) {
#ifdef SLOSH_SANITIZED
  constexpr std::chrono::minutes kPatience(15);
#else
  constexpr std::chrono::minutes kPatience(4);
#endif
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    if (there()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return there();
}

}  // namespace slosh::test
