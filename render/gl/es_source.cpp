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

/// textureGather() of a texture whose edges are clamped; ES has it from 3.1 on. By another name: some
/// compilers know that one and forbid another function of it.
constexpr std::string_view kGatherCall = "textureGather(";
constexpr std::string_view kOurGatherCall = "gathered(";
constexpr std::string_view kGather = R"(
vec4 gathered(sampler2D s, vec2 at) {
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
std::string without_binding(std::string_view line, std::span<const std::string> defines, EsShader& out) {
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
  const auto open = declared.find('[');
  if (sampler && open < declared.find(';')) {
    const int count = size_of_array(declared.substr(open + 1, declared.find(']') - open - 1), defines);
    for (int k = 0; k < count; ++k)
      out.textures.push_back({std::string(words[2]) + "[" + std::to_string(k) + "]", unit + k});
  } else if (sampler) {
    out.textures.push_back({std::string(words[2]), unit});
  }
  return block ? "layout(std140)" + std::string(declared) : std::string(declared);
}

/// Whether one is known of the words of `#if defined(A) || defined(B)`; nothing of other conditions.
std::optional<bool> any_defined(std::string_view line, const std::vector<std::string>& known) {
  constexpr std::string_view kDefined = "defined(";
  if (line.find_first_of("!&=<>") != std::string_view::npos) return std::nullopt;
  bool any = false;
  std::size_t at = line.find(kDefined);
  if (at == std::string_view::npos) return std::nullopt;
  for (; at != std::string_view::npos; at = line.find(kDefined, at + 1))
    any = any || std::ranges::find(known, words_of(line.substr(at + kDefined.size())).front()) != known.end();
  return any;
}

/// The part of `text` that `defines` leave of its #ifdef, #ifndef, #if defined, #else and #endif; other
/// conditions stay. What ES lacks may stand in a part for compute shaders.
std::string chosen_parts(std::string_view text, std::span<const std::string> defines) {
  std::vector<std::string> known;
  for (const std::string& define : defines) known.push_back(define.substr(0, define.find(' ')));
  enum class Part { kTaken, kLeftOut, kStays };
  std::vector<Part> parts;
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const bool ifdef = line.starts_with("#ifdef ");
    bool directive = true;
    if (ifdef || line.starts_with("#ifndef ")) {
      const std::string_view name = words_of(line.substr(ifdef ? 7 : 8)).front();
      parts.push_back((std::ranges::find(known, name) != known.end()) == ifdef ? Part::kTaken
                                                                               : Part::kLeftOut);
    } else if (line.starts_with("#if ")) {
      const auto any = any_defined(line, known);
      parts.push_back(!any ? Part::kStays : *any ? Part::kTaken : Part::kLeftOut);
      directive = any.has_value();
    } else if (line.starts_with("#else") && !parts.empty() && parts.back() != Part::kStays) {
      parts.back() = parts.back() == Part::kTaken ? Part::kLeftOut : Part::kTaken;
    } else if (line.starts_with("#endif") && !parts.empty()) {
      directive = parts.back() != Part::kStays;
      parts.pop_back();
    } else {
      directive = false;
    }
    if (!directive && std::ranges::find(parts, Part::kLeftOut) == parts.end())
      out.append(line).push_back('\n');
  }
  return out;
}

/// What ES 3.0 has not and the text uses.
std::optional<std::string> lacking(std::string_view text) {
  for (const auto& [word, what] :
       {std::pair{"local_size_x", "compute shaders"}, std::pair{"layout(std430", "storage buffers"},
        std::pair{"image2D", "images"}})
    if (text.find(word) != std::string_view::npos) return what;
  return std::nullopt;
}

}  // namespace

Result<EsShader> es_shader_source(std::string_view name, std::span<const std::string> defines,
                                  std::span<const EmbeddedShader> files) {
  const auto desktop = shader_source(name, defines, files);
  if (!desktop) return desktop.error();
  EsShader out;
  std::string chosen = with_buffers_as_textures(chosen_parts(desktop.value(), defines), out.buffers);
  chosen = with_one_output(with_arrays_by_number(std::move(chosen), defines),
                           std::ranges::find(defines, kSecondOutput) != defines.end());
  if (const auto what = lacking(chosen))
    return Error{"shader " + std::string(name), "needs " + *what + ", which OpenGL ES 3.0 does not have",
                 "Draw this pass in another way there"};
  out.text = kHead;
  std::size_t call = chosen.find(kGatherCall);
  if (call != std::string::npos) out.text += kGather;
  for (; call != std::string::npos; call = chosen.find(kGatherCall, call))
    chosen.replace(call, kGatherCall.size(), kOurGatherCall);
  std::string_view rest = chosen;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!line.starts_with("#version")) out.text += without_binding(line, defines, out) + "\n";
  }
  return out;
}

}  // namespace slosh
