// The stages of reading a scene, in order: to the first problem, or through all of them.
#include <algorithm>

#include "net/text/clean.h"
#include "scenes/gltf/ledger.h"
#include "scenes/reading/reading.h"

namespace slosh::reading {
namespace {

/// More is one mistake that was made often, and nobody reads on.
constexpr std::size_t kMaxProblems = 100;

/// s, where nothing is said: what the shipped scenes take.
constexpr double kUsualSettle = 1.0;
constexpr double kLongestSettle = 4.0;  // s, where what hands feel is not steady before

using ReadNode = Problem (*)(Reading&, int);

Problem something_to_simulate(Reading& reading) {
  if (!reading.scene.bodies.empty() || !reading.scene.fluid_volumes.empty()) return std::nullopt;
  return Error{
      reading.document.file, "the scene has neither a body nor a fluid",
      "Give at least one object the custom property slosh = \"body\" or \"fluid\", and export with custom "
      "properties on"};
}

/// What starts with a velocity is not to be brought to rest, what is written is done as it is written.
Problem settle_as_usual(Reading& reading) {
  Scene& scene = reading.scene;
  if (reading.document.scene_extras.contains("settle_s")) return std::nullopt;
  const auto moves = [](const FluidVolume& volume) {
    return volume.velocity != glm::dvec3(0.0) && !volume.starts_away;
  };
  const auto thrown = [](const Body& body) {
    return (body.twist.linear != glm::dvec3(0.0) || body.twist.angular != glm::dvec3(0.0)) &&
           !body.starts_away;
  };
  if (std::ranges::none_of(scene.fluid_volumes, moves) && std::ranges::none_of(scene.bodies, thrown))
    scene.settle = kUsualSettle, scene.settle_longest = kLongestSettle;
  return std::nullopt;
}

Problem nothing_that_settling_would_undo(Reading& reading) {
  if (reading.scene.settle == 0.0) return std::nullopt;
  for (const FluidVolume& volume : reading.scene.fluid_volumes) {
    if (volume.velocity == glm::dvec3(0.0) || volume.starts_away) continue;
    return Error{reading.document.file + ": node '" + volume.name + "': extras.velocity_m_s",
                 "would be lost: the scene's settle_s brings the fluid to rest before the run",
                 "Remove one of the two"};
  }
  return std::nullopt;
}

/// Whether what is wrong with a node may come from what is wrong with another: what it hangs on, or the grip
/// or body that it names, could not be read.
bool follows_from_another(const Reading& reading, int node) {
  const gltf::Document& document = reading.document;
  for (int up = document.parent[node]; up >= 0; up = document.parent[up])
    if (reading.failed.contains(up)) return true;
  const nlohmann::json& extras = document.extras[node];
  for (const char* key : {"grip", "to"}) {
    if (!extras.contains(key) || !extras[key].is_string()) continue;
    for (const int failed : reading.failed)
      if (document.name(failed) == extras[key].get<std::string>()) return true;
  }
  return false;
}

class Stages {
 public:
  Stages(Reading& reading, std::vector<Error>& problems, bool all)
      : reading_(reading), problems_(problems), all_(all) {}

  /// Every node, or those of one kind.
  void nodes(ReadNode read, std::optional<NodeKind> kind = std::nullopt) {
    for (const int node : reading_.document.nodes) {
      if (over() || (kind && reading_.kinds[node] != *kind)) continue;
      const Problem problem = read_one([&] { return read(reading_, node); });
      if (!problem) continue;
      if (!follows_from_another(reading_, node)) note(*problem);
      reading_.failed.insert(node);
    }
  }
  /// `needs_all`: its problem would only say that nodes are missing which could not be read.
  void whole(Problem (*read)(Reading&), bool needs_all = false) {
    if (over() || (needs_all && (!reading_.failed.empty() || !problems_.empty()))) return;
    if (const Problem problem = read_one([&] { return read(reading_); })) note(*problem);
  }

 private:
  template <class Read>
  Problem read_one(Read&& read) {
    reading_.further.clear();
    return read();
  }
  void note(const Error& problem) {
    problems_.push_back(problem);
    problems_.insert(problems_.end(), reading_.further.begin(), reading_.further.end());
  }
  bool over() const { return !problems_.empty() && (!all_ || problems_.size() >= kMaxProblems); }

  Reading& reading_;
  std::vector<Error>& problems_;
  bool all_;
};

/// One list: looks first, which were told as they were met.
void tell_what_is_left_out(Reading& reading, std::vector<gltf::Note>* notes) {
  std::vector<gltf::Note> all;
  for (const Error& look : reading.scene.left_out) all.push_back({"texture", look});
  for (gltf::Note& note : gltf::shortened(std::move(reading.notes))) all.push_back(std::move(note));
  reading.scene.left_out.clear();
  for (const gltf::Note& note : all) reading.scene.left_out.push_back(note.text);
  if (notes) *notes = std::move(all);
}

}  // namespace

Problem all_of(Reading& reading, Problem first, const gltf::Extras& extras) {
  for (Error& error : extras.foreign()) reading.notes.push_back({"foreign-property", std::move(error)});
  for (Error& error : extras.errors()) {
    if (first)
      reading.further.push_back(std::move(error));
    else
      first = std::move(error);
  }
  return first;
}

std::optional<Scene> read_stages(const gltf::Document& document, std::vector<Error>& problems, bool all,
                                 std::vector<gltf::Note>* notes) {
  Reading reading{document, {}, {}, {}, {}, {}, {}, 0, {}, {}, {}, {}, {}, {}, 0, document.notes, 0};
  const std::filesystem::path file = document.file;
  reading.scene.name = clean_text(file.stem().string(), kMaxTextBytes);
  reading.scene.source_file = document.file;
  reading.kinds.assign(document.model.nodes.size(), NodeKind::kNone);
  Stages stages(reading, problems, all);
  stages.nodes(read_kind);
  stages.nodes(check_animated);
  stages.whole(read_scene_fields);
  stages.nodes(read_fluid_volume, NodeKind::kFluid);
  stages.nodes(read_body, NodeKind::kBody);
  stages.nodes(read_probe, NodeKind::kProbe);
  stages.whole(find_carriers, true);
  stages.nodes(read_picture, NodeKind::kPicture);
  stages.whole(something_to_simulate, true);
  stages.whole(settle_as_usual);
  stages.whole(nothing_that_settling_would_undo);
  stages.nodes(read_grip, NodeKind::kGrip);
  stages.whole(order_grips);
  stages.nodes(read_hand, NodeKind::kHand);
  stages.nodes(read_joint, NodeKind::kJoint);
  stages.nodes(read_gauge, NodeKind::kGauge);
  stages.nodes(read_region, NodeKind::kRegion);
  stages.whole(read_task, true);
  stages.whole(read_camera, true);
  stages.whole(read_domain, true);
  stages.whole(fit_spacing, true);
  tell_what_is_left_out(reading, notes);
  if (problems.size() >= kMaxProblems)
    problems.push_back(
        {document.file, "there are more errors than these", "Mend these first, then check again"});
  if (!problems.empty() || !reading.failed.empty()) return std::nullopt;
  return std::move(reading.scene);
}

}  // namespace slosh::reading
