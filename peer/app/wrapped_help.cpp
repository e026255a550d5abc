#include "peer/app/wrapped_help.h"

#include <algorithm>
#include <sstream>

namespace slosh {

namespace {
constexpr std::size_t kLine = 110;  // bytes, as the launcher's own help
}

std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string all;
  std::size_t used = 0;
  for (std::string word; words >> word;) {
    if (used > 0 && used + 1 + word.size() > width) {
      all += '\n';
      used = 0;
    } else if (used > 0) {
      all += ' ';
      ++used;
    }
    all += word;
    used += word.size();
  }
  return all;
}

std::string WrappedHelp::make_option_desc(const CLI::Option* option) const {
  return wrapped(CLI::Formatter::make_option_desc(option), kLine - std::min(kLine / 2, get_column_width()));
}

}  // namespace slosh
