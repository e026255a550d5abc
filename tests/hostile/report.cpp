#include "tests/hostile/report.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <random>

namespace slosh::hostile {
namespace {

/// Under AddressSanitizer what was freed stays for a while, and every byte has its shadow.
#ifdef SLOSH_SANITIZED                  // the hostile runs have a build with AddressSanitizer only
constexpr long kMaxMemory = 3'000'000;  // kB
#else
constexpr long kMaxMemory = 1'000'000;  // kB
#endif

bool is_unfit(std::uint32_t character) {
  const auto within = [character](std::uint32_t least, std::uint32_t most) {
    return character >= least && character <= most;
  };
  if (character == '\n' || character == '\t' || character == '\r') return false;
  return character < 0x20 || within(0x7f, 0x9f)  // controls, C1 too
         || within(0x200b, 0x200f)               // no width; turns the way of writing
         || within(0x2028, 0x202e) || within(0x2060, 0x206f) || character == 0xfeff;
}

}  // namespace

RunOptions run_options(int count, char** arguments, const char* what) {
  RunOptions options;
  options.seed = std::random_device{}();
  CLI::App app(what);
  std::string folder = "hostile";
  app.add_option("--seconds", options.seconds, "How long to attack")->check(CLI::Range(1.0, 86400.0));
  app.add_option("--seed", options.seed, "Of all that is chosen (a new one)");
  app.add_option("--first", options.first, "Number of the first attack, to go on or to do one again");
  app.add_option("--most", options.most, "Attacks at most");
  app.add_option("--folder", folder, "Where what happened is kept")->capture_default_str();
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  options.folder = std::filesystem::absolute(folder);
  std::filesystem::remove_all(options.folder);
  std::filesystem::create_directories(options.folder);
  return options;
}

std::string unfit_for_a_terminal(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) {
      return static_cast<std::uint32_t>(static_cast<unsigned char>(text[k]));
    };
    const std::uint32_t first = byte(i);
    const std::size_t length = first < 0x80    ? 1
                               : first >= 0xf0 ? 4
                               : first >= 0xe0 ? 3
                               : first >= 0xc2 ? 2
                                               : 0;
    bool sound = length > 0 && i + length <= text.size();
    std::uint32_t character = length == 1 ? first : first & (0x7fu >> length);
    for (std::size_t k = 1; sound && k < length; ++k) {
      sound = (byte(i + k) & 0xc0) == 0x80;
      character = character << 6 | (byte(i + k) & 0x3f);
    }
    if (!sound || is_unfit(character)) {
      char found[80];
      std::snprintf(found, sizeof found, sound ? "U+%04X at byte %zu" : "byte 0x%02x, no UTF-8, at byte %zu",
                    sound ? character : first, i);
      return found;
    }
    i += length;
  }
  return {};
}

std::string sanitizer_words(const std::string& text) {
  for (const char* words : {"AddressSanitizer", "LeakSanitizer", "ThreadSanitizer", "runtime error:"}) {
    const std::size_t at = text.find(words);
    if (at == std::string::npos) continue;
    const std::size_t begin = text.rfind('\n', at) + 1;  // npos + 1 is 0
    return text.substr(begin, text.find('\n', at) - begin);
  }
  return {};
}

std::vector<std::string> faults_of(const test::Outcome& outcome, const std::vector<int>& codes) {
  std::vector<std::string> faults;
  for (const std::string* text : {&outcome.out, &outcome.err}) {
    if (const std::string words = sanitizer_words(*text); !words.empty()) faults.push_back(words);
    if (const std::string where = unfit_for_a_terminal(*text); !where.empty())
      faults.push_back("writes to the terminal what somebody sent: " + where);
  }
  if (std::find(codes.begin(), codes.end(), outcome.code) == codes.end())
    faults.push_back("ended with " + std::to_string(outcome.code));
  if (outcome.peak_kb > kMaxMemory)
    faults.push_back("held " + std::to_string(outcome.peak_kb / 1000) + " MB at its most");
  return faults;
}

std::string slosh_program() {
  return SLOSH_PROGRAM;
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f s", seconds);
  return text;
}

}  // namespace slosh::hostile
