#include "render/gl/es_programs.h"

#include "render/environment.h"
#include "render/gl/es_lowering.h"

namespace slosh {

std::vector<EsProgram> es_programs() {
  const auto with = [](std::vector<std::string> defines, std::initializer_list<const char*> more) {
    defines.insert(defines.end(), more.begin(), more.end());
    return defines;
  };
  std::vector<EsProgram> all = {
      // The fluid's depths, and its way through.
      {"splat.vert", "splat.frag", {"FRONT"}},
      {"splat.vert", "splat.frag", {"FRONT", "SHAPED"}},
      {"splat.vert", "splat.frag", {}},
      {"chord.vert", "chord.frag", {}},
      {"fluid_shadow.vert", "fluid_shadow.frag", {}},
      {"mixing.vert", "mixing.frag", {}},
      {"caustics.vert", "caustics.frag", {}},
      // Its surface: ours, the paper's, curvature flow.
      {"tiles.vert", "narrow_range.frag", {"FIRST"}},
      {"tiles.vert", "narrow_range.frag", {}},
      {"tiles.vert", "narrow_range.frag", {"CLEAN"}},
      {"tiles.vert", "smooth.frag", {}},
      {"tiles.vert", "curvature_flow.frag", {}},
      {"tiles.vert", "thickness.frag", {}},
      {"tiles.vert", "normal.frag", {}},
      // What is the same wherever the light comes from.
      {"depth_only.vert", "nothing.frag", {}},
      {"fullscreen.vert", "occlusion.frag", {"TAPS 8"}},
      {"fullscreen.vert", "resolve.frag", {}},
      {"fullscreen.vert", "copy.frag", {}},
      {"fullscreen.vert", "fill.frag", {}},
      {"fullscreen.vert", "display.frag", {}},
      {"fullscreen.vert", "edges.frag", {}},
  };
  // By the studio's formula, and by a picture of a room (passes/far_light.cpp).
  const std::vector<std::string> room = {"FAR_LIGHT " + std::to_string(LightProbe::kSharp) + ".0",
                                         "BLURRED_FAR_LIGHT " + std::to_string(LightProbe::kBlurred) + ".0"};
  for (const std::vector<std::string>& light : {std::vector<std::string>{}, room}) {
    all.push_back({"fullscreen.vert", "background.frag", light});
    all.push_back({"tiles.vert", "composite.frag", light});
    for (const auto& look : {with(light, {}), with(light, {"FAST"}), with(light, {"BODIES"}),
                             with(light, {"CAUSTICS"}), with(light, {"BODIES", "CAUSTICS"})})
      for (const char* mixed : {"", "MIXED 1", "MIXED 4"})
        all.push_back({"tiles.vert", "fluid_look.frag", *mixed ? with(look, {mixed}) : look});
    for (const auto& quality : {with(light, {}), with(light, {"FAST"})}) {
      all.push_back({"mesh.vert", "mesh.frag", quality});
      all.push_back({"mesh.vert", "mesh.frag", with(quality, {"EMITS"})});
      all.push_back({"mesh.vert", "mesh.frag",
                     with(quality, {"TEXTURED", "BASE_MAP", "METAL_ROUGH_MAP", "NORMAL_MAP", "OCCLUSION_MAP",
                                    "EMISSIVE_MAP", "EMITS", "HOLES"})});
    }
    // Each pane twice: what is behind it times its second output, then its first added.
    for (const char* output : {"", kSecondOutput})
      for (const auto& pane :
           {with(light, {}), with(light, {"BEHIND"}), with(light, {"TEXTURED", "BASE_MAP"}),
            with(light, {"BEHIND", "TEXTURED", "BASE_MAP"})})
        all.push_back({"mesh.vert", "translucent.frag", *output ? with(pane, {output}) : pane});
    all.push_back({"foam.vert", "foam.frag", with(light, {"FAST"})});
    all.push_back({"arrow.vert", "arrow.frag", light});
  }
  return all;
}

std::vector<NotInEs> files_not_in_es() {
  std::vector<NotInEs> out;
  for (const char* file : {"cells_begin.comp", "cells_clear.comp", "cells_deep.comp", "cells_fill.comp",
                           "particles.comp", "smooth_centers.comp", "splats.comp"})
    out.push_back(
        {file, "compute shaders: particles are made ready on the CPU (prepare_splats, SmoothCenters)"});
  for (const char* file : {"splat.comp", "chord.comp", "fluid_shadow.comp", "mixing.comp"})
    out.push_back({file, "compute shaders: the same is drawn as triangles or points that blend"});
  for (const char* file : {"chord_sum.frag", "fluid_shadow_sum.frag", "mixing_sum.frag"})
    out.push_back({file, "reads the sums of compute shaders: blending leaves none"});
  for (const char* file : {"mesh_triangles.comp", "mesh_pixels.comp", "glass_pixels.comp"})
    out.push_back({file, "compute shaders: meshes are drawn as triangles with a depth buffer"});
  return out;
}

std::vector<NotInEs> defines_not_in_es() {
  return {{"COMPUTE", "compute shaders"},
          {"EACH", "pixels of a compute shader's invocation"},
          {"PANES", "panes that compute shaders shaded beside the fluid: panes are drawn over it"},
          {"BY_TEXT", "the text that OpenColorIO gives is desktop GLSL: light goes through the table"}};
}

}  // namespace slosh
