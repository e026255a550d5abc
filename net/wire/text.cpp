#include "net/wire/text.h"

#include "net/text/clean.h"

namespace slosh::wire {

std::string text_problem(std::string_view text) {
  return slosh::text_problem(text);
}

std::string clean_text(std::string_view text, std::size_t most) {
  return slosh::clean_text(text, most);
}

}  // namespace slosh::wire
