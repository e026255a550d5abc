// What a world is: scenes from files, what is wrong with them, which passes they need.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "net/grip_start.h"
#include "peer/python/bindings.h"
#include "peer/python/hand.h"
#include "peer/python/interrupts.h"
#include "peer/python/words.h"
#include "peer/python/world_program.h"
#include "scenes/inspect.h"
#include "scenes/load.h"
#include "scenes/vary.h"
#include "sim/plan.h"

namespace slosh::python {
namespace {

/// "OBJECT.FIELD" and a number, bool or text.
FieldEdit to_edit(const std::string& where, const py::handle& value) {
  const std::size_t dot = where.rfind('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == where.size())
    throw py::value_error("edits: '" + where + "' is not OBJECT.FIELD, as in 'water.viscosity_pa_s'");
  std::string text =
      py::isinstance<py::bool_>(value) ? (value.cast<bool>() ? "true" : "false")
      : py::isinstance<py::str>(value)
          ? value.cast<std::string>()
          : py::repr(py::float_(py::reinterpret_borrow<py::object>(value))).cast<std::string>();
  return {where.substr(0, dot), where.substr(dot + 1), std::move(text)};
}

std::shared_ptr<Scene> load(const std::filesystem::path& name_or_path, const std::optional<py::dict>& edits) {
  const std::filesystem::path file = take(find_scene(name_or_path.string()));
  std::vector<FieldEdit> list;
  if (edits)
    for (const auto& [where, value] : *edits) list.push_back(to_edit(where.cast<std::string>(), value));
  return on_a_thread_left_behind([file, list] {
    return std::make_shared<Scene>(take(list.empty() ? load_scene(file) : load_scene_with(file, list)));
  });
}

struct PlainFinding {
  bool is_error = false;
  std::string kind;
  Error text;
};

std::vector<PlainFinding> check(const std::filesystem::path& file) {
  const Inspection inspection = on_a_thread_left_behind([file] { return inspect_scene(file); });
  std::vector<PlainFinding> all;
  for (const Finding& each : inspection.errors) all.push_back({true, each.kind, each.text});
  for (const Finding& each : inspection.warnings) all.push_back({false, each.kind, each.text});
  return all;
}

double plan_spacing(const Scene& scene, double spacing) {
  const double chosen = spacing > 0.0 ? spacing : scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  if (!(chosen >= 1e-4 && chosen <= 1.0))
    throw py::value_error("spacing: 0.0001 to 1 metres, 0: the scene's own or coarsest");
  return chosen;
}

std::vector<std::string> pass_names(const std::vector<Pass>& passes) {
  std::vector<std::string> names;
  for (const Pass& pass : passes) names.emplace_back(name(pass.id));
  return names;
}

void bind_parts(py::module_& m) {
  py::class_<Fluid>(m, "Fluid", "A fluid of a scene.")
      .def_readonly("name", &Fluid::name, "the node's name in the file")
      .def_readonly("density", &Fluid::rest_density, "kg/m³ at rest")
      .def_readonly("viscosity", &Fluid::dynamic_viscosity, "Pa·s");
  py::class_<Body>(m, "Body", "A rigid body of a scene, as it starts.")
      .def_readonly("name", &Body::name, "the node's name in the file")
      .def_property_readonly(
          "free", [](const Body& b) { return b.motion == BodyMotion::kFree; },
          "False: it is fixed, or driven by its keys")
      .def_readonly("point_probe", &Body::point_probe, "True: a point that feels fluid and cannot turn")
      .def_property_readonly(
          "pose", [](const Body& b) { return HandPose{b.pose, {}, {}}; }, "Pose of the mesh frame")
      .def_property_readonly(
          "mass", [](const Body& b) { return b.mass.mass; }, "kg; meaningful where free")
      .def_property_readonly(
          "center_of_mass", [](const Body& b) { return from_vector(b.mass.center_of_mass); },
          "(3,) m, mesh frame")
      .def_readonly(
          "viscosity", &Body::dynamic_viscosity,
          "Pa·s of its surface; -1: that of the fluid that touches it, -2: the fluid slides along it")
      .def_readonly("friction", &Body::friction, "coefficient against other bodies, 0 to 10")
      .def_readonly("restitution", &Body::restitution, "share of the speed that a bounce gives back, 0 to 1")
      .def_readonly("measured", &Body::measured, "True: its pose and the fluid's wrench on it are written");
  py::class_<Grip>(m, "Grip", "Where one hand takes hold of one body.")
      .def_readonly("name", &Grip::name, "the node's name in the file")
      .def_readonly("body", &Grip::body, "index into Scene.bodies")
      .def_readonly("stiffness", &Grip::stiffness, "N/m")
      .def_readonly("damping", &Grip::damping, "N·s/m")
      .def_readonly("rotational_stiffness", &Grip::rotational_stiffness, "N·m/rad")
      .def_readonly("rotational_damping", &Grip::rotational_damping, "N·m·s/rad")
      .def_property_readonly(
          "hand",
          [](const Grip& g) {
            return g.hand_motion.empty() ? py::object(py::none()) : py::cast(Keys{g.hand_motion});
          },
          "The scene's own motion of its hand: Keys, or None");
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_parts(m);
  py::class_<Scene, std::shared_ptr<Scene>>(m, "Scene",
                                            "The immutable description of a world. SI units, y up.")
      .def_readonly("name", &Scene::name, "of the file, without its ending")
      .def_readonly("title", &Scene::title, "what the scene says of itself, or empty")
      .def_readonly("source", &Scene::source_file, "where it was read from")
      .def_readonly("fluids", &Scene::fluids, "list[Fluid]")
      .def_readonly("bodies", &Scene::bodies, "list[Body]")
      .def_readonly("grips", &Scene::grips, "list[Grip], in the order of the devices")
      .def_property_readonly(
          "gauges",
          [](const Scene& s) {
            std::vector<std::string> names;
            for (const Gauge& g : s.gauges) names.push_back(g.name);
            return names;
          },
          "names, in the order of Measurement.levels")
      .def_property_readonly(
          "regions",
          [](const Scene& s) {
            std::vector<std::string> names;
            for (const Region& r : s.regions) names.push_back(r.name);
            return names;
          },
          "names, in the order of Measurement.masses")
      .def_property_readonly(
          "gravity", [](const Scene& s) { return from_vector(s.gravity); }, "(3,) m/s²")
      .def_readonly("spacing", &Scene::spacing, "m between particles that it asks for; 0: none in particular")
      .def_readonly("spacing_min", &Scene::spacing_min, "m")
      .def_readonly("spacing_max", &Scene::spacing_max, "m")
      .def_readonly("duration", &Scene::duration, "s of its scripted motion")
      .def_readonly("settle", &Scene::settle, "s of rest before a run")
      .def_property_readonly(
          "model", [](const Scene& s) { return std::string(name(s.model)); },
          "'corrected', 'incompressible' or 'paper'")
      .def_property_readonly(
          "domain",
          [](const Scene& s) { return py::make_tuple(from_vector(s.domain_min), from_vector(s.domain_max)); },
          "its corners, ((3,), (3,)) m: what leaves it over its edge is spilled")
      .def(
          "grip_start",
          [](const std::shared_ptr<Scene>& s, const py::object& which) {
            std::vector<std::string> names;
            for (const Grip& g : s->grips) names.push_back(g.name);
            return HandPose{grip_start(*s, index_of(which, names, "grip")), {}, {}};
          },
          py::arg("grip"), "Pose of a grip (name or number) before anything moves. Raises KeyError.")
      .def(
          "estimate",
          [](const Scene& s, double spacing) {
            if (!(spacing >= 1e-4 && spacing <= 1.0)) throw py::value_error("spacing: 0.0001 to 1 metres");
            const ParticleEstimate e = estimate_particles(s, spacing);
            return py::make_tuple(static_cast<long>(e.fluid), static_cast<long>(e.surface));
          },
          py::arg("spacing"), "(fluid, body) particles at a spacing of so many m, without sampling.")
      .def("__repr__", [](const Scene& s) {
        return "<slosh.Scene '" + s.name + "': " + std::to_string(s.bodies.size()) + " bodies, " +
               std::to_string(s.fluids.size()) + " fluids, " + std::to_string(s.grips.size()) + " grips>";
      });

  m.def("load_scene", &load, py::arg("name_or_path"), py::arg("edits") = py::none(),
        "Reads a shipped scene by its name, or a .gltf or .glb file.\n\n"
        "edits: {'OBJECT.FIELD': value} with the custom properties of scenes/FIELDS.md, made before anything "
        "is\n"
        "checked; OBJECT is a node's name, a kind (body, fluid, grip, hand, probe) or 'scene'.\n"
        "Raises slosh.Error that names file, node and field.\n\n"
        ">>> slosh.load_scene('spoon', {'fluid.viscosity_pa_s': 2.0})");
  m.def(
      "scenes",
      [] {
        std::vector<std::pair<std::string, std::string>> all;
        for (const SceneEntry& entry : shipped_scenes()) all.emplace_back(entry.name, entry.title);
        return all;
      },
      "The shipped scenes: [(name, title)].");

  py::class_<PlainFinding>(m, "Finding", "One thing that check() found.")
      .def_readonly("is_error", &PlainFinding::is_error,
                    "True: the scene does not load; False: it will surprise")
      .def_readonly("kind", &PlainFinding::kind, "stays the same over versions: 'error', 'no-camera', ...")
      .def_property_readonly(
          "where", [](const PlainFinding& f) { return f.text.where; },
          "file, object and field that it is about")
      .def_property_readonly(
          "what", [](const PlainFinding& f) { return f.text.what; }, "what is wrong or will surprise")
      .def_property_readonly(
          "mend", [](const PlainFinding& f) { return f.text.mend; }, "what to do about it")
      .def("__str__", [](const PlainFinding& f) { return f.text.text(); });
  m.def("check", &check, py::arg("file"),
        "Everything that is wrong with a scene file, or not as its maker will have meant it: list[Finding].");

  py::class_<Plan>(
      m, "Plan",
      "Which passes a step has for a scene at one spacing, and why. str() is what slosh plan prints.")
      .def_readonly("spacing", &Plan::spacing, "m")
      .def_readonly("support_radius", &Plan::support_radius, "m")
      .def_readonly("time_step", &Plan::time_step, "s")
      .def_readonly("time_step_reason", &Plan::time_step_reason, "what limits the time step, in words")
      .def_readonly("stiffness", &Plan::stiffness, "m²/s²")
      .def_property_readonly(
          "passes", [](const Plan& p) { return pass_names(p.passes); }, "names of those that run, in order")
      .def_property_readonly(
          "left_out", [](const Plan& p) { return pass_names(p.left_out); },
          "names of those that it does not need")
      .def("__str__", [](const Plan& p) { return describe(p); });
  m.def(
      "make_plan", [](const Scene& s, double spacing) { return make_plan(s, plan_spacing(s, spacing)); },
      py::arg("scene"), py::arg("spacing") = 0.0,
      "The plan on the CPU at `spacing` m; 0: the scene's own, else its coarsest.");
}

}  // namespace slosh::python
