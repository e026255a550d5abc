// The library's errors as Python exceptions, in the same words.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include "net/text/clean.h"
#include "sim/math/result.h"

namespace slosh::python {

/// Whoever catches nothing has it in a terminal: fit for one, as what the program says is.
inline Error cleaned(const Error& e) {
  constexpr std::size_t kMost = 4000;
  return {clean_lines(e.where, kMost), clean_lines(e.what, kMost), clean_lines(e.mend, kMost)};
}

/// Becomes slosh.Error, with its three parts as attributes.
struct Raised : std::exception {
  explicit Raised(const Error& e) : error(cleaned(e)), text(error.text()) {}
  const char* what() const noexcept override { return text.c_str(); }
  Error error;
  std::string text;
};

/// The value, or raises.
template <class T>
T take(Result<T> result) {
  if (!result) throw Raised(result.error());
  return std::move(result.value());
}

}  // namespace slosh::python
