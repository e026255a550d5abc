// settings.toml, as somebody wrote it, or copied it from elsewhere.
#include <string>
#include <string_view>

#include "net/text/clean.h"
#include "peer/settings/settings.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"

using namespace slosh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const SettingsFile file = parse_settings({reinterpret_cast<const char*>(data), size}, "settings.toml");
  for (const Error& error : file.errors) {
    test::must(!error.what.empty(), "an error has words");
    test::must(clean_lines(error.text(), 4000) == error.text(), "which a terminal may show");
  }
  for (const Setting& value : file.values) {
    test::must(value.key != nullptr && !value.words.empty(), "a value has a key and words");
    test::must(value.line >= 1 && static_cast<std::size_t>(value.line) <= size, "and a line of the file");
    for (const std::string& word : value.words)
      test::must(word.find('\0') == std::string::npos, "which a command line can hold");
  }
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  const std::string example = settings_example();
  // Every key in use.
  std::string used;
  for (std::size_t at = 0; at < example.size();) {
    const std::size_t end = std::min(example.find('\n', at), example.size());
    std::string line = example.substr(at, end - at);
    if (line.find(" = ") != std::string::npos && line.starts_with('#'))
      line.erase(0, line.find_first_not_of("# "));
    used += line + "\n";
    at = end + 1;
  }
  const std::string odd = "name = \"\\u0000\\u001b[2J\"\n[keys]\npause = \"\\u202e\"\nstep = 3\n";
  std::vector<std::vector<std::uint8_t>> seeds;
  for (const std::string& text : {example, used, odd}) seeds.emplace_back(text.begin(), text.end());
  return seeds;
}
