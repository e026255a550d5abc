// Independent jobs on several cores, and the caller told of each as it ends.
#pragma once

#include <cstddef>
#include <functional>

namespace slosh {

/// Calls work(i) for each i in [0, count) on `threads` threads (0: one a core), begun in the order of i, and
/// told(i) on the caller's thread for each that has ended. Asks `stop` (from any thread) before it begins
/// one: true, and those that run are still ended and told of. False when it stopped early. What work() throws
/// ends it likewise and is thrown on.
bool run_on_cores(std::size_t count, int threads, const std::function<void(std::size_t)>& work,
                  const std::function<void(std::size_t)>& told, const std::function<bool()>& stop);

}  // namespace slosh
