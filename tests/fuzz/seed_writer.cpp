// `fuzz_NAME --write-seeds=FOLDER` writes the target's seeds there and ends; else libFuzzer goes on.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/fuzz/seeds.h"

__attribute__((weak)) std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  return {};
}

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  const std::string wanted = "--write-seeds=";
  for (int i = 1; i < *count; ++i) {
    const std::string argument = (*arguments)[i];
    if (!argument.starts_with(wanted)) continue;
    const std::filesystem::path folder = argument.substr(wanted.size());
    std::filesystem::create_directories(folder);
    int number = 0;
    for (const auto& seed : slosh_fuzz_seeds()) {
      std::ofstream out(folder / ("seed_" + std::to_string(number++)), std::ios::binary);
      out.write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size()));
      out.close();
      if (!out) {
        std::fprintf(stderr, "cannot write seeds to %s\n", folder.c_str());
        std::exit(1);
      }
    }
    std::exit(0);
  }
  return 0;
}
