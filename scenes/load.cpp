#include "scenes/load.h"

#include <exception>

#include "net/text/clean.h"
#include "scenes/gltf/document.h"
#include "scenes/reading/reading.h"

namespace slosh {
namespace {

using reading::NodeKind;
using reading::Problem;
using reading::Reading;

using ReadNode = Problem (*)(Reading&, int);

/// Files have names by which a terminal could be told to do something, too.
Error shown(const Error& error) {
  constexpr std::size_t kMost = 2000;
  return {clean_text(error.where, kMost), clean_text(error.what, kMost), clean_text(error.mend, kMost)};
}

Problem read_all(Reading& reading, NodeKind kind, ReadNode read) {
  for (const int node : reading.document.nodes) {
    if (reading.kinds[node] != kind) continue;
    if (Problem problem = read(reading, node)) return problem;
  }
  return std::nullopt;
}

Problem something_to_simulate(Reading& reading) {
  if (!reading.scene.bodies.empty() || !reading.scene.fluid_volumes.empty()) return std::nullopt;
  return Error{
      reading.document.file, "the scene has neither a body nor a fluid",
      "Give at least one object the custom property slosh = \"body\" or \"fluid\", and export with custom "
      "properties on"};
}

Problem nothing_that_settling_would_undo(Reading& reading) {
  if (reading.scene.settle == 0.0) return std::nullopt;
  for (const FluidVolume& volume : reading.scene.fluid_volumes) {
    if (volume.velocity == glm::dvec3(0.0)) continue;
    return Error{reading.document.file + ": node '" + volume.name + "': extras.velocity_m_s",
                 "would be lost: the scene's settle_s brings the fluid to rest before the run",
                 "Remove one of the two"};
  }
  return std::nullopt;
}

Result<Scene> read_scene(const std::filesystem::path& file) {
  const Result<gltf::Document> document = gltf::read_document(file);
  if (!document) return document.error();
  Reading reading{document.value(), {}, {}, {}, {}, {}, {}, 0, {}};
  reading.scene.name = clean_text(file.stem().string(), kMostTextBytes);
  reading.scene.source_file = file.string();
  const auto stages = {
      +[](Reading& r) { return reading::read_kinds(r); },
      +[](Reading& r) { return reading::read_scene_fields(r); },
      +[](Reading& r) { return read_all(r, NodeKind::kFluid, reading::read_fluid_volume); },
      +[](Reading& r) { return read_all(r, NodeKind::kBody, reading::read_body); },
      +[](Reading& r) { return read_all(r, NodeKind::kProbe, reading::read_probe); },
      +[](Reading& r) { return read_all(r, NodeKind::kPicture, reading::read_picture); },
      +[](Reading& r) { return something_to_simulate(r); },
      +[](Reading& r) { return nothing_that_settling_would_undo(r); },
      +[](Reading& r) { return read_all(r, NodeKind::kGrip, reading::read_grip); },
      +[](Reading& r) { return reading::order_grips(r); },
      +[](Reading& r) { return read_all(r, NodeKind::kHand, reading::read_hand); },
      +[](Reading& r) { return read_all(r, NodeKind::kGauge, reading::read_gauge); },
      +[](Reading& r) { return read_all(r, NodeKind::kRegion, reading::read_region); },
      +[](Reading& r) { return reading::read_camera(r); },
      +[](Reading& r) { return reading::read_domain(r); },
  };
  for (const auto stage : stages) {
    if (const Problem problem = stage(reading)) return *problem;
  }
  return std::move(reading.scene);
}

}  // namespace

Result<Scene> load_scene(const std::filesystem::path& file) {
  try {
    Result<Scene> scene = read_scene(file);
    if (!scene) return shown(scene.error());
    return scene;
  } catch (
      const std::exception& problem) {  // out of memory, a library's own; never the way of an expected error
    return shown({file.string(), std::string("cannot be read: ") + problem.what(), "Export the file again"});
  }
}

}  // namespace slosh
