// What came of a wish.
#pragma once

#include <string>

namespace slosh {

struct Outcome {
  bool granted = false;
  std::string text;  ///< for the person who wished; several lines or none, no line feed at the end
};

}  // namespace slosh
