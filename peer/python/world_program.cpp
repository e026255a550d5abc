#include "peer/python/world_program.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

#include "host/auto_spacing.h"
#include "host/keep/rebuild.h"
#include "host/pacer.h"
#include "net/grip_start.h"
#include "net/text/nearest.h"
#include "peer/python/words.h"
#include "sim/backend.h"

namespace slosh::python {
namespace {

thread_local Interrupts* settling = nullptr;  // World::settle asks a plain function

template <class Things>
std::vector<std::string> names_of(const Things& things) {
  std::vector<std::string> names;
  for (const auto& thing : things) names.push_back(thing.name);
  return names;
}

void sleep_until(std::int64_t deadline_ns) {
  const timespec until{deadline_ns / 1'000'000'000, deadline_ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);  // a signal ends it early: no harm
}

}  // namespace

std::size_t index_of(const py::object& name_or_number, const std::vector<std::string>& names,
                     const char* what) {
  if (py::isinstance<py::int_>(name_or_number)) {
    const long number = name_or_number.cast<long>();
    if (number >= 0 && static_cast<std::size_t>(number) < names.size())
      return static_cast<std::size_t>(number);
  } else if (py::isinstance<py::str>(name_or_number)) {
    const auto found = std::find(names.begin(), names.end(), name_or_number.cast<std::string>());
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  }
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  const std::string meant =
      py::isinstance<py::str>(name_or_number) ? did_you_mean(name_or_number.cast<std::string>(), names) : "";
  throw py::key_error("there is no " + std::string(what) + " " +
                      py::repr(name_or_number).cast<std::string>() +
                      (names.empty() ? ": the scene has none" : ". " + meant + "There are: " + known));
}

/// While it lives no other call moves the world; while released() does, no other call reads it.
struct WorldProgram::Moving {
  explicit Moving(WorldProgram& p) : program(p) { p.begin_move(); }
  ~Moving() {
    program.in_call_ = program.moving_ = false;
    program.moments_.outdated();
    program.bodies_known_ = false;
  }
  Moving(const Moving&) = delete;
  Moving& operator=(const Moving&) = delete;
  WorldProgram& program;
};

WorldProgram::WorldProgram(std::shared_ptr<const Scene> scene, const WorldProgramOptions& options)
    : scene_(std::move(scene)) {
  const std::optional<Backend> wanted = backend_named(options.backend);
  if (!wanted)
    throw py::value_error("backend: '" + options.backend + "' is unknown: choose auto, cpu or cuda");
  if (options.threads < 0) throw py::value_error("threads: 0 (all cores) or more");
  std::string reason;
  const bool gpu = *wanted != Backend::kCpu && cuda_available(&reason);
  if (*wanted == Backend::kCuda && !gpu) throw Raised({"backend cuda", reason, "Use cpu or auto"});
  backend_ = gpu ? Backend::kCuda : Backend::kCpu;

  for (std::size_t i = 0; i < scene_->grips.size(); ++i)
    hands_.emplace_back(grip_start(*scene_, i), scene_->grips[i]);
  inputs_.resize(hands_.size());
  if (!options.hands.is_none()) {
    for (const auto& [name, source] : py::dict(options.hands))
      hold(py::reinterpret_borrow<py::object>(name), py::reinterpret_borrow<py::object>(source));
  }

  const double spacing = choose_spacing_of(options);
  Interrupts interrupts;
  const WorldOptions made{options.threads, backend_};
  without_lock(interrupts, [&] {
    sampled_ = take(sample_scene(*scene_, spacing, nullptr, [&](double) { interrupts.check(); }));
    world_ = take(make_world(*scene_, sampled_, make_plan(*scene_, spacing), made));
  });
  if (options.settle) settle(std::nullopt);
  if (start_.empty()) take(world_->save(start_));
  follow_task();
}

double WorldProgram::choose_spacing_of(const WorldProgramOptions& options) {
  if (options.spacing.is_none()) {
    const bool own = scene_->spacing > 0.0;
    spacing_reason_ = own ? "the scene asks for it" : "the scene's coarsest";
    return own ? scene_->spacing : scene_->spacing_max;
  }
  if (py::isinstance<py::str>(options.spacing)) {
    if (options.spacing.cast<std::string>() != "auto")
      throw py::value_error("spacing: metres, \"auto\" or None");
    Interrupts interrupts;
    SpacingOptions measure;
    measure.threads = options.threads;
    measure.backend = backend_;
    measure.tell = [&](const std::string&) { interrupts.check(); };
    const SpacingChoice choice =
        without_lock(interrupts, [&] { return take(measure_spacing(*scene_, measure)); });
    spacing_reason_ = choice.reason;
    return choice.spacing;
  }
  const double metres = options.spacing.cast<double>();
  if (!(metres >= 1e-4 && metres <= 1.0)) throw py::value_error("spacing: 0.0001 to 1 metres; 0.01 is 10 mm");
  spacing_reason_ = "asked for";
  return metres;
}

std::size_t WorldProgram::grip(const py::object& which) const {
  return index_of(which, names_of(scene_->grips), "grip");
}
std::size_t WorldProgram::body(const py::object& which) const {
  return index_of(which, names_of(scene_->bodies), "body");
}
std::size_t WorldProgram::fluid(const py::object& which) const {
  return index_of(which, names_of(scene_->fluids), "fluid");
}

std::uint32_t WorldProgram::thing(const py::object& which) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < thing_count(*scene_); ++i) names.push_back(thing_name(*scene_, i));
  return static_cast<std::uint32_t>(index_of(which, names, "body or fluid volume"));
}

void WorldProgram::hold(const py::object& which, const py::object& source) {
  refuse_while_moving();
  hands_[grip(which)].hold(source);
}

void WorldProgram::refuse_while_moving() const {
  if (moving_) {
    throw Raised({"slosh.World", "it is being stepped by another thread",
                  "Read it when that call is over, or from the functions that the call itself calls"});
  }
}

/// From the world as it is now on; what its steps bring comes between steps, as with a host.
void WorldProgram::follow_task() {
  if (scene_->task.empty()) return;
  task_ =
      std::make_unique<TaskTap>(*scene_, sampled_, [this](const HostCommand& command, const auto& answer) {
        const Result<bool> done = change_world(*world_, command);
        if (done && recording_)
          recording_->after_change(*world_, command,
                                   state_of(*world_, scene_->fluids.size(), false, resets_));
        answer(done);
      });
  task_->on_start(*world_, {});
}

void WorldProgram::begin_move() {
  refuse_while_moving();
  if (in_call_) {
    throw Raised({"slosh.World", "it is being stepped already",
                  "A hand, and on_step, may read the world; only the loop outside steps it"});
  }
  in_call_ = true;
}

/// Between two steps, for a function of the program: the world as it is now.
void WorldProgram::let_read() {
  moments_.outdated();
  bodies_known_ = moving_ = false;
}

std::span<const HandleInput> WorldProgram::inputs() {
  const double time = world_->time();
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (!hands_[i].calls()) {
      inputs_[i] = hands_[i].at(time);
      continue;
    }
    const py::gil_scoped_acquire held;
    let_read();
    inputs_[i] = hands_[i].at(time);
    moving_ = true;
  }
  return inputs_;
}

void WorldProgram::one_step(std::span<const HandleInput> hands) {
  if (recording_) recording_->before_step(*world_, StepInput{hands, {}});
  world_->step(hands);
  if (recording_) recording_->after_step(*world_);
  if (task_) task_->after_step(*world_);
  status_ |= world_->take_status();
  if (status_ & kStatusDeviceLost)
    throw Raised({"the GPU", world_->failure(), "Run again with backend=\"cpu\""});
}

void WorldProgram::step(long steps) {
  if (steps < 1) throw py::value_error("steps: at least 1");
  const Moving moving(*this);
  Interrupts interrupts;
  moving_ = true;
  without_lock(interrupts, [&] {
    for (long i = 0; i < steps; ++i) {
      one_step(inputs());
      interrupts.check();
    }
  });
}

Run WorldProgram::run(double seconds, bool real_time, long every, const py::object& on_step) {
  if (!(seconds > 0.0 && seconds <= 1e6)) throw py::value_error("seconds: above 0, at most a million");
  if (every < 1) throw py::value_error("every: a row each 1 step or more");
  const bool calls = !on_step.is_none();
  const Moving moving(*this);
  RunTable table;
  table.grips = scene_->grips.size();
  table.bodies = scene_->bodies.size();
  status_ = 0;
  Interrupts interrupts;
  moving_ = true;
  without_lock(interrupts, [&] {
    const double dt = world_->plan().time_step;
    const long steps = std::max(1L, std::lround(seconds / dt));
    Pacer pacer(dt);
    pacer.restart(steady_now_ns());
    bool goes_on = true;
    for (long i = 1; i <= steps && goes_on; ++i) {
      one_step(inputs());
      if (i % every == 0 || i == steps) {
        world_->fill(bodies_);
        table.add(bodies_);
      }
      if (calls) {
        const py::gil_scoped_acquire held;
        let_read();
        const py::object answer = on_step();
        goes_on = !(py::isinstance<py::bool_>(answer) && !answer.cast<bool>());
        moving_ = true;
      }
      if (real_time) sleep_until(pacer.next(steady_now_ns()).deadline_ns);
      interrupts.check();
    }
    table.slipped = pacer.slipped_seconds();
  });
  table.status = status_;
  return to_run(std::move(table));
}

void WorldProgram::settle(std::optional<double> seconds) {
  const double length = seconds.value_or(scene_->settle);
  if (!(length >= 0.0 && length <= 60.0)) throw py::value_error("seconds: 0 to 60");
  if (length == 0.0) return;
  refuse_while_recorded("settle");
  const Moving moving(*this);
  Interrupts interrupts;
  moving_ = true;
  without_lock(interrupts, [&] {
    std::vector<HandleInput> hands(inputs().begin(), inputs().end());
    for (HandleInput& hand : hands) hand.twist = Twist{};
    settling = &interrupts;
    world_->settle(length, hands, [] { return settling->pending(); }, seconds ? 0.0 : scene_->settle_longest);
    settling = nullptr;
    interrupts.check();
  });
  if (const Result<bool> saved = (start_.clear(), world_->save(start_)); !saved) throw Raised(saved.error());
}

void WorldProgram::reset() {
  const Moving moving(*this);
  const std::size_t fluids = scene_->fluids.size();
  take(keep::reset_world(*world_, fluids, start_));
  resets_ += 1;
  if (recording_)
    recording_->after_change(*world_, {HostAction::kReset}, state_of(*world_, fluids, false, resets_));
}

void WorldProgram::restore(const std::string& saved) {
  refuse_while_recorded("restore");
  const Moving moving(*this);
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(saved.data()), saved.size());
  take(world_->restore(bytes));
}

std::string WorldProgram::cut(const py::object& name_or_number, const glm::dvec3& normal, double offset) {
  refuse_while_recorded("cut");
  const std::size_t which = body(name_or_number);
  const Moving moving(*this);
  const Result<std::size_t> piece = world_->cut(which, {normal, offset});
  if (!piece) throw Raised(piece.error());
  return scene_->bodies[piece.value()].name;
}

const BodySnapshot& WorldProgram::bodies() {
  const World& now = world();
  if (!bodies_known_) now.fill(bodies_);
  bodies_known_ = true;
  return bodies_;
}

const Measurement& WorldProgram::measure() {
  const World& now = world();
  if (!instruments_) instruments_ = std::make_unique<Instruments>(*scene_, sampled_);
  return instruments_->measure(now);
}

void WorldProgram::change(const HostCommand& command) {
  refuse_while_moving();
  take(change_world(*world_, command));
  moments_.outdated();
  bodies_known_ = false;
  if (recording_)
    recording_->after_change(*world_, command, state_of(*world_, scene_->fluids.size(), false, resets_));
}

void WorldProgram::refuse_while_recorded(const char* what) const {
  if (recording_)
    throw Raised({std::string("slosh.World.") + what, "a recording cannot say that this was done",
                  "Call stop_recording() first"});
}

void WorldProgram::record(const std::filesystem::path& file) {
  refuse_while_moving();
  if (recording_) throw Raised({"slosh.World", "it is being recorded already", "stop_recording() ends that"});
  keep::RecordingOptions options;
  options.file = file;
  options.version = SLOSH_VERSION;
  options.backend = backend_name(backend_);
  recording_ =
      take(keep::RecordingWriter::start(*scene_, sampled_.spacing, start_, *world_,
                                        state_of(*world_, scene_->fluids.size(), false, resets_), options));
}

void WorldProgram::stop_recording() {
  refuse_while_moving();
  if (!recording_) return;
  recording_->on_end(*world_);
  const keep::RecordingReport report = recording_->finish();
  recording_.reset();
  const std::string& problem = report.problem.empty() ? report.totals.ended_early : report.problem;
  if (!problem.empty()) throw Raised({"the recording", problem, ""});
}

}  // namespace slosh::python
