// Recordings: what is in them, and the same world run again from them.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "host/keep/recording.h"
#include "host/keep/replay.h"
#include "peer/python/bindings.h"
#include "peer/python/interrupts.h"
#include "peer/python/run_table.h"
#include "peer/python/words.h"
#include "sim/backend.h"

namespace slosh::python {
namespace {

const char* name_of(HostAction action) {
  switch (action) {
    case HostAction::kPause:
      return "pause";
    case HostAction::kContinue:
      return "continue";
    case HostAction::kReset:
      return "reset";
    case HostAction::kViscosity:
      return "viscosity";
    case HostAction::kGravityScale:
      return "gravity_scale";
    case HostAction::kGripStiffness:
      return "grip_stiffness";
    case HostAction::kAppear:
      return "appear";
    case HostAction::kTakeAway:
      return "take_away";
  }
  return "unknown";
}

/// slosh.Recording: everything that a file says, without simulating anything.
struct RecordingTable {
  std::shared_ptr<Scene> scene;
  double spacing = 0.0;
  double time_step = 0.0;
  std::string version;
  std::string backend;
  bool complete = false;
  py::object time, hands, engaged, body_time, bodies, body_index, hashes, changes;
};

struct Columns {
  std::vector<double> time, hands, engaged, body_time, bodies, body_index;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> hashes;
  struct Change {
    double time;
    const char* what;
    std::uint32_t index;
    double value;
  };
  std::vector<Change> changes;
  std::size_t moving = 0;  // bodies a state
};

void add(const keep::RecordingEvent& event, double time_step, Columns& c) {
  const double time = static_cast<double>(event.tick) * time_step;
  switch (event.kind) {
    case keep::RecordingEvent::Kind::kStep:
      c.time.push_back(time);
      for (const HandleInput& hand : event.hands) {
        append(c.hands, hand.pose);
        c.engaged.push_back(hand.engaged ? 1.0 : 0.0);
      }
      break;
    case keep::RecordingEvent::Kind::kBodies:
      c.body_time.push_back(time);
      c.moving = event.bodies.size();
      c.body_index.clear();
      for (const keep::BodyRecord& body : event.bodies) {
        append(c.bodies, body.pose);
        append(c.bodies, body.twist);
        c.body_index.push_back(body.body);
      }
      break;
    case keep::RecordingEvent::Kind::kHash:
      c.hashes.emplace_back(event.tick, event.hash);
      break;
    case keep::RecordingEvent::Kind::kChange:
      c.changes.push_back({time, name_of(event.change.action), event.change.index, event.change.value});
      break;
    case keep::RecordingEvent::Kind::kState:
    case keep::RecordingEvent::Kind::kEnd:
      break;
  }
}

RecordingTable open(const std::filesystem::path& file) {
  Interrupts interrupts;
  Columns c;
  RecordingTable table;
  without_lock(interrupts, [&] {
    const std::unique_ptr<keep::RecordingReader> reader = take(keep::RecordingReader::open(file));
    const keep::RecordingHead& head = reader->head();
    table.scene = std::make_shared<Scene>(head.scene);
    table.spacing = head.spacing;
    table.time_step = head.time_step;
    table.version = head.version;
    table.backend = head.backend;
    while (const keep::RecordingEvent* event = take(reader->next())) {
      add(*event, head.time_step, c);
      interrupts.check();
    }
    table.complete = reader->complete();
  });
  const auto steps = static_cast<py::ssize_t>(c.time.size());
  const auto grips = static_cast<py::ssize_t>(table.scene->grips.size());
  const auto states = static_cast<py::ssize_t>(c.body_time.size());
  const auto moving = static_cast<py::ssize_t>(c.moving);
  table.time = as_array(std::move(c.time), {steps});
  table.hands = as_array(std::move(c.hands), {steps, grips, 7});
  table.engaged = as_array(std::move(c.engaged), {steps, grips}).attr("astype")("bool");
  table.body_time = as_array(std::move(c.body_time), {states});
  table.bodies = as_array(std::move(c.bodies), {states, moving, 13});
  table.body_index = as_array(std::move(c.body_index), {moving}).attr("astype")("int");
  table.hashes = py::cast(c.hashes);
  py::list changes;
  for (const Columns::Change& each : c.changes)
    changes.append(py::make_tuple(each.time, each.what, each.index, each.value));
  table.changes = changes;
  return table;
}

/// slosh.Replay: the run, and whether it came out the same.
struct ReplayTable {
  std::shared_ptr<Scene> scene;
  Run run;
  bool same = false;
  std::string verdict;
};

ReplayTable replay(const std::filesystem::path& file, const std::string& backend, int threads, long every) {
  const std::optional<Backend> wanted = backend_named(backend);
  if (!wanted) throw py::value_error("backend: '" + backend + "' is unknown: choose auto, cpu or cuda");
  if (threads < 0) throw py::value_error("threads: 0 (all cores) or more");
  if (every < 1) throw py::value_error("every: a row each 1 step or more");
  Interrupts interrupts;
  RunTable rows;
  ReplayTable table;
  without_lock(interrupts, [&] {
    const std::unique_ptr<keep::Replayer> replayer = take(keep::Replayer::open(file, {threads, *wanted}));
    const Scene& scene = replayer->head().scene;
    table.scene = std::make_shared<Scene>(scene);
    rows.grips = scene.grips.size();
    rows.bodies = scene.bodies.size();
    BodySnapshot now;
    for (long i = 1; take(replayer->step()); ++i) {
      if (i % every == 0) {
        replayer->world().fill(now);
        now.time = replayer->elapsed();
        rows.add(now);
      }
      interrupts.check();
    }
    rows.status = replayer->status();
    table.same = replayer->verdict().same(replayer->head().spacing);
    table.verdict = replayer->verdict().text(replayer->head().spacing);
  });
  table.run = to_run(std::move(rows));
  return table;
}

}  // namespace

void bind_recording(py::module_& m) {
  py::class_<RecordingTable>(
      m, "Recording",
      "What a recording (`slosh play --record`, `slosh host --record`, World.record) holds: n steps, G\n"
      "grips, m states of F free bodies. Nothing is simulated. Raises slosh.Error where it is damaged.")
      .def(py::init(&open), py::arg("file"))
      .def_readonly("scene", &RecordingTable::scene, "Scene")
      .def_readonly("spacing", &RecordingTable::spacing, "m")
      .def_readonly("time_step", &RecordingTable::time_step, "s")
      .def_readonly("version", &RecordingTable::version, "of the program that wrote it")
      .def_readonly("backend", &RecordingTable::backend, "'cpu' or 'cuda'")
      .def_readonly("complete", &RecordingTable::complete, "False: cut off, readable up to there")
      .def_readonly("time", &RecordingTable::time,
                    "(n,) simulated s at the end of each step; begins anew with a reset")
      .def_readonly("hands", &RecordingTable::hands, "(n, G, 7): x, y, z m, w, x, y, z; what each step used")
      .def_readonly("engaged", &RecordingTable::engaged, "(n, G) bool: the hand held on")
      .def_readonly("body_time", &RecordingTable::body_time, "(m,) s")
      .def_readonly(
          "bodies", &RecordingTable::bodies,
          "(m, F, 13): pose of the mesh frame (7), velocity m/s of the centre of mass (3), angular rad/s (3)")
      .def_readonly("body_index", &RecordingTable::body_index, "(F,) int: which of Scene.bodies they are")
      .def_readonly("hashes", &RecordingTable::hashes, "[(tick, hash of the world)]")
      .def_readonly("changes", &RecordingTable::changes,
                    "[(time s, 'pause', 'continue', 'reset', 'viscosity', 'gravity_scale', 'grip_stiffness', "
                    "'appear' or 'take_away', fluid, grip or thing (bodies, then fluid volumes), value)]");
  py::class_<ReplayTable>(m, "Replay", "A recording run again.")
      .def_readonly("scene", &ReplayTable::scene, "Scene")
      .def_readonly("run", &ReplayTable::run, "Run; its time goes on over resets")
      .def_readonly("same", &ReplayTable::same,
                    "the hashes agree; on another backend: bodies stayed within a spacing and 0.1 rad")
      .def_readonly("verdict", &ReplayTable::verdict, "the same in words");
  m.def("replay", &replay, py::arg("file"), py::kw_only(), py::arg("backend") = "auto",
        py::arg("threads") = 0, py::arg("every") = 1,
        "Simulates a recording again, with a row each `every` steps, and says whether it came out the same. "
        "Raises\n"
        "slosh.Error where it is damaged or does not fit this machine.");
}

}  // namespace slosh::python
