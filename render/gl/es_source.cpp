#include "render/gl/es_source.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>

namespace slosh {
namespace {

constexpr std::string_view kHead =
    "#version 300 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "precision highp sampler2D;\n"
    "precision highp sampler3D;\n"
    "precision highp sampler2DShadow;\n"
    "precision highp sampler2DArray;\n";

/// Of a texture whose edges are clamped; ES has it from 3.1 on.
constexpr std::string_view kGather = R"(
vec4 textureGather(sampler2D s, vec2 at) {
  ivec2 last = textureSize(s, 0) - 1;
  ivec2 low = ivec2(floor(at * vec2(last + 1) - 0.5));
  ivec2 from = clamp(low, ivec2(0), last);
  ivec2 to = clamp(low + 1, ivec2(0), last);
  return vec4(texelFetch(s, ivec2(from.x, to.y), 0).r, texelFetch(s, to, 0).r, texelFetch(s, ivec2(to.x, from.y), 0).r,
              texelFetch(s, from, 0).r);
}
)";

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The words of a line up to its first that is none.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == ' ') {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < line.size() && is_word(line[end])) ++end;
    if (end == at) break;
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// A line without `binding = N`, which is told in `out`.
std::string without_binding(std::string_view line, EsShader& out) {
  constexpr std::string_view kLayout = "layout(";
  constexpr std::string_view kBinding = "binding = ";
  const std::size_t start = line.find_first_not_of(' ');
  if (start == std::string_view::npos || !line.substr(start).starts_with(kLayout)) return std::string(line);
  const std::size_t close = line.find(')', start);
  const std::size_t binding = line.find(kBinding, start);
  if (binding > close || close == std::string_view::npos) return std::string(line);
  int unit = 0;
  std::from_chars(line.data() + binding + kBinding.size(), line.data() + close, unit);
  // "uniform sampler2D NAME", "uniform NAME {"; anything else is for others to refuse.
  const std::string_view declared = line.substr(close + 1);
  const std::vector<std::string_view> words = words_of(declared);
  const bool block = words.size() == 2 && words[0] == "uniform";
  const bool sampler = words.size() == 3 && words[0] == "uniform" && words[1].starts_with("sampler");
  if (block) out.blocks.push_back({std::string(words[1]), unit});
  if (sampler) out.textures.push_back({std::string(words[2]), unit});
  return block ? "layout(std140)" + std::string(declared) : std::string(declared);
}

/// The part of `text` that `defines` leave of its #ifdef, #ifndef, #else and #endif; other directives stay.
/// What ES lacks may stand in a part for compute shaders.
std::string chosen_parts(std::string_view text, std::span<const std::string> defines) {
  std::vector<std::string> known;
  for (const std::string& define : defines) known.push_back(define.substr(0, define.find(' ')));
  std::vector<bool> taken;
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool ifdef = line.starts_with("#ifdef ");
    if (ifdef || line.starts_with("#ifndef ")) {
      const std::string_view name = words_of(line.substr(ifdef ? 7 : 8)).front();
      taken.push_back((std::ranges::find(known, name) != known.end()) == ifdef);
    } else if (line.starts_with("#else") && !taken.empty()) {
      taken.back() = !taken.back();
    } else if (line.starts_with("#endif") && !taken.empty()) {
      taken.pop_back();
    } else if (std::ranges::find(taken, false) == taken.end()) {
      out.append(line).push_back('\n');
    }
  }
  return out;
}

/// What ES 3.0 has not and the text uses.
std::optional<std::string> lacking(std::string_view text) {
  for (const auto& [word, what] :
       {std::pair{"layout(std430", "storage buffers"}, std::pair{"image2D", "images"},
        std::pair{"local_size_x", "compute shaders"}, std::pair{"index = 1", "two outputs of one blend"}})
    if (text.find(word) != std::string_view::npos) return what;
  // "uniform sampler2D shares[2];", of which a loop takes one after the other.
  for (std::size_t at = text.find("uniform sampler"); at != std::string_view::npos;
       at = text.find("uniform sampler", at + 1)) {
    const std::size_t end = text.find_first_of(";[", at);
    if (end != std::string_view::npos && text[end] == '[') return "arrays of textures that a loop looks up";
  }
  return std::nullopt;
}

}  // namespace

Result<EsShader> es_shader_source(std::string_view name, std::span<const std::string> defines,
                                  std::span<const EmbeddedShader> files) {
  const auto desktop = shader_source(name, defines, files);
  if (!desktop) return desktop.error();
  const std::string chosen = chosen_parts(desktop.value(), defines);
  if (const auto what = lacking(chosen))
    return Error{"shader " + std::string(name), "needs " + *what + ", which OpenGL ES 3.0 does not have",
                 "Draw this pass in another way there"};
  EsShader out;
  out.text = kHead;
  if (chosen.find("textureGather(") != std::string::npos) out.text += kGather;
  std::string_view rest = chosen;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!line.starts_with("#version")) out.text += without_binding(line, out) + "\n";
  }
  return out;
}

}  // namespace slosh
