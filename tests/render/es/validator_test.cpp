// The texts in OpenGL ES 3.0's dialect through Khronos' own reference compiler (glslangValidator): it holds
// to the language where drivers are lenient.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "render/gl/es_programs.h"
#include "render/gl/es_source.h"

namespace slosh {
namespace {

class EsValidator : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
      GTEST_SKIP() << "no glslangValidator here (Debian's glslang-tools)";
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("slosh-es-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  /// What it says against a program; empty if nothing.
  std::string said_of(const std::string& vertex, const std::string& fragment) const {
    const std::filesystem::path files[] = {folder_ / "program.vert", folder_ / "program.frag"};
    std::ofstream(files[0]) << vertex;
    std::ofstream(files[1]) << fragment;
    const std::filesystem::path log = folder_ / "log";
    const std::string command = "glslangValidator -l '" + files[0].string() + "' '" + files[1].string() +
                                "' > '" + log.string() + "' 2>&1";
    if (std::system(command.c_str()) == 0) return {};
    std::ifstream in(log);
    return "refused: " + std::string(std::istreambuf_iterator<char>(in), {});
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(EsValidator, TakesEveryProgram) {
  for (const EsProgram& program : es_programs()) {
    const auto vertex = es_shader_source(program.vertex, program.defines);
    const auto fragment = es_shader_source(program.fragment, program.defines);
    ASSERT_TRUE(vertex && fragment);
    std::string defines;
    for (const std::string& define : program.defines) defines += " " + define;
    EXPECT_EQ(said_of(vertex.value().text, fragment.value().text), "")
        << program.vertex << ", " << program.fragment << defines;
  }
}

TEST_F(EsValidator, RefusesWhatEsLacks) {
  const std::string vertex = es_shader_source("fullscreen.vert").value().text;
  const auto fragment = [](const std::string& before, const std::string& value) {
    const std::string file =
        before +
        "layout(location = 0) out vec4 color;\nvoid main() { float x = gl_FragCoord.x; color = vec4(" +
        value + "); }\n";
    const EmbeddedShader files[] = {{"a", file}};
    return es_shader_source("a", {}, files).value().text;
  };
  EXPECT_EQ(said_of(vertex, fragment("", "x")), "");
  EXPECT_NE(said_of(vertex, fragment("", "2 * x")), "");
  EXPECT_NE(said_of(vertex, fragment("", "fma(x, x, x)")), "");
  // Names of later versions are taken: a driver lets them pass.
  EXPECT_NE(
      said_of(vertex, fragment("vec4 textureGather(sampler2D s, vec2 at) { return vec4(0.0); }\n", "x")), "");
  // A number that a loop counts is none that the language lets choose a texture.
  EXPECT_NE(said_of(vertex, fragment("uniform sampler2D s[2];\n", "texture(s[int(x)], vec2(0.0)).r")), "");
}

}  // namespace
}  // namespace slosh
