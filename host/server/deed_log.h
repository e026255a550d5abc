// What was done lately, by whom and when: for whoever runs the host.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

namespace slosh {

constexpr std::size_t kMaxDeeds = 200;

/// One thread; knows no clock.
class DeedLog {
 public:
  /// The same words again are counted with those of just before, so that a flood pushes out nothing.
  void note(const std::string& words, std::int64_t unix_ns);
  /// A line a deed, the newest last: local time, how often, words.
  std::string text() const;

 private:
  struct Deed {
    std::string words;
    std::int64_t unix_ns = 0;
    std::size_t times = 1;
  };
  std::deque<Deed> deeds_;
};

}  // namespace slosh
