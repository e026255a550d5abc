#include "render/gl/es_lowering.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <functional>
#include <optional>
#include <regex>

namespace slosh {
namespace {

bool is_name_sign(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Where the bracket that `open` is at closes; npos: nowhere.
std::size_t closing(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t at = open; at < text.size(); ++at) {
    if (text[at] == '[') ++depth;
    if (text[at] == ']' && --depth == 0) return at;
  }
  return std::string_view::npos;
}

/// Replaces each `before` + `name` + `[index]` + `after`, where `name` is a word by itself, by what `made`
/// gives for the index; where it gives nothing, that place stays.
void replace_indexed(std::string& text, std::string_view before, std::string_view name,
                     std::string_view after,
                     const std::function<std::optional<std::string>(std::string_view)>& made) {
  const std::string wanted = std::string(before) + std::string(name) + "[";
  for (std::size_t at = text.find(wanted); at != std::string::npos; at = text.find(wanted, at + 1)) {
    if (at > 0 && is_name_sign(text[at - 1])) continue;
    const std::size_t open = at + wanted.size() - 1;
    const std::size_t close = closing(text, open);
    if (close == std::string::npos || text.compare(close + 1, after.size(), after) != 0) continue;
    const auto in_place = made(std::string_view(text).substr(open + 1, close - open - 1));
    if (in_place) text.replace(at, close + 1 + after.size() - at, *in_place);
  }
}

/// vec4s of a struct that has nothing else; 0 if it has.
int vec4s_of(const std::string& text, const std::string& type) {
  if (type == "vec4") return 1;
  const std::size_t start = text.find("struct " + type + " {");
  if (start == std::string::npos) return 0;
  const std::string body = text.substr(start, text.find("};", start) - start);
  static const std::regex kMember(R"(\n\s*(\w+) \w+(\[\w+\])?;)");
  int count = 0;
  for (std::sregex_iterator member(body.begin(), body.end(), kMember), end; member != end; ++member) {
    if ((*member)[1] != "vec4" || (*member)[2].matched) return 0;
    ++count;
  }
  return count;
}

std::string buffer_text(const EsBuffer& buffer, const std::string& name, const std::string& type) {
  const std::string one = name + "_texel";
  std::string text = "uniform sampler2D " + buffer.sampler + ";\nvec4 " + one +
                     "(int i) {\n  int across = textureSize(" + buffer.sampler +
                     ", 0).x;\n  return texelFetch(" + buffer.sampler +
                     ", ivec2(i % across, i / across), 0);\n}\n" + type + " " + name + "_at(int i) { return ";
  if (type == "vec4") return text + one + "(i); }";
  text += type + "(";
  for (int k = 0; k < buffer.texels; ++k)
    text +=
        (k > 0 ? ", " : "") + one + "(" + std::to_string(buffer.texels) + " * i + " + std::to_string(k) + ")";
  return text + "); }";
}

}  // namespace

std::string with_buffers_as_textures(std::string text, std::vector<EsBuffer>& buffers) {
  static const std::regex kBuffer(
      R"(layout\(std430, binding = (\d+)\) readonly buffer \w+ \{ (\w+) (\w+)\[\]; \};)");
  std::smatch found;
  std::string done;
  while (std::regex_search(text, found, kBuffer)) {
    const std::string type = found[2];
    const std::string name = found[3];
    const EsBuffer buffer{name + "_texels", kEsBufferUnit + std::stoi(found[1]), vec4s_of(done + text, type)};
    const std::string in_place = buffer.texels > 0 ? buffer_text(buffer, name, type) : found.str();
    done += found.prefix().str() + in_place;
    text = found.suffix();
    if (buffer.texels == 0) continue;
    buffers.push_back(buffer);
    const auto at = [&](std::string_view index) { return name + "_at(" + std::string(index) + ")"; };
    replace_indexed(text, "", name, "", at);
  }
  return done + text;
}

int size_of_array(std::string_view word, std::span<const std::string> defines) {
  int size = 0;
  if (const auto read = std::from_chars(word.data(), word.data() + word.size(), size);
      read.ec == std::errc() && read.ptr == word.data() + word.size())
    return size;
  for (const std::string& define : defines)
    if (define.starts_with(std::string(word) + " ")) return size_of_array(define.substr(word.size() + 1), {});
  return 0;
}

std::string with_arrays_by_number(std::string text, std::span<const std::string> defines) {
  static const std::regex kArray(R"(uniform sampler2D (\w+)\[(\w+)\];[^\n]*\n)");
  std::smatch found;
  std::string done;
  while (std::regex_search(text, found, kArray)) {
    const std::string name = found[1];
    const int count = size_of_array(found[2].str(), defines);
    done += found.prefix().str() + found.str();
    text = found.suffix();
    if (count == 0) continue;
    done += "vec4 fetch_of_" + name + "(int i, ivec2 at, int level) {\n";
    for (int k = 1; k < count; ++k)
      done += "  if (i == " + std::to_string(k) + ") return texelFetch(" + name + "[" + std::to_string(k) +
              "], at, level);\n";
    done += "  return texelFetch(" + name + "[0], at, level);\n}\n";
    const auto by_number = [&](std::string_view index) -> std::optional<std::string> {
      return "fetch_of_" + name + "(" + std::string(index) + ", ";
    };
    replace_indexed(text, "texelFetch(", name, ", ", by_number);
  }
  return done + text;
}

std::string with_one_output(std::string text, bool second) {
  static const std::regex kOutput(R"(layout\(location = (\d+), index = ([01])\) out (\w+ \w+;))");
  std::smatch found;
  std::string done;
  while (std::regex_search(text, found, kOutput)) {
    const bool kept = (found[2] == "1") == second;
    done += found.prefix().str() + (kept ? "layout(location = " + found[1].str() + ") out " : "") +
            found[3].str();
    text = found.suffix();
  }
  return done + text;
}

}  // namespace slosh
