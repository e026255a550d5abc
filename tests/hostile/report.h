// What a run under attack came to: where findings are kept, and what counts as one in what a program said.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace slosh::hostile {

struct RunOptions {
  double seconds = 600.0;      ///< of attacks
  std::uint64_t seed = 0;      ///< of everything that is chosen
  std::uint64_t first = 0;     ///< number of the first attack: goes on where another run was
  std::uint64_t most = ~0ull;  ///< attacks at most
  std::filesystem::path folder;
};
/// Reads --seconds, --seed, --first, --most and --folder; ends the program on anything else.
RunOptions run_options(int count, char** arguments, const char* what);

/// What in `text` must not reach a terminal: a control other than a line's end, tab or carriage return (C1
/// included), what has no width or turns the way of writing, bytes that are no UTF-8. Empty when there is
/// none; else the first, and where.
std::string unfit_for_a_terminal(const std::string& text);

/// What a sanitizer said in there; empty when nothing.
std::string sanitizer_words(const std::string& text);

/// Everything wrong with how a program ended: a signal, a sanitizer, a code that is not in `codes`, text that
/// would reach a terminal, too much memory.
std::vector<std::string> faults_of(const test::Outcome& outcome, const std::vector<int>& codes);

/// The built program, from beside this one.
std::string slosh_program();

/// "12 s".
std::string seconds_text(double seconds);

}  // namespace slosh::hostile
