// slosh.join and slosh.Remote
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "net/clock.h"
#include "peer/python/bindings.h"
#include "peer/python/remote_program.h"
#include "peer/python/words.h"
#include "peer/python/world_program.h"
#include "peer/remote/link_source.h"

namespace slosh::python {
namespace {

std::unique_ptr<RemoteProgram> join(const std::string& link, const std::filesystem::path& link_file,
                                    const std::string& name, const std::vector<std::string>& grips,
                                    bool watch, bool particles, const std::filesystem::path& key,
                                    double timeout) {
  if (link.empty() && link_file.empty()) throw py::value_error("link or link_file: one of them");
  const wire::Role role = watch ? wire::Role::kSpectator : wire::Role::kParticipant;
  const std::string text =
      link_file.empty() ? link : take(read_link_text(link, link_file.string(), role, name));
  return std::make_unique<RemoteProgram>(text,
                                         RemoteProgramOptions{name, grips, watch, particles, key, timeout});
}

const char* state_name(LinkState state) {
  switch (state) {
    case LinkState::kConnecting:
      return "connecting";
    case LinkState::kJoining:
      return "joining";
    case LinkState::kLive:
      return "live";
    case LinkState::kReconnecting:
      return "reconnecting";
    case LinkState::kEnded:
      return "ended";
  }
  return "unknown";
}

std::vector<std::string> held(RemoteProgram& r) {
  std::vector<std::string> names;
  const RemoteStatus status = r.status();
  for (std::size_t i = 0; i < status.held.size() && i < r.scene().grips.size(); ++i)
    if (status.held[i]) names.push_back(r.scene().grips[i].name);
  return names;
}

py::list people(RemoteProgram& r) {
  py::list out;
  for (const wire::RosterEntry& each : r.status().peers) {
    py::list grips;
    for (const std::uint32_t g : each.grips)
      if (g < r.scene().grips.size()) grips.append(r.scene().grips[g].name);
    out.append(py::make_tuple(each.name, each.connected, grips));
  }
  return out;
}

py::dict network(RemoteProgram& r) {
  const LinkNumbers n = r.status().numbers;
  py::dict out;
  out["round_trip_s"] = n.round_trip;
  out["clock_error_s"] = n.clock_error;
  out["body_delay_s"] = n.body_delay;
  out["send_loss"] = n.send_loss;
  out["bytes_received"] = n.bytes_received;
  out["bytes_sent"] = n.bytes_sent;
  out["poses"] = n.poses;
  out["reconnects"] = n.reconnects;
  return out;
}

py::object samples(RemoteProgram& r) {
  const std::vector<ServoSample> all = r.samples();
  std::vector<double> time, grip, handles, wrenches;
  for (const ServoSample& s : all) {
    time.push_back(s.time);
    grip.push_back(s.device);
    append(handles, s.handle);
    append(wrenches, s.on_hand);
  }
  const auto rows = static_cast<py::ssize_t>(all.size());
  py::dict out;
  out["time"] = as_array(std::move(time), {rows});
  out["grip"] = as_array(std::move(grip), {rows}).attr("astype")("int");
  out["handles"] = as_array(std::move(handles), {rows, 7});
  out["wrenches"] = as_array(std::move(wrenches), {rows, 6});
  return out;
}

py::object positions(RemoteProgram& r) {
  const SnapshotPointer picture = r.picture();
  const auto rows = picture ? static_cast<py::ssize_t>(picture->positions.size()) : py::ssize_t{0};
  if (rows == 0) return py::array_t<float>(std::vector<py::ssize_t>{0, 3});
  return view(picture, reinterpret_cast<const float*>(picture->positions.data()), {rows, 3});
}

/// Raises at once where the host has said that this link does not let us; what else it refuses is in
/// notices().
void must_be_ours(bool ours, const char* what, const char* mend) {
  if (!ours) throw Raised({"slosh.Remote", what, mend});
}
constexpr char kRunLink[] = "Ask the host for a link with the role run (`slosh links new --role run`)";

void do_world(RemoteProgram& r, wire::WorldAction action) {
  must_be_ours(r.status().rights.run, "this link does not let us run the world for everybody", kRunLink);
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kWorld;
  command.action = action;
  r.ask(command);
}

void set(RemoteProgram& r, wire::Parameter parameter, std::size_t index, double value) {
  const RemoteStatus now = r.status();
  if (parameter == wire::Parameter::kGripStiffness)
    must_be_ours(may_set_stiffness(now, index), "the stiffness of this grip is not ours to set",
                 "take() it first");
  else
    must_be_ours(now.rights.parameters, "this link does not let us set gravity and viscosity", kRunLink);
  RemoteCommand command;
  command.kind = RemoteCommand::Kind::kParameter;
  command.parameter = parameter;
  command.index = static_cast<std::uint32_t>(index);
  command.value = value;
  r.ask(command);
}

std::size_t fluid(const RemoteProgram& r, const py::object& which) {
  std::vector<std::string> names;
  for (const Fluid& f : r.scene().fluids) names.push_back(f.name);
  return index_of(which, names, "fluid");
}

std::size_t body(const RemoteProgram& r, const py::object& which) {
  std::vector<std::string> names;
  for (const Body& b : r.scene().bodies) names.push_back(b.name);
  return index_of(which, names, "body");
}

void bind_asking(py::class_<RemoteProgram>& c) {
  c.def(
       "pause",
       [](RemoteProgram& r, bool paused) {
         do_world(r, paused ? wire::WorldAction::kPause : wire::WorldAction::kContinue);
       },
       py::arg("paused") = true,
       "Asks for the world to stand, or (False) go on, for everybody. Raises slosh.Error where runs_world is "
       "False.")
      .def(
          "reset", [](RemoteProgram& r) { do_world(r, wire::WorldAction::kReset); },
          "Asks for the world to start again, for everybody. Raises as pause() does.")
      .def(
          "set_viscosity",
          [](RemoteProgram& r, const py::object& which, double value) {
            set(r, wire::Parameter::kFluidViscosity, fluid(r, which), value);
          },
          py::arg("fluid"), py::arg("pascal_seconds"),
          "Asks for a fluid's viscosity, >= 0 Pa·s. Raises as pause() does.")
      .def(
          "set_gravity_scale",
          [](RemoteProgram& r, double scale) { set(r, wire::Parameter::kGravityScale, 0, scale); },
          py::arg("scale"), "Asks for gravity, times the scene's, 0 to 2. Raises as pause() does.")
      .def(
          "set_grip_stiffness",
          [](RemoteProgram& r, const py::object& which, double scale) {
            set(r, wire::Parameter::kGripStiffness, r.grip(which), scale);
          },
          py::arg("grip"), py::arg("scale"),
          "Asks for the springs of a grip of ours, times the scene's, 0.05 to 4. Raises slosh.Error for "
          "another's.")
      .def("notices", &RemoteProgram::notices,
           "What a person should read, oldest first, each once: list[str].");
}

void bind_states(py::class_<RemoteProgram>& c) {
  c.def_property_readonly(
       "time", [](RemoteProgram& r) { return r.newest().bodies.time; }, "simulated s of the newest state")
      .def_property_readonly(
          "tick", [](RemoteProgram& r) { return r.newest().bodies.tick; }, "its step")
      .def_property_readonly(
          "rate", [](RemoteProgram& r) { return r.newest().rate; }, "simulated s a s; 0: the world stands")
      .def(
          "body",
          [](RemoteProgram& r, const py::object& which) {
            return r.newest().bodies.bodies.at(body(r, which));
          },
          py::arg("body"), "BodyState of a body (name or number), the newest that came.")
      .def(
          "grip",
          [](RemoteProgram& r, const py::object& which) { return r.newest().bodies.grips.at(r.grip(which)); },
          py::arg("grip"),
          "GripState of a grip (name or number), the newest that came: force and torque are what the host's\n"
          "world puts on whoever holds it.")
      .def_property_readonly(
          "positions", &positions,
          "(N, 3) float32, m: particles a little behind the bodies, for looking at; (0, 3) before the first\n"
          "came, and with particles=False. Read-only, no copy, valid as long as the array is.")
      .def("samples", &samples,
           "What hands of ours felt each 2 ms of simulated time since the call before: dict of 'time' (n,) "
           "s, 'grip' (n,),\n"
           "'handles' (n, 7), 'wrenches' (n, 6). Some 65 s of one hand are kept.");
}

}  // namespace

void bind_remote(py::module_& m) {
  py::class_<RemoteProgram> c(
      m, "Remote",
      "Somebody else's world, joined. Poses go out and states come in on threads of their own; a lost\n"
      "connection is taken up again for five minutes. Use it in a with statement, or leave().");
  c.def_property_readonly(
       "scene", [](const RemoteProgram& r) { return r.shared_scene(); }, "Scene")
      .def_property_readonly("spacing", &RemoteProgram::spacing, "m between the host's particles")
      .def_property_readonly(
          "name", [](RemoteProgram& r) { return r.status().welcome.name; }, "how the others see us")
      .def_property_readonly(
          "state", [](RemoteProgram& r) { return state_name(r.status().state); },
          "'live', 'reconnecting' or 'ended'. Raises slosh.Error where it ended by a fault.")
      .def_property_readonly("held", &held, "names of the grips that are ours: list[str]")
      .def_property_readonly(
          "runs_world", [](RemoteProgram& r) { return r.status().rights.run; },
          "whether our link lets us pause, reset and set gravity and viscosity for everybody")
      .def_property_readonly("people", &people, "who is here: [(name, connected, [grips])]")
      .def_property_readonly("network", &network, "dict of round trip, losses, delays and bytes")
      .def("hold", &RemoteProgram::hold, py::arg("grip"), py::arg("source"),
           "Where our hand on a grip of ours goes: a pose (Pose, 3 or 7 numbers, (position, quaternion)), "
           "smoothly, at most\n"
           "1.2 m/s and 4.5 rad/s; Keys, by the host's simulated time; None: the scene's own motion.")
      .def(
          "handle",
          [](RemoteProgram& r, const py::object& which) { return HandPose{r.handle(r.grip(which)), {}, {}}; },
          py::arg("grip"), "Pose where that hand is now.")
      .def(
          "take", [](RemoteProgram& r, const py::object& which) { r.take(which, true); }, py::arg("grip"),
          "Takes one more grip. Raises slosh.Error where it is not given within 5 s.")
      .def(
          "let_go", [](RemoteProgram& r, const py::object& which) { r.take(which, false); }, py::arg("grip"),
          "Lets go of a grip of ours.")
      .def("wait", &RemoteProgram::wait, py::arg("seconds"),
           "Lets so many s pass. Raises slosh.Error where the host ends meanwhile.")
      .def("leave", &RemoteProgram::leave, "Says good-bye. May be called again.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](RemoteProgram& r, const py::args&) { r.leave(); });
  bind_states(c);
  bind_asking(c);
  m.def("join", &join, py::arg("link") = "", py::kw_only(), py::arg("link_file") = "", py::arg("name") = "",
        py::arg("grips") = std::vector<std::string>{}, py::arg("watch") = false, py::arg("particles") = true,
        py::arg("key") = "", py::arg("timeout") = 10.0,
        "Joins a host by what it printed (slosh://...) and returns a Remote once the world is there, and a "
        "grip held\n"
        "where one is free.\n\n"
        "link_file: a file that holds the link, or what slosh host --links wrote, in place of link: for "
        "programs,\n"
        "whose arguments everybody on a machine can read. name: how the others see us ('': the host "
        "chooses). grips: names of those to take (none: the first "
        "free one).\n"
        "watch: only look on. particles: False leaves them out of what is sent. key: a file with our key, "
        "made there on\n"
        "first use, by which we are the same person the next time. timeout: s. Raises slosh.Error.");
}

}  // namespace slosh::python
