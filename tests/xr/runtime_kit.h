// A folder for the runtime of the tests: what it is to be and do goes in, what it saw comes out.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace slosh::xr_test {

class RuntimeFolder {
 public:
  RuntimeFolder(std::filesystem::path folder, const std::string& script) : folder_(std::move(folder)) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "script.txt") << script;
  }
  const std::filesystem::path& path() const { return folder_; }

  std::vector<std::string> log() const {
    std::vector<std::string> lines;
    std::ifstream file(folder_ / "log.txt");
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }
  /// How many lines begin so.
  int count(const std::string& beginning) const {
    int found = 0;
    for (const std::string& line : log()) found += line.rfind(beginning, 0) == 0;
    return found;
  }
  /// What the program did against the standard, line by line; empty when nothing.
  std::string wrong() const {
    std::string all;
    for (const std::string& line : log()) {
      if (line.rfind("WRONG", 0) == 0) all += line + "\n";
    }
    return all;
  }

  /// A picture that was kept: "left", "right" or "panel".
  struct Picture {
    int width = 0;
    int height = 0;
    std::vector<unsigned char> rgb;
    const unsigned char* at(int x, int y) const {
      return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(x))];
    }
  };
  Picture picture(int frame, const std::string& which) const {
    Picture read;
    std::ifstream file(folder_ / ("frame-" + std::to_string(frame) + "-" + which + ".ppm"), std::ios::binary);
    std::string kind;
    int most = 0;
    if (!(file >> kind >> read.width >> read.height >> most)) return {};
    file.get();
    read.rgb.resize(std::size_t{3} * static_cast<std::size_t>(read.width * read.height));
    file.read(reinterpret_cast<char*>(read.rgb.data()), static_cast<std::streamsize>(read.rgb.size()));
    return read;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace slosh::xr_test
