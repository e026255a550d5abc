// The library's errors as Python exceptions, in the same words.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include "sim/math/result.h"

namespace slosh::python {

/// Becomes slosh.Error, with its three parts as attributes.
struct Raised : std::exception {
  explicit Raised(Error e) : error(std::move(e)), text(error.text()) {}
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
