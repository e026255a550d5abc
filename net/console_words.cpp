#include "net/console_words.h"

#include <algorithm>
#include <cmath>

#include "net/wire/text.h"

namespace slosh {

Result<std::vector<std::string>> console_words(std::string_view typed) {
  constexpr char kMend[] = "Type help for what may be said";
  while (!typed.empty() && (typed.back() == '\n' || typed.back() == '\r')) typed.remove_suffix(1);
  std::string line(typed.substr(0, kMaxConsoleLine + 1));
  std::replace(line.begin(), line.end(), '\t', ' ');
  if (line.size() > kMaxConsoleLine) return Error{"", "the line is too long", kMend};
  const std::string problem = wire::text_problem(line);
  if (!problem.empty()) return Error{"", "the line " + problem, kMend};

  std::vector<std::string> words;
  std::size_t at = 0;
  while (at < line.size()) {
    const char c = line[at];
    if (c == ' ') {
      at += 1;
      continue;
    }
    const bool quoted = c == '"' || c == '\'';
    const std::size_t begin = quoted ? at + 1 : at;
    const char until[] = {quoted ? c : ' ', '\0'};
    std::size_t end = line.find(until, begin);
    if (end == std::string::npos) end = line.size();
    words.push_back(line.substr(begin, end - begin));
    // What stood on the space before it stands on nothing now.
    const std::string apart = wire::text_problem(words.back());
    if (!apart.empty()) return Error{"", "word " + std::to_string(words.size()) + " " + apart, kMend};
    at = quoted ? end + 1 : end;
  }
  return words;
}

Result<SetWish> parse_set(const std::vector<std::string>& words) {
  const Error error{"", "set needs what and a number",
                    "As in: set viscosity [FLUID] 0.5, set gravity 0.5 or set stiffness [GRIP] 0.5"};
  if (words.size() < 3 || words.size() > 4) return error;
  SetWish wish;
  if (words[1] == "gravity")
    wish.what = SetWish::What::kGravity;
  else if (words[1] == "stiffness")
    wish.what = SetWish::What::kStiffness;
  else if (words[1] != "viscosity")
    return error;
  if (wish.what == SetWish::What::kGravity && words.size() != 3) return error;
  if (words.size() == 4) wish.which = words[2];
  const std::string& number = words.back();
  const char* end = number.data() + number.size();
  const auto [at, code] = std::from_chars(number.data(), end, wish.value);
  if (code != std::errc() || at != end || !std::isfinite(wish.value) || wish.value < 0.0)
    return Error{"", "'" + number + "' is no number of 0 or more", error.mend};
  return wish;
}

}  // namespace slosh
