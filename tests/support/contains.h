// What a program says, looked through for words.
#pragma once

#include <string>

namespace slosh::test {

inline bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

}  // namespace slosh::test
