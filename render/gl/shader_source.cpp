#include "render/gl/shader_source.h"

#include <algorithm>
#include <optional>
#include <set>

namespace slosh {
namespace {

/// The file named by an #include line, if it is one.
std::optional<std::string_view> included_file(std::string_view line) {
  const std::size_t start = line.find_first_not_of(" \t");
  if (start == std::string_view::npos || !line.substr(start).starts_with("#include")) return std::nullopt;
  const std::size_t open = line.find('"', start);
  const std::size_t close = open == std::string_view::npos ? open : line.find('"', open + 1);
  if (close == std::string_view::npos) return std::nullopt;
  return line.substr(open + 1, close - open - 1);
}

class Resolver {
 public:
  explicit Resolver(std::span<const EmbeddedShader> files) : files_(files) {}

  /// Appends the file to `out`; false with `missing` set if it or a file it includes is unknown.
  bool append(std::string_view name, std::string& out) {
    if (!seen_.insert(std::string(name)).second) return true;
    const auto file = std::ranges::find(files_, name, &EmbeddedShader::name);
    if (file == files_.end()) {
      missing_ = name;
      return false;
    }
    std::string_view rest = file->text;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      const std::string_view line = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      if (const auto other = included_file(line)) {
        if (!append(*other, out)) return false;
      } else if (!line.starts_with("#pragma once")) {
        out.append(line).push_back('\n');
      }
    }
    return true;
  }

  const std::string& missing() const { return missing_; }

 private:
  std::span<const EmbeddedShader> files_;
  std::set<std::string> seen_;
  std::string missing_;
};

}  // namespace

Result<std::string> shader_source(std::string_view name, std::span<const std::string> defines,
                                  std::span<const EmbeddedShader> files) {
  std::string text = "#version 450 core\n";
  for (const std::string& define : defines) text += "#define " + define + "\n";
  Resolver resolver(files);
  if (!resolver.append(name, text)) {
    return Error{"shader " + std::string(name), "no such file: " + resolver.missing(),
                 "Add it to render/shaders and render/CMakeLists.txt"};
  }
  return text;
}

}  // namespace slosh
