#include "render/gl/es_export.h"

#include <fstream>
#include <string>
#include <system_error>

#include "render/gl/es_programs.h"
#include "render/gl/es_source.h"

namespace slosh {
namespace {

/// "fluid_look.frag" with MIXED 4: "fluid_look-MIXED_4.frag".
std::string file_of(const std::string& name, const std::vector<std::string>& defines) {
  const std::size_t dot = name.find('.');
  std::string out = name.substr(0, dot);
  for (const std::string& define : defines) out += "-" + define;
  for (char& c : out)
    if (c == ' ' || c == '.') c = '_';
  return out + name.substr(dot);
}

// No name here has a character that JSON would have escaped.
std::string quoted(const std::string& word) {
  return "\"" + word + "\"";
}

template <class Items, class Text>
std::string listed(const Items& items, Text text) {
  std::string out;
  for (const auto& item : items) out += (out.empty() ? "" : ", ") + text(item);
  return out;
}

std::string json_of(const EsShader& shader, const std::string& file) {
  const auto binding = [](const EsBinding& b) { return quoted(b.name) + ": " + std::to_string(b.at); };
  const auto buffer = [](const EsBuffer& b) {
    return quoted(b.sampler) + ": {\"unit\": " + std::to_string(b.unit) +
           ", \"texels\": " + std::to_string(b.texels) + "}";
  };
  return "{\"file\": " + quoted(file) + ", \"textures\": {" + listed(shader.textures, binding) +
         "}, \"buffers\": {" + listed(shader.buffers, buffer) + "}, \"blocks\": {" +
         listed(shader.blocks, binding) + "}}";
}

Result<bool> write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (out) return true;
  return Error{file.string(), "cannot be written", "Name a folder that you may write to"};
}

}  // namespace

Result<std::size_t> export_es_programs(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return Error{folder.string(), failed.message(), "Name a folder that you may write to"};
  std::string programs;
  const std::vector<EsProgram> all = es_programs();
  for (const EsProgram& program : all) {
    std::string stages;
    for (const auto& [stage, name] :
         {std::pair{"vertex", program.vertex}, std::pair{"fragment", program.fragment}}) {
      const auto shader = es_shader_source(name, program.defines);
      if (!shader) return shader.error();
      const std::string file = file_of(name, program.defines);
      if (const auto written = write(folder / file, shader.value().text); !written) return written.error();
      stages += std::string(", \"") + stage + "\": " + json_of(shader.value(), file);
    }
    programs += (programs.empty() ? "" : ",\n") + std::string("{\"defines\": [") +
                listed(program.defines, quoted) + "]" + stages + "}";
  }
  if (const auto written = write(folder / "programs.json", "[\n" + programs + "\n]\n"); !written)
    return written.error();
  return all.size();
}

}  // namespace slosh
