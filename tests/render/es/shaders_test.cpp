// The shader files in OpenGL ES 3.0's dialect: every program is in one of two lists, those of the one compile
// and link in such a context, those of the other are refused.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

#include "render/gl/es_export.h"
#include "tests/render/es/kit.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

using EsShaders = RenderTest;

std::string told(const EsProgram& program) {
  std::string text = program.vertex + ", " + program.fragment;
  for (const std::string& define : program.defines) text += ", " + define;
  return text;
}

std::string_view text_of(std::string_view name) {
  return std::ranges::find(embedded_shaders(), name, &EmbeddedShader::name)->text;
}

/// Words that `pattern`'s groups find.
std::set<std::string> found_in(std::string_view text, const std::regex& pattern) {
  std::set<std::string> words;
  for (std::cregex_iterator at(text.data(), text.data() + text.size(), pattern), end; at != end; ++at)
    words.insert((*at)[1].matched ? (*at)[1] : (*at)[2]);
  return words;
}

/// A file and all that it includes, for whoever asks.
void add_with_included(const std::string& name, std::set<std::string>& to) {
  static const std::regex kIncluded("#include \"([^\"]+)\"");
  if (!to.insert(name).second) return;
  for (const std::string& other : found_in(text_of(name), kIncluded)) add_with_included(other, to);
}

bool is_file_of_a_stage(std::string_view name) {
  return name.ends_with(".vert") || name.ends_with(".frag") || name.ends_with(".comp");
}

TEST_F(EsShaders, EveryProgramCompilesAndLinks) {
  std::unique_ptr<es::EsContext> context;
  if (const auto why = es::EsContext::make(context, *context_)) GTEST_SKIP() << *why;
  EXPECT_NE(std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))).find("OpenGL ES 3"),
            std::string::npos);
  for (const EsProgram& program : es_programs()) {
    std::string log;
    const GLuint made = es::es_program(program, log);
    EXPECT_NE(made, 0u) << told(program) << ": " << log;
    glDeleteProgram(made);
  }
}

TEST_F(EsShaders, TheCompilerRefusesWhatEsLacks) {
  std::unique_ptr<es::EsContext> context;
  if (const auto why = es::EsContext::make(context, *context_)) GTEST_SKIP() << *why;
  const auto fragment = [](const std::string& look) {
    const std::string file = "SHARED float look(float x) { " + look +
                             " }\nlayout(location = 0) out vec4 color;\n" +
                             "void main() { color = vec4(look(gl_FragCoord.x)); }\n";
    const EmbeddedShader files[] = {{"a", file}};
    const std::vector<std::string> defines{"SHARED"};
    std::string log;
    es::compiled(GL_FRAGMENT_SHADER, es_shader_source("a", defines, files).value().text, log);
    return log;
  };
  EXPECT_EQ(fragment("return 2.0 * x;"), "");
  for (const char* lacking : {"return 2 * x;", "float y = 1; return x + y;", "double y = 1.0; return x;",
                              "return fma(x, x, x);", "return float(bitCount(int(x)));"})
    EXPECT_NE(fragment(lacking), "") << lacking;
}

TEST_F(EsShaders, EveryFileIsInOneOfTheLists) {
  std::set<std::string> drawn;
  for (const EsProgram& program : es_programs()) drawn.insert({program.vertex, program.fragment});
  std::set<std::string> refused;
  for (const NotInEs& file : files_not_in_es()) {
    EXPECT_FALSE(file.why.empty());
    refused.insert(file.name);
  }
  for (const EmbeddedShader& file : embedded_shaders()) {
    const std::string name(file.name);
    if (!is_file_of_a_stage(name)) continue;
    EXPECT_EQ(drawn.count(name) + refused.count(name), 1u) << name;
    drawn.erase(name);
    refused.erase(name);
  }
  EXPECT_TRUE(drawn.empty() && refused.empty()) << "a list has a file that is gone";
}

// What a file's conditions ask for, some program that has the file is compiled with.
TEST_F(EsShaders, EveryDefineIsInOneOfTheLists) {
  static const std::regex kAsked(R"(#if(?:def|ndef) (\w+)|defined\((\w+)\))");
  std::set<std::pair<std::string, std::string>> compiled_with;  // file, define
  std::set<std::string> files;
  for (const EsProgram& program : es_programs()) {
    std::set<std::string> of_program;
    for (const std::string& stage : {program.vertex, program.fragment}) add_with_included(stage, of_program);
    for (const std::string& file : of_program)
      for (const std::string& define : program.defines)
        compiled_with.insert({file, define.substr(0, define.find(' '))});
    files.merge(of_program);
  }
  std::set<std::string> without;
  for (const NotInEs& define : defines_not_in_es()) without.insert(define.name);
  std::set<std::string> left_over = without;
  for (const std::string& file : files) {
    for (const std::string& word : found_in(text_of(file), kAsked)) {
      left_over.erase(word);
      EXPECT_NE(without.contains(word), compiled_with.contains({file, word})) << file << ": " << word;
    }
  }
  EXPECT_TRUE(left_over.empty()) << *left_over.begin() << " is gone";
}

TEST_F(EsShaders, WhatEsLacksIsRefusedByName) {
  for (const NotInEs& file : files_not_in_es()) {
    const std::vector<std::string> defines{"COMPUTE", "LANES 8", "MIXED 1"};
    EXPECT_FALSE(es_shader_source(file.name, defines)) << file.name;
  }
  for (const auto& [file, what] :
       {std::pair{"splat.comp", "compute shaders"}, std::pair{"chord_sum.frag", "storage buffers"}}) {
    const auto text = es_shader_source(file);
    ASSERT_FALSE(text) << file;
    EXPECT_NE(text.error().text().find(what), std::string::npos) << text.error().text();
  }
  const std::vector<std::string> compute{"COMPUTE"};
  EXPECT_FALSE(es_shader_source("copy.frag", compute));
  EXPECT_TRUE(es_shader_source("copy.frag"));
  EXPECT_FALSE(es_shader_source("no such file"));
}

// As many as every ES 3.0 has (OpenGL ES 3.0.6, table 6.32).
TEST_F(EsShaders, NoProgramHasMoreTexturesThanEveryEsTakes) {
  for (const EsProgram& program : es_programs()) {
    for (const std::string& file : {program.vertex, program.fragment}) {
      const auto made = es_shader_source(file, program.defines);
      ASSERT_TRUE(made) << told(program);
      const EsShader& shader = made.value();
      EXPECT_LE(shader.textures.size() + shader.buffers.size(), 16u) << told(program);
      std::set<int> units;
      for (const EsBinding& texture : shader.textures) units.insert(texture.at);
      for (const EsBuffer& buffer : shader.buffers) units.insert(buffer.unit);
      EXPECT_EQ(units.size(), shader.textures.size() + shader.buffers.size()) << told(program);
      EXPECT_TRUE(units.empty() || *units.rbegin() < 32) << told(program);
    }
  }
}

TEST_F(EsShaders, BindingsAreToldInPlaceOfTheText) {
  const EmbeddedShader files[] = {{"a",
                                   "layout(std140, binding = 3) uniform Block { vec4 x; };\n"
                                   "layout(binding = 7) uniform sampler2D seen;  // what for\n"
                                   "layout(location = 0) out vec4 color;\n"}};
  const auto text = es_shader_source("a", {}, files);
  ASSERT_TRUE(text);
  EXPECT_EQ(text.value().text.find("binding"), std::string::npos);
  EXPECT_NE(text.value().text.find("layout(location = 0) out"), std::string::npos);
  EXPECT_EQ(text.value().textures, (std::vector<EsBinding>{{"seen", 7}}));
  EXPECT_EQ(text.value().blocks, (std::vector<EsBinding>{{"Block", 3}}));
}

TEST_F(EsShaders, BuffersArraysAndSecondOutputsAreRewritten) {
  const EmbeddedShader files[] = {
      {"a",
       "struct Two {\n  vec4 x;  // one\n  vec4 y;\n};\n"
       "layout(std430, binding = 1) readonly buffer Twos { Two twos[]; };  // what for\n"
       "layout(binding = 4) uniform sampler2D many[MANY];\n"
       "layout(location = 0, index = 0) out vec4 added;\n"
       "layout(location = 0, index = 1) out vec4 through;\n"
       "float at(int i) { return twos[i + some[0]].x.x + texelFetch(many[i], ivec2(0), 0).r; }\n"}};
  const std::vector<std::string> first{"MANY 2"};
  const auto text = es_shader_source("a", first, files);
  ASSERT_TRUE(text);
  const auto has = [&](const auto& made, std::string_view part) {
    return made.value().text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(text, "Two twos_at(int i) { return Two(twos_texel(2 * i + 0), twos_texel(2 * i + 1)); }"));
  EXPECT_TRUE(has(text, "twos_at(i + some[0]).x.x")) << text.value().text;
  EXPECT_TRUE(has(text, "fetch_of_many(i, ivec2(0), 0)"));
  EXPECT_EQ(text.value().buffers, (std::vector<EsBuffer>{{"twos_texels", kEsBufferUnit + 1, 2}}));
  EXPECT_EQ(text.value().textures, (std::vector<EsBinding>{{"many[0]", 4}, {"many[1]", 5}}));
  EXPECT_TRUE(has(text, "layout(location = 0) out vec4 added;\nvec4 through;"));
  const std::vector<std::string> second{"MANY 2", kSecondOutput};
  EXPECT_TRUE(
      has(es_shader_source("a", second, files), "vec4 added;\nlayout(location = 0) out vec4 through;"));

  const EmbeddedShader mixed[] = {
      {"b",
       "struct S {\n  vec4 x;\n  float y;\n};\nlayout(std430, binding = 0) readonly buffer B { S s[]; };\n"}};
  EXPECT_FALSE(es_shader_source("b", {}, mixed)) << "no texel holds it";
}

TEST_F(EsShaders, AreWrittenAsFilesThatAListNames) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "slosh-es-export";
  const auto written = export_es_programs(folder / "in" / "it");
  ASSERT_TRUE(written) << written.error().text();
  EXPECT_EQ(written.value(), es_programs().size());
  const auto read = [&](const char* file) {
    std::ifstream in(folder / "in" / "it" / file);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto list = nlohmann::json::parse(read("programs.json"));
  ASSERT_EQ(list.size(), es_programs().size());
  bool splats = false;
  for (const auto& program : list) {
    for (const char* stage : {"vertex", "fragment"}) {
      const std::string file = program[stage]["file"];
      EXPECT_TRUE(read(file.c_str()).starts_with("#version 300 es")) << file;
    }
    if (program["vertex"]["file"] != "splat-FRONT-SHAPED.vert") continue;
    splats = true;
    EXPECT_EQ(program["vertex"]["buffers"]["shapes_texels"]["texels"], 2);
    EXPECT_EQ(program["vertex"]["blocks"]["FrameBlock"], 0);
  }
  EXPECT_TRUE(splats);
  // A different text under a name would have been written over.
  for (std::size_t i = 0; i < list.size(); ++i)
    for (const auto& [stage, name] :
         {std::pair{"vertex", es_programs()[i].vertex}, std::pair{"fragment", es_programs()[i].fragment}})
      EXPECT_EQ(es_shader_source(name, es_programs()[i].defines).value().text,
                read(list[i][stage]["file"].get<std::string>().c_str()));
  std::ofstream(folder / "file") << "x";
  EXPECT_FALSE(export_es_programs(folder / "file" / "below"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace slosh
