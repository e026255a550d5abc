// Runs a fuzz target without libFuzzer: on its seeds, on the files of a folder, and on a fixed number of
// damaged ones, the same every time. A finding is a crash, as with libFuzzer; the input is left in a file.
//
// Usage: fuzz_NAME [FOLDER] [INPUTS]
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "tests/fuzz/seeds.h"

__attribute__((weak)) std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  return {};
}

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr int kInputs = 20'000;
constexpr std::size_t kLongest = 1 << 16;

Bytes current;
std::string crash_file;

/// Keeps what crashed.
void on_crash(int signal) {
  std::FILE* file = std::fopen(crash_file.c_str(), "wb");
  if (file) {
    std::fwrite(current.data(), 1, current.size(), file);
    std::fclose(file);
    std::fprintf(stderr, "the input is in %s\n", crash_file.c_str());
  }
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

std::vector<Bytes> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator(folder, code)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> inputs;
  for (const auto& path : paths) {
    std::ifstream in(path, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return inputs;
}

class Damager {
 public:
  explicit Damager(const std::vector<Bytes>& seeds) : seeds_(seeds) {}

  Bytes next() {
    Bytes bytes = seeds_[random_() % seeds_.size()];
    for (std::size_t left = 1 + random_() % 4; left > 0; --left) damage(bytes);
    if (bytes.size() > kLongest) bytes.resize(kLongest);
    return bytes;
  }

 private:
  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }

  void damage(Bytes& bytes) {
    static constexpr std::uint8_t kTelling[] = {0, 1, 0x7f, 0x80, 0xff, '/', ':', 0xf0, 0x3f};
    const std::size_t at = below(bytes.size());
    const auto here = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random_() % 8) {
      case 0:
        if (!bytes.empty()) *here ^= static_cast<std::uint8_t>(1u << (random_() % 8));
        break;
      case 1:
        if (!bytes.empty()) *here = static_cast<std::uint8_t>(random_());
        break;
      case 2:
        if (!bytes.empty()) *here = kTelling[random_() % std::size(kTelling)];
        break;
      case 3:
        bytes.insert(here, 1 + below(8), kTelling[random_() % std::size(kTelling)]);
        break;
      case 4:
        bytes.erase(here, here + static_cast<std::ptrdiff_t>(std::min(1 + below(8), bytes.size() - at)));
        break;
      case 5:
        bytes.resize(at);
        break;
      case 6: {  // eight bytes that are a strange number
        static constexpr std::uint64_t kNumbers[] = {
            0x7ff8000000000000, 0x7ff0000000000000, 0xfff0000000000000, 0x7fc000007fc00000,
            0x7f8000007f800000, ~std::uint64_t{0},  0x8000000000000000, 0x7fffffffffffffff};
        const std::uint64_t number = kNumbers[random_() % std::size(kNumbers)];
        for (std::size_t i = at; i < std::min(at + 8, bytes.size()); ++i)
          bytes[i] = static_cast<std::uint8_t>(number >> (8 * (i - at)));
        break;
      }
      default: {  // the beginning of one and the end of another
        const Bytes& other = seeds_[random_() % seeds_.size()];
        bytes.resize(at);
        const std::size_t from = below(other.size());
        bytes.insert(bytes.end(), other.begin() + static_cast<std::ptrdiff_t>(from), other.end());
      }
    }
  }

  const std::vector<Bytes>& seeds_;
  std::mt19937_64 random_{20261121};
};

void run(const Bytes& input) {
  current = input;
  // A copy of exactly that size, so that a sanitizer sees a read behind the end.
  const Bytes exact(input);
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

}  // namespace

int main(int count, char** arguments) {
  const std::string name = std::filesystem::path(arguments[0]).filename().string();
  crash_file =
      (std::filesystem::temp_directory_path() / (name + "_crash_" + std::to_string(::getpid()))).string();
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGBUS, SIGILL}) std::signal(signal, on_crash);

  std::vector<Bytes> seeds = slosh_fuzz_seeds();
  if (count > 1) {
    for (Bytes& file : files_of(arguments[1])) seeds.push_back(std::move(file));
  }
  const int inputs = count > 2 ? std::atoi(arguments[2]) : kInputs;
  if (seeds.empty()) seeds.push_back(Bytes(64));
  run({});
  for (const Bytes& seed : seeds) run(seed);
  Damager damager(seeds);
  for (int i = 0; i < inputs; ++i) run(damager.next());
  std::printf("%s: %zu seeds, %d damaged inputs\n", name.c_str(), seeds.size(), inputs);
  return 0;
}
