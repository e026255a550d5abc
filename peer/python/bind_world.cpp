// slosh.World
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "peer/python/bindings.h"
#include "peer/python/words.h"
#include "peer/python/world_program.h"

namespace slosh::python {
namespace {

py::ssize_t count(const WorldProgram& w) {
  return static_cast<py::ssize_t>(w.world().fluid_count());
}

std::unique_ptr<WorldProgram> make(const std::shared_ptr<Scene>& scene, const py::object& spacing,
                                   const std::string& backend, int threads, const py::object& hands,
                                   bool settle) {
  WorldProgramOptions options;
  options.spacing = spacing;
  options.backend = backend;
  options.threads = threads;
  options.hands = hands;
  options.settle = settle;
  return std::make_unique<WorldProgram>(scene, options);
}

py::array_t<double> wrenches(WorldProgram& w) {
  std::vector<double> out;
  for (const GripState& grip : w.bodies().grips) append(out, grip.on_hand);
  return as_array(std::move(out), {static_cast<py::ssize_t>(w.scene().grips.size()), 6});
}

py::object task(const WorldProgram& w) {
  (void)w.world();  // not while it moves
  if (!w.task()) return py::none();
  const TaskLines lines = w.task()->lines();
  const std::vector<TaskState::Done> done = w.task()->done();
  py::list steps;
  for (std::size_t i = 0; i < w.scene().task.size(); ++i) {
    py::dict step;
    step["say"] = w.scene().task[i].say;
    step["until"] = in_words(w.scene().task[i].until, w.scene());
    step["done"] = i < done.size();
    if (i < done.size()) {
      step["took_s"] = done[i].took;
      step["late"] = done[i].late;
      step["measured"] = done[i].measured;
    }
    steps.append(step);
  }
  py::dict all;
  all["title"] = lines.title;
  all["say"] = lines.say;
  all["now"] = lines.now;
  all["hint"] = lines.hint;
  all["steps"] = steps;
  return all;
}

py::bytes save(const WorldProgram& w) {
  std::vector<std::uint8_t> out;
  take(w.world().save(out));
  return py::bytes(reinterpret_cast<const char*>(out.data()), out.size());
}

void bind_particles(py::class_<WorldProgram>& c) {
  c.def_property_readonly(
       "positions",
       [](WorldProgram& w) {
         const auto& moment = w.snapshot();
         return view(moment, reinterpret_cast<const float*>(moment->snapshot.positions.data()),
                     {count(w), 3});
       },
       "(N, 3) float32, m: the fluid's particles, in an order that is fixed for the run. Read-only, without "
       "a copy of\n"
       "what the library hands out: the array stays as it is, and valid, also when the world moves on or is "
       "gone.\n"
       "What has left the world (fluid_index 255) stands anywhere.")
      .def_property_readonly(
          "velocities",
          [](WorldProgram& w) {
            const auto& moment = w.velocities();
            return view(moment, reinterpret_cast<const float*>(moment->velocities.data()), {count(w), 3});
          },
          "(N, 3) float32, m/s, half a step behind the positions (leap-frog); nan for what has left. As "
          "positions.")
      .def_property_readonly(
          "pressures",
          [](WorldProgram& w) {
            const auto& moment = w.pressures();
            return view(moment, moment->pressures.data(), {count(w)});
          },
          "(N,) float32, Pa, by the density of the last step (0 before one); nan for what has left. As "
          "positions.")
      .def_property_readonly(
          "fluid_index",
          [](WorldProgram& w) {
            const auto& moment = w.snapshot();
            return view(moment, moment->snapshot.fluid_index.data(), {count(w)});
          },
          "(N,) uint8: index into Scene.fluids; 255 for what has left the world. As positions.");
}

void bind_bodies(py::class_<WorldProgram>& c) {
  c.def(
       "body", [](WorldProgram& w, const py::object& which) { return w.bodies().bodies.at(w.body(which)); },
       py::arg("body"), "BodyState of a body (name or number) now. Raises KeyError that lists the names.")
      .def(
          "grip", [](WorldProgram& w, const py::object& which) { return w.bodies().grips.at(w.grip(which)); },
          py::arg("grip"), "GripState of a grip (name or number) now. Raises KeyError that lists the names.")
      .def_property_readonly(
          "wrenches", &wrenches,
          "(G, 6): force N and torque N·m on each hand, about its handle, world axes, mean over the last\n"
          "step; a held weight is negative in y. What acts on the body is the opposite.")
      .def(
          "measure", [](WorldProgram& w) { return w.measure(); },
          "Measurement: sums over the fluid, gauges, regions, particles inside solids. About 2 ms for 100 "
          "000 particles.");
}

void bind_changes(py::class_<WorldProgram>& c) {
  c.def(
       "viscosity",
       [](const WorldProgram& w, const py::object& which) { return w.world().viscosity(w.fluid(which)); },
       py::arg("fluid"), "Pa·s of a fluid (name or number) now.")
      .def(
          "set_viscosity",
          [](WorldProgram& w, const py::object& which, double value) {
            w.change({HostAction::kViscosity, static_cast<std::uint32_t>(w.fluid(which)), value});
          },
          py::arg("fluid"), py::arg("pascal_seconds"),
          "From the next step on, >= 0 Pa·s. Raises slosh.Error with the largest value where the time step "
          "would not\n"
          "be stable with it.")
      .def_property(
          "gravity_scale", [](const WorldProgram& w) { return w.world().gravity_scale(); },
          [](WorldProgram& w, double scale) { w.change({HostAction::kGravityScale, 0, scale}); },
          "Times the scene's gravity, 0 to 2; from the next step on.")
      .def(
          "grip_stiffness",
          [](const WorldProgram& w, const py::object& which) {
            return w.world().grip_stiffness()[w.grip(which)];
          },
          py::arg("grip"), "Springs of a grip's coupling (name or number), times the scene's.")
      .def(
          "set_grip_stiffness",
          [](WorldProgram& w, const py::object& which, double scale) {
            w.change({HostAction::kGripStiffness, static_cast<std::uint32_t>(w.grip(which)), scale});
          },
          py::arg("grip"), py::arg("scale"),
          "Times the scene's springs, 0.05 to 4; gone over to from the next step on, in 0.3 s from 1 to 4. "
          "The dampers stay.")
      .def(
          "appear",
          [](WorldProgram& w, const py::object& which) { w.change({HostAction::kAppear, w.thing(which)}); },
          py::arg("name"),
          "Brings a body that is away to where the scene has it, or fills a fluid volume (its node's name), "
          "as "
          "far as\n"
          "bodies and fluid leave it free. Raises slosh.Error where there is no room.")
      .def(
          "take_away",
          [](WorldProgram& w, const py::object& which) { w.change({HostAction::kTakeAway, w.thing(which)}); },
          py::arg("name"), "Takes a body, or the particles of a fluid volume, out of the world.")
      .def(
          "cut",
          [](WorldProgram& w, const py::object& which, const py::object& normal, double offset) {
            return w.cut(which, to_vector(normal, "normal"), offset);
          },
          py::arg("body"), py::arg("normal"), py::arg("offset"),
          "Cuts a body (`pieces` in its scene) along the plane normal . x = offset, m, of its mesh frame. "
          "Returns the\n"
          "name of the body that comes off. Raises slosh.Error where it cannot be cut there.")
      .def_property_readonly(
          "task", &task,
          "Where the scene's guided task is, followed as the world is stepped (scenes/TASKS.md): title, say, "
          "now,\n"
          "hint, and steps with say, until, done and, once done, took_s, late, measured. None without one.")
      .def("reset", &WorldProgram::reset,
           "Puts the world back to where it began, at time 0: as it was made, or as settle() left it last. "
           "Hands, and\n"
           "viscosities, gravity and stiffness that were changed, stay. A recording goes on through it.")
      .def("save", &save,
           "bytes from which a world of the same scene and spacing goes on, on the CPU bitwise.")
      .def(
          "restore", [](WorldProgram& w, const py::bytes& saved) { w.restore(saved); }, py::arg("saved"),
          "Takes over what save() gave. Raises slosh.Error, with the world as it was, where it does not fit.")
      .def("record", &WorldProgram::record, py::arg("file"),
           "Writes every step's hands to a new file from now on, for slosh.replay and `slosh replay`. Raises "
           "slosh.Error\n"
           "where the file has something in it.")
      .def("stop_recording", &WorldProgram::stop_recording,
           "Ends the recording and waits until it is on the disk. Does nothing where none is under way.");
}

}  // namespace

void bind_world(py::module_& m) {
  py::class_<WorldProgram> c(
      m, "World",
      "A scene that moves, with a hand for each of its grips.\n\n"
      "scene: Scene. spacing: m between particles; None: the scene's own, else its coarsest; 'auto': the "
      "finest that\n"
      "this machine keeps real time with (measured: seconds). backend: 'auto', 'cpu', 'cuda'. threads: of "
      "the CPU, 0: all\n"
      "cores. hands: {grip: what hold() takes}; grips that are not in it follow the scene's script. settle: "
      "rest first\n"
      "where the scene asks for it. The same inputs give a bitwise identical state whatever the threads.\n\n"
      "One thread at a time: step, run and settle let other Python threads go on meanwhile, and those that "
      "touch this\n"
      "world then get slosh.Error. Functions that run calls may read the world and change parameters.\n"
      "Ctrl-C ends them with KeyboardInterrupt after the step that is under way; the world is sound then.");
  c.def(py::init(&make), py::arg("scene"), py::arg("spacing") = py::none(), py::kw_only(),
        py::arg("backend") = "auto", py::arg("threads") = 0, py::arg("hands") = py::none(),
        py::arg("settle") = true)
      .def("hold", &WorldProgram::hold, py::arg("grip"), py::arg("source"),
           "Who holds a grip (name or number) from the next step on. source: 'script', the scene's own "
           "motion (or standing\n"
           "where the grip starts); a pose (Pose, 3 or 7 numbers, (position, quaternion)), standing there; "
           "Keys, by the\n"
           "world's time; a function time (s) -> pose or None, called before each step; None lets go. The "
           "coupling acts at\n"
           "once and in full: 0.1 m away pulls with 0.1 m times the grip's stiffness.")
      .def("step", &WorldProgram::step, py::arg("steps") = 1, "So many steps of `time_step` s.")
      .def(
          "run", &WorldProgram::run, py::arg("seconds"), py::kw_only(), py::arg("real_time") = false,
          py::arg("every") = 1, py::arg("on_step") = py::none(),
          "Steps for `seconds` of simulated time and returns a Run, a row each `every` steps.\n\n"
          "real_time: no faster than the clock (slower where the machine is; Run.slipped says by how much).\n"
          "on_step: a function without arguments, called after each step; returning False ends the run.")
      .def("settle", &WorldProgram::settle, py::arg("seconds") = py::none(),
           "Lets the world come to rest in its hands, damped, for so many s (None: as the scene asks), with "
           "the clock\n"
           "standing. 0 to 60.")
      .def_property_readonly(
          "scene", [](const WorldProgram& w) { return std::const_pointer_cast<Scene>(w.shared_scene()); },
          "Scene")
      .def_property_readonly(
          "plan", [](const WorldProgram& w) { return w.world().plan(); }, "Plan")
      .def_property_readonly(
          "time", [](const WorldProgram& w) { return w.world().time(); }, "simulated s")
      .def_property_readonly(
          "tick", [](const WorldProgram& w) { return w.world().tick(); }, "steps since the start")
      .def_property_readonly(
          "time_step", [](const WorldProgram& w) { return w.world().plan().time_step; }, "s")
      .def_property_readonly(
          "spacing", [](const WorldProgram& w) { return w.sampled().spacing; }, "m between particles")
      .def_property_readonly(
          "spacing_reason", [](const WorldProgram& w) { return w.spacing_reason(); }, "why that, in words")
      .def_property_readonly("particles", &count, "fluid particles at the start")
      .def_property_readonly(
          "body_particles", [](const WorldProgram& w) { return w.world().boundary_count(); },
          "particles of bodies")
      .def_property_readonly(
          "backend", [](const WorldProgram& w) { return w.world().backend(); },
          "where the particles live, in words")
      .def_property_readonly(
          "hash", [](const WorldProgram& w) { return w.world().hash(); },
          "64 bits of positions, velocities and bodies: the same run again has the same");
  bind_particles(c);
  bind_bodies(c);
  bind_changes(c);
}

}  // namespace slosh::python
