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
  constexpr std::size_t kMax = 4000;
  return {clean_lines(e.where, kMax), clean_lines(e.what, kMax), clean_lines(e.mend, kMax)};
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
