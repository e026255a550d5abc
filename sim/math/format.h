// Numbers into sentences: of a plan and its refusals, of reports, of what gnuplot is told.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace slosh {

/// As printf; at most 511 characters.
[[gnu::format(printf, 1, 2)]] inline std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

}  // namespace slosh
