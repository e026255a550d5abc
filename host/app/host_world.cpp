#include "host/app/host_world.h"

#include <algorithm>
#include <limits>

#include "host/keep/rebuild.h"
#include "host/keep/secrets.h"
#include "net/grip_start.h"
#include "peer/app/settle_world.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

Result<HostedWorld> start_anew(const HostVerbOptions& options, Progress& progress) {
  HostedWorld hosted;
  Result<Prepared> prepared = prepare(options, false, progress);
  if (!prepared) return prepared.error();
  hosted.prepared = std::move(prepared.value());
  const Prepared& p = hosted.prepared;
  progress.phase(p.scene.settle > 0.0 ? "settling" : "starting");
  Result<World> made = make_world(p.scene, p.sampled, p.plan, p.world_options());
  if (!made) return made.error();
  hosted.world = std::move(made.value());
  // The host itself holds every grip where it starts until somebody takes it.
  std::vector<HandleInput> hands;
  for (std::size_t i = 0; i < p.scene.grips.size(); ++i)
    hands.push_back({grip_start(p.scene, i), Twist{}, true, 1.0});
  const Result<bool> settled =
      settle_world(*hosted.world, p, hands, std::numeric_limits<double>::infinity(), progress);
  if (!settled) return settled.error();
  const Result<bool> saved = hosted.world->save(hosted.start);
  if (!saved) return saved.error();
  hosted.waits = options.wait > 0 && !p.scene.grips.empty();
  hosted.state = state_of(*hosted.world, p.scene.fluids.size(), hosted.waits, 0);
  return hosted;
}

/// The server's state that belongs to a checkpoint; none, with a note, where it was not brought along.
Result<std::optional<ServerState>> read_server_state(const std::string& file, const keep::Checkpoint& kept,
                                                     Progress& progress) {
  Result<std::optional<keep::Secrets>> read = keep::read_secrets(file);
  if (!read) return read.error();
  const std::string name = keep::secrets_of(file).string();
  if (!read.value()) {
    progress.note(
        "slosh: " + name +
        " is not there: the world carries on with a new key and new links, and nobody's seat is kept");
    return std::optional<ServerState>{};
  }
  const keep::Secrets& secrets = *read.value();
  if (!secrets.note.empty()) progress.note("slosh: " + secrets.note);
  const Error other{name, "these are the secrets of another host than " + file + " is of",
                    "Bring the ones that belong to it, or move these away to carry on with new links"};
  if (secrets.run != kept.run) return other;
  ServerState state;
  if (const wire::Fault fault = wire::decode(secrets.server_state, state)) {
    return Error{name, "cannot be read by this version of slosh: " + fault.text(),
                 "Resume with the version that wrote it, or move it away to carry on with new links"};
  }
  return std::optional<ServerState>(std::move(state));
}

Result<HostedWorld> carry_on(const HostVerbOptions& options, Progress& progress) {
  HostedWorld hosted;
  progress.phase("reading", options.resume);
  Result<keep::Checkpoint> read = keep::read_checkpoint(options.resume);
  if (!read) return read.error();
  keep::Checkpoint& kept = read.value();
  if (!kept.note.empty()) progress.note("slosh: " + kept.note);
  Result<std::optional<ServerState>> state = read_server_state(options.resume, kept, progress);
  if (!state) return state.error();
  hosted.server_state = std::move(state.value());
  hosted.place = std::move(kept.place);

  Prepared& p = hosted.prepared;
  const Result<Backend> backend = choose_backend(options.backend, options.gpu);
  if (!backend) return backend.error();
  p.backend = backend.value();
  p.gpu = options.gpu;
  p.machine = this_machine();
  p.threads = options.threads > 0 ? options.threads : std::max(1, p.machine.cores - 1);
  p.seconds = options.seconds > 0.0 ? options.seconds : std::numeric_limits<double>::infinity();
  p.scene = std::move(kept.scene);
  if (!options.out.empty()) {
    // What an earlier host measured stays: this one's tables begin where it carries on.
    Result<RunFolder> folder = RunFolder::take_free(options.out);
    if (!folder) return folder.error();
    p.claim = folder.value();
    p.folder = p.claim.path();
    set_measure(options, p);
    if (const Result<bool> exports = set_exports(options, p); !exports) return exports.error();
  }
  progress.phase("sampling");
  Result<SampledScene> sampled = sample_told(p.scene, kept.spacing, progress);
  if (!sampled) return sampled.error();
  Result<keep::RebuiltWorld> rebuilt =
      keep::rebuild_world(p.scene, std::move(sampled.value()), kept.world, p.world_options());
  if (!rebuilt) return rebuilt.error();
  p.sampled = std::move(rebuilt.value().sampled);
  p.plan = rebuilt.value().world.plan();
  hosted.world = std::move(rebuilt.value().world);
  hosted.state = state_of(*hosted.world, p.scene.fluids.size(), kept.state.paused, kept.state.run);
  hosted.state.task_done = std::move(kept.state.task_done);
  progress.note(format("carries on at %.3f s", kept.time));
  hosted.waits = kept.state.paused && kept.tick == 0 && kept.state.run == 0 && options.wait > 0;
  hosted.start = std::move(kept.start);
  return hosted;
}

}  // namespace

Result<HostedWorld> make_hosted_world(const HostVerbOptions& options, Progress& progress) {
  Result<HostedWorld> hosted =
      options.resume.empty() ? start_anew(options, progress) : carry_on(options, progress);
  if (!hosted) return hosted;
  HostedWorld& h = hosted.value();
  h.particles = h.prepared.sampled.fluid_positions.size();
  return hosted;
}

}  // namespace slosh
