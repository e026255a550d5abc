#include "render/passes/far_light.h"

#include <array>

namespace slosh {
namespace {

// Units and binding of shaders/environment.glsl.
constexpr GLuint kSharpUnit = 10;
constexpr GLuint kBlurredUnit = 11;
constexpr GLuint kDiffuseBinding = 2;

}  // namespace

void FarLight::choose(std::shared_ptr<const Environment> environment) {
  environment_ = std::move(environment);
  if (!environment_) return;
  const LightProbe probe = make_light_probe(*environment_);
  sharp_ = gl::make_texture(glm::ivec2(LightProbe::kSharp), GL_RGBA16F, GL_LINEAR);
  glTextureSubImage2D(sharp_.name(), 0, 0, 0, LightProbe::kSharp, LightProbe::kSharp, GL_RGB, GL_FLOAT,
                      probe.sharp.data());
  GLuint layers = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &layers);
  blurred_ = gl::Texture(layers);
  glTextureStorage3D(layers, 1, GL_RGBA16F, LightProbe::kBlurred, LightProbe::kBlurred, LightProbe::kLayers);
  glTextureSubImage3D(layers, 0, 0, 0, 0, LightProbe::kBlurred, LightProbe::kBlurred, LightProbe::kLayers,
                      GL_RGB, GL_FLOAT, probe.blurred.data());
  glTextureParameteri(layers, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(layers, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTextureParameteri(layers, wrap, GL_CLAMP_TO_EDGE);
  std::array<glm::vec4, 9> diffuse{};
  for (std::size_t k = 0; k < diffuse.size(); ++k) diffuse[k] = glm::vec4(probe.diffuse[k], 0.0f);
  diffuse_.upload(std::span<const glm::vec4>(diffuse));
}

std::vector<std::string> FarLight::defines() const {
  if (!environment_) return {};
  return {"FAR_LIGHT " + std::to_string(LightProbe::kSharp) + ".0",
          "BLURRED_FAR_LIGHT " + std::to_string(LightProbe::kBlurred) + ".0"};
}

void FarLight::bind() const {
  if (!environment_) return;
  glBindTextureUnit(kSharpUnit, sharp_.name());
  glBindTextureUnit(kBlurredUnit, blurred_.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, kDiffuseBinding, diffuse_.name());
}

}  // namespace slosh
