// What the calling thread asks of the heap and of locks, counted: for a program that links
// slosh_test_thread_calls, malloc and its kin (so operator new, strdup, what libraries do) and the locks of
// pthread are this room's.
#pragma once

#include <cstddef>

namespace slosh::test {

struct ThreadCalls {
  std::size_t allocations = 0;  ///< malloc, calloc, realloc, aligned ones: whoever calls them
  std::size_t frees = 0;        ///< of what is not null
  std::size_t locks = 0;        ///< mutexes, read-write locks and condition variables that could make it wait
  friend ThreadCalls operator-(const ThreadCalls& a, const ThreadCalls& b) {
    return {a.allocations - b.allocations, a.frees - b.frees, a.locks - b.locks};
  }
  std::size_t all() const { return allocations + frees + locks; }
};

/// Of this thread, since it began.
ThreadCalls thread_calls();

}  // namespace slosh::test
