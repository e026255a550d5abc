#include "net/text/nearest.h"

#include <algorithm>
#include <cstddef>

namespace slosh {
namespace {

constexpr std::size_t kMaxLetters = 64;  // a longer word is none of ours
constexpr std::size_t kShort = 5;        // letters, below which two of them wrong are another word

std::string plain(std::string_view word) {
  std::string out(word);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-') c = '_';
  }
  return out;
}

/// Optimal string alignment: Levenshtein's distance with swaps of neighbours.
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t> row(b.size() + 1);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = std::move(last);
    last = std::move(row);
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
  if (word.empty() || word.size() > kMaxLetters) return {};
  std::string best;
  std::size_t fewest = 0;
  for (const std::string& each : known) {
    const std::size_t now = edits(plain(word), plain(each));
    const std::size_t most = std::max<std::size_t>(each.size() < kShort ? 1 : 2, each.size() / 3);
    if (now > most || now >= word.size()) continue;
    if (!best.empty() && now >= fewest) continue;
    best = each;
    fewest = now;
  }
  return best;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& known) {
  const std::string near = nearest_word(word, known);
  return near.empty() ? std::string() : "Did you mean " + near + "? ";
}

}  // namespace slosh
