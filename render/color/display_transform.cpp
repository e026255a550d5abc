#include "render/color/display_transform.h"

#include <OpenColorIO/OpenColorIO.h>

#include <array>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

#include "net/text/clean.h"
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

/// What the library warns of by itself holds words of the file: an unknown key, say.
void say_warnings_cleanly() {
  ocio::SetLoggingFunction(
      [](const char* message) { std::fputs(clean_lines(message, kMaxTextBytes).c_str(), stderr); });
}

/// What a configuration or the library says, fit to be shown.
Error refused(const std::string& where, const std::string& what, const char* mend) {
  constexpr std::size_t kMax = 4000;
  // A mend is put behind it, with a stop between: the library has one of its own.
  const std::size_t end = what.find_last_not_of(". \n");
  return {clean_text(where, kMax), clean_text(what.substr(0, end == std::string::npos ? 0 : end + 1), kMax),
          mend};
}

constexpr const char* kMend =
    "Give --ocio, --display and --view what `ociocheck` lists, or none of them for the built-in transform";

template <class Name>
std::string list_of(int count, Name&& name) {
  std::string list;
  for (int i = 0; i < count; ++i) list += (i == 0 ? "" : ", ") + std::string("'") + name(i) + "'";
  return list.empty() ? "none" : list;
}

/// The colour space of a user's config that is ACES2065-1 there, by the role that OpenColorIO 2 has for it,
/// or by the names it goes by; empty without.
std::string interchange_of(const ocio::ConstConfigRcPtr& config) {
  if (config->hasRole(ocio::ROLE_INTERCHANGE_SCENE)) return ocio::ROLE_INTERCHANGE_SCENE;
  for (const char* name : {"ACES2065-1", "ACES - ACES2065-1", "aces2065_1", "lin_ap0"}) {
    if (config->getColorSpace(name)) return name;
  }
  return {};
}

Result<ocio::ConstConfigRcPtr> read_config(const ColorConfig& color) {
  say_warnings_cleanly();
  try {
    return ocio::Config::CreateFromFile(color.file.c_str());
  } catch (const std::exception& failure) {
    return refused("colour configuration '" + color.file + "'", failure.what(), kMend);
  }
}

ocio::DisplayViewTransformRcPtr to_display(const std::string& from, const std::string& display,
                                           const std::string& view) {
  auto transform = ocio::DisplayViewTransform::Create();
  transform->setSrc(from.c_str());
  transform->setDisplay(display.c_str());
  transform->setView(view.c_str());
  return transform;
}

/// The built-in one, within make_config().
ocio::DisplayViewTransformRcPtr built_in(Display display) {
  return to_display("Linear Rec.709", "sRGB", display == Display::kAces ? "ACES" : "Plain");
}

/// From our light to ACES2065-1 as numbers, for a config of any version: a matrix.
ocio::MatrixTransformRcPtr to_aces() {
  std::array<glm::vec3, 3> columns{glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)};
  ocio::PackedImageDesc pixels(&columns.front().x, 3, 1, 3);
  make_config()->getProcessor("Linear Rec.709", "ACES2065-1")->getDefaultCPUProcessor()->apply(pixels);
  std::array<double, 16> rows{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      rows[static_cast<std::size_t>(4 * r + c)] = columns[static_cast<std::size_t>(c)][r];
  }
  rows[15] = 1.0;
  auto matrix = ocio::MatrixTransform::Create();
  matrix->setMatrix(rows.data());
  return matrix;
}

/// Our light, first to ACES2065-1 by our config, then by the user's to its display.
std::optional<Error> put_through(const ColorConfig& color, std::vector<glm::vec3>& colors) {
  const auto config = read_config(color);
  if (!config) return config.error();
  try {
    ocio::PackedImageDesc pixels(&colors.front().x, static_cast<long>(colors.size()), 1, 3);
    make_config()->getProcessor("Linear Rec.709", "ACES2065-1")->getDefaultCPUProcessor()->apply(pixels);
    config.value()
        ->getProcessor(to_display(interchange_of(config.value()), color.display, color.view))
        ->getDefaultCPUProcessor()
        ->apply(pixels);
  } catch (const std::exception& failure) {
    return refused("colour configuration '" + color.file + "'", failure.what(), kMend);
  }
  return std::nullopt;
}

}  // namespace

Result<ColorConfig> find_display_view(const ColorConfig& asked) {
  const auto read = read_config(asked);
  if (!read) return read.error();
  const ocio::ConstConfigRcPtr& config = read.value();
  const std::string where = "colour configuration '" + asked.file + "'";
  ColorConfig found = asked;
  try {
    if (found.display.empty()) found.display = config->getDefaultDisplay();
    if (config->getNumViews(found.display.c_str()) == 0) {
      return refused(where,
                     "has no display '" + found.display + "'; it has " +
                         list_of(config->getNumDisplays(), [&](int i) { return config->getDisplay(i); }),
                     kMend);
    }
    if (found.view.empty()) found.view = config->getDefaultView(found.display.c_str());
    const int views = config->getNumViews(found.display.c_str());
    bool has = false;
    for (int i = 0; i < views; ++i) has = has || found.view == config->getView(found.display.c_str(), i);
    if (!has) {
      return refused(where,
                     "has no view '" + found.view + "' for the display '" + found.display + "'; it has " +
                         list_of(views, [&](int i) { return config->getView(found.display.c_str(), i); }),
                     kMend);
    }
    if (interchange_of(config).empty()) {
      return refused(where,
                     "says nowhere which of its colour spaces is ACES2065-1, by which light is handed over",
                     "Add the role aces_interchange to it, as OpenColorIO 2 has it");
    }
  } catch (const std::exception& failure) {
    return refused(where, failure.what(), kMend);
  }
  std::vector<glm::vec3> one{glm::vec3(0.18f)};  // its look-up tables are files too
  if (const auto failed = put_through(found, one)) return *failed;
  return found;
}

Result<std::vector<glm::vec3>> display_colors(Display display, std::span<const glm::vec3> linear,
                                              const ColorConfig& color) {
  std::vector<glm::vec3> colors(linear.begin(), linear.end());
  if (colors.empty()) return colors;
  if (!color.file.empty()) {
    if (const auto failed = put_through(color, colors)) return *failed;
    for (glm::vec3& c : colors) c = glm::clamp(c, 0.0f, 1.0f);
    return colors;
  }
  try {
    const auto processor = make_config()->getProcessor(built_in(display))->getDefaultCPUProcessor();
    ocio::PackedImageDesc pixels(&colors.front().x, static_cast<long>(colors.size()), 1, 3);
    processor->apply(pixels);
  } catch (const std::exception& failure) {
    return Error{"display transform", failure.what(), "Install OpenColorIO 2.1 or later"};
  }
  for (glm::vec3& shown : colors) shown = glm::clamp(shown, 0.0f, 1.0f);
  return colors;
}

Result<std::vector<glm::vec3>> make_display_table(Display display, const ColorConfig& color) {
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
  return display_colors(display, nodes, color);
}

Result<std::optional<std::string>> display_shader(Display display, const ColorConfig& color) {
  ocio::ConstConfigRcPtr config;
  if (!color.file.empty()) {
    const auto read = read_config(color);
    if (!read) return read.error();
    config = read.value();
  }
  try {
    ocio::ConstProcessorRcPtr processor;
    if (config) {
      auto both = ocio::GroupTransform::Create();
      both->appendTransform(to_aces());
      both->appendTransform(to_display(interchange_of(config), color.display, color.view));
      processor = config->getProcessor(both);
    } else {
      processor = make_config()->getProcessor(built_in(display));
    }
    auto shader = ocio::GpuShaderDesc::CreateShaderDesc();
    shader->setLanguage(ocio::GPU_LANGUAGE_GLSL_4_0);
    shader->setFunctionName("display_color");
    shader->setResourcePrefix("ocio");
    processor->getDefaultGPUProcessor()->extractGpuShaderInfo(shader);
    if (shader->getNumTextures() + shader->getNum3DTextures() + shader->getNumUniforms() > 0)
      return std::optional<std::string>();
    return std::optional<std::string>(shader->getShaderText());
  } catch (const std::exception& failure) {
    return refused(color.file.empty() ? "display transform" : "colour configuration '" + color.file + "'",
                   failure.what(), kMend);
  }
}

}  // namespace slosh
