#include "render/color/display_transform.h"

#include <OpenColorIO/OpenColorIO.h>

#include <exception>

#include "render/shader_math.h"

namespace slosh {
namespace {

namespace ocio = OCIO_NAMESPACE;

ocio::BuiltinTransformRcPtr builtin(const char* style,
                                    ocio::TransformDirection direction = ocio::TRANSFORM_DIR_FORWARD) {
  auto transform = ocio::BuiltinTransform::Create();
  transform->setStyle(style);
  transform->setDirection(direction);
  return transform;
}

/// A config as a studio would write it: scene reference ACES2065-1, display reference CIE XYZ D65.
ocio::ConstConfigRcPtr make_config() {
  auto config = ocio::Config::Create();
  config->setVersion(2, 0);

  auto reference = ocio::ColorSpace::Create(ocio::REFERENCE_SPACE_SCENE);
  reference->setName("ACES2065-1");
  config->addColorSpace(reference);

  auto working = ocio::ColorSpace::Create(ocio::REFERENCE_SPACE_SCENE);
  working->setName("Linear Rec.709");
  auto to_reference = ocio::GroupTransform::Create();
  to_reference->appendTransform(
      builtin("UTILITY - ACES-AP1_to_LINEAR-REC709_BFD", ocio::TRANSFORM_DIR_INVERSE));
  to_reference->appendTransform(builtin("ACEScg_to_ACES2065-1"));
  working->setTransform(to_reference, ocio::COLORSPACE_DIR_TO_REFERENCE);
  config->addColorSpace(working);

  auto screen = ocio::ColorSpace::Create(ocio::REFERENCE_SPACE_DISPLAY);
  screen->setName("sRGB");
  screen->setTransform(builtin("DISPLAY - CIE-XYZ-D65_to_sRGB"), ocio::COLORSPACE_DIR_FROM_REFERENCE);
  config->addColorSpace(screen);

  auto view = ocio::ViewTransform::Create(ocio::REFERENCE_SPACE_SCENE);
  view->setName("ACES SDR video");
  view->setTransform(builtin("ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0"),
                     ocio::VIEWTRANSFORM_DIR_FROM_REFERENCE);
  config->addViewTransform(view);
  config->addDisplayView("sRGB", "ACES", "ACES SDR video", "sRGB", "", "", "");

  // Plain sRGB has no view transform: the working space straight through the display's own curve.
  auto plain = ocio::ColorSpace::Create(ocio::REFERENCE_SPACE_SCENE);
  plain->setName("sRGB texture");
  auto from_working = ocio::GroupTransform::Create();
  auto clip = ocio::RangeTransform::Create();
  clip->setMinInValue(0.0);
  clip->setMinOutValue(0.0);
  clip->setMaxInValue(1.0);
  clip->setMaxOutValue(1.0);
  auto curve = ocio::ExponentWithLinearTransform::Create();
  curve->setGamma({2.4, 2.4, 2.4, 1.0});
  curve->setOffset({0.055, 0.055, 0.055, 0.0});
  curve->setDirection(ocio::TRANSFORM_DIR_INVERSE);
  auto to_working = ocio::ColorSpaceTransform::Create();
  to_working->setSrc("ACES2065-1");
  to_working->setDst("Linear Rec.709");
  from_working->appendTransform(to_working);
  from_working->appendTransform(clip);
  from_working->appendTransform(curve);
  plain->setTransform(from_working, ocio::COLORSPACE_DIR_FROM_REFERENCE);
  config->addColorSpace(plain);
  config->addDisplayView("sRGB", "Plain", "sRGB texture", "");
  return config;
}

}  // namespace

Result<std::vector<glm::vec3>> display_colors(Display display, std::span<const glm::vec3> linear) {
  std::vector<glm::vec3> colors(linear.begin(), linear.end());
  if (colors.empty()) return colors;
  try {
    auto transform = ocio::DisplayViewTransform::Create();
    transform->setSrc("Linear Rec.709");
    transform->setDisplay("sRGB");
    transform->setView(display == Display::kAces ? "ACES" : "Plain");
    const auto processor = make_config()->getProcessor(transform)->getDefaultCPUProcessor();
    ocio::PackedImageDesc pixels(&colors.front().x, static_cast<long>(colors.size()), 1, 3);
    processor->apply(pixels);
  } catch (const std::exception& failure) {
    return Error{"display transform", failure.what(), "Install OpenColorIO 2.1 or later"};
  }
  for (glm::vec3& color : colors) color = glm::clamp(color, 0.0f, 1.0f);
  return colors;
}

Result<std::vector<glm::vec3>> make_display_table(Display display) {
  const int n = kDisplayTableSize;
  std::vector<glm::vec3> nodes;
  nodes.reserve(static_cast<std::size_t>(n) * n * n);
  for (int b = 0; b < n; ++b) {
    for (int g = 0; g < n; ++g) {
      for (int r = 0; r < n; ++r) {
        nodes.push_back(shader::display_unshape(glm::vec3(r, g, b) / static_cast<float>(n - 1)));
      }
    }
  }
  return display_colors(display, nodes);
}

}  // namespace slosh
