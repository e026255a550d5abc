// What a case or its reference says no to, in words.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include "sim/math/result.h"

namespace slosh::report {

struct Refused : std::exception {
  explicit Refused(Error refusal) : error(std::move(refusal)), text(error.text()) {}
  const char* what() const noexcept override { return text.c_str(); }
  Error error;
  std::string text;
};

}  // namespace slosh::report
