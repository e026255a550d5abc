#include "host/app/hosted_run.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "host/app/host_links.h"
#include "host/app/host_supervisor.h"
#include "host/server/console.h"
#include "net/fresh_file.h"
#include "net/link.h"
#include "net/text/name.h"
#include "net/wire/scene_package.h"
#include "peer/app/state_folder.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr std::size_t kHostedBytes = std::size_t{256} << 20;
constexpr std::uint16_t kPort = 4433;
constexpr std::size_t kSpareHands = 4;   // participants beyond one a grip
constexpr std::size_t kStrangers = 128;  // connections that nobody was let in by

/// What `listen` gives at `asked`, else everywhere at the usual port; its errors with a host's mend.
template <class Listen>
auto at_the_place(const std::string& asked, Listen&& listen) {
  const std::string port = format(":%d", kPort);
  auto listening = listen(asked.empty() ? "[::]" + port : asked);
  // A machine without IPv6, or a port in use: the second answer tells which.
  if (!listening && asked.empty()) listening = listen("0.0.0.0" + port);
  if (listening) return listening;
  Error error = listening.error();
  error.mend = "Choose another port with --listen, e.g. --listen '[::]:0' for any that is free";
  return decltype(listening)(error);
}

}  // namespace

Result<bool> can_host_there(const HostVerbOptions& options) {
  if (!options.addresses.empty()) {
    if (const Result<std::string> link = format_link({options.addresses, {}, {}}); !link) return link.error();
  }
  if (options.listen.empty() && !options.resume.empty()) return true;
  return at_the_place(options.listen, can_listen);
}

Result<std::unique_ptr<HostedRun>> HostedRun::create(HostedWorld& hosted, const HostVerbOptions& options,
                                                     SupervisorControl* supervision) {
  std::unique_ptr<HostedRun> run(new HostedRun(hosted, options));
  HostedRun& s = *run;
  const Scene& scene = hosted.prepared.scene;
  if (hosted.server_state) {
    Result<Identity> kept = Identity::from_private_key(hosted.server_state->private_key);
    if (!kept) return kept.error();
    s.identity_ = std::move(kept.value());
  }
  s.channel_ = std::make_unique<Channel>(scene.grips.size(), initial_message(*hosted.world, hosted.state.run),
                                         kHostedBytes);
  if (!scene.task.empty())
    s.task_tap_ = std::make_unique<TaskTap>(
        scene, hosted.prepared.sampled,
        [&s](const HostCommand& command, HostAnswer answer) { s.host_->post(command, std::move(answer)); });
  if (s.task_tap_) s.task_tap_->carry_on(hosted.state.task_done);
  const Result<bool> network = s.open_network(supervision);
  if (!network) return network.error();
  s.make_links();
  HostOptions host;
  host.snapshot_rate = kTierSnapshotRate;
  host.demand = &s.demand_;
  host.fluid_demand = &s.fluid_demand_;
  host.until = hosted.prepared.seconds;
  host.shell = true;
  host.paused = hosted.state.paused;
  host.run = hosted.state.run;
  host.start_state = hosted.start;
  if (supervision != nullptr) host.pulse = &supervision->pulse();
  s.host_ = std::make_unique<Host>(std::move(*hosted.world), scene, *s.channel_, host);
  s.host_->add_tap(*s.server_);
  if (s.task_tap_) s.host_->add_tap(*s.task_tap_);
  if (const Result<bool> files = s.open_files(); !files) return files.error();
  return run;
}

Result<bool> HostedRun::open_network(SupervisorControl* supervision) {
  const Prepared& p = hosted_.prepared;
  ServedWorld world;
  world.scene = &p.scene;
  Result<wire::Bytes> package = pack_scene(p.scene, p.sampled.spacing, SceneParts::kSeen);
  if (!package) return package.error();
  world.package = std::move(package.value());
  world.channel = channel_.get();
  world.desk = &desk_;
  world.fluid_demand = &fluid_demand_;
  world.command = [this](const HostCommand& command, HostAnswer answer) {
    host_->post(command, std::move(answer));
  };
  if (task_tap_) world.task = [this] { return task_tap_->lines(); };
  world.state = hosted_.state;
  world.particles = hosted_.particles;
  world.spacing = p.sampled.spacing;
  world.time_step = p.plan.time_step;
  const std::size_t package_bytes = world.package.size();

  ServerOptions server;
  server.limits.participants = p.scene.grips.size() + kSpareHands;
  server.limits.spectators = options_.watchers;
  server.lock_parameters = options_.lock_parameters;
  server.hands_to_start = hosted_.waits ? static_cast<std::size_t>(options_.wait) : 0;
  server.tell = [this](const std::string& line) {
    const std::lock_guard lock(news_mutex_);
    news_.push_back(line);
  };
  server_ = std::make_unique<Server>(std::move(world), server);

  EndpointOptions link;
  link.max_strangers = kStrangers;
  link.max_connections = server.limits.participants + server.limits.spectators + kStrangers;
  link.stream_buffer = package_bytes + (2u << 20);
  // A key frame takes about 1.4 bytes a particle; two of them must find room.
  link.queue_datagrams[static_cast<std::size_t>(Priority::kSnapshot)] =
      std::max<std::size_t>(512, hosted_.particles / 300);
  const std::string asked = options_.listen.empty() ? hosted_.place.listen : options_.listen;
  Result<std::unique_ptr<Endpoint>> listening = at_the_place(
      asked, [&](const std::string& address) { return listen_quic(address, identity_, *server_, link); });
  if (!listening) {
    Error error = listening.error();
    if (options_.listen.empty() && !asked.empty())
      error.mend = "It listened there before, and its links say so. Choose another place with --listen";
    return error;
  }
  endpoint_ = std::move(listening.value());
  address_ = endpoint_->local_address();
  place_ = {address_, options_.addresses.empty() ? hosted_.place.addresses : options_.addresses};
  reachable_ = place_.addresses.empty() ? reachable_addresses(address_) : place_.addresses;
  if (const Result<std::string> text = format_link({reachable_, identity_.fingerprint(), {}}); !text) {
    return Error{"--address", text.error().what,
                 "Give addresses that peers can reach, e.g. 203.0.113.7:4433"};
  }
  server_->use(*endpoint_);
  server_->set_identity(identity_.private_key(), port_of(address_));
  server_->link_text = [this](const LinkRecord& link_record) { return text_of(link_record); };
  Result<std::unique_ptr<ConsoleDoor>> door = ConsoleDoor::open(port_of(address_));
  if (!door) return door.error();
  door_ = std::move(door.value());
  net_ = std::make_unique<NetLoop>(*server_, *endpoint_,
                                   supervision != nullptr ? &supervision->network_pulse() : nullptr);
  return true;
}

std::string HostedRun::text_of(const LinkRecord& link) const {
  const Result<std::string> text = format_link({reachable_, identity_.fingerprint(), link.token});
  return text ? text.value() : text.error().text();
}

void HostedRun::make_links() {
  if (hosted_.server_state) {
    server_->restore(*hosted_.server_state);
  } else {
    const std::int64_t now = server_->unix_now();
    std::int64_t lifetime = 0;
    if (!options_.expires.empty()) {
      const Result<std::int64_t> parsed = parse_duration(options_.expires);
      if (parsed) lifetime = parsed.value();
    }
    LinkRegistry& links = server_->links();
    for (const std::string& name : options_.runners)
      links.create(LinkRole::kRun, clean_name(name), now, lifetime);
    for (const std::string& name : options_.names)
      links.create(LinkRole::kHold, clean_name(name), now, lifetime);
    links.create(LinkRole::kHold, {}, now, lifetime);
    links.create(LinkRole::kWatch, {}, now, lifetime);
  }
  first_links_ = server_->links().links();
}

std::string HostedRun::choose_checkpoint() const {
  if (options_.checkpoint == "none") return {};
  if (!options_.checkpoint.empty()) return options_.checkpoint;
  if (!options_.resume.empty()) return options_.resume;
  if (state_folder().empty()) return {};
  // Two hosts of one scene must not write over each other.
  const std::uint16_t port = port_of(address_);
  const std::string name = hosted_.prepared.scene.name + (port == kPort ? "" : "-" + std::to_string(port));
  make_own_folder(state_folder());
  return state_folder() + "/" + name + ".checkpoint";
}

Result<bool> HostedRun::open_files() {
  const Prepared& p = hosted_.prepared;
  checkpoint_file_ = choose_checkpoint();
  if (!checkpoint_file_.empty()) {
    std::error_code code;
    const bool goes_on =
        !options_.resume.empty() && (checkpoint_file_ == options_.resume ||
                                     std::filesystem::equivalent(checkpoint_file_, options_.resume, code));
    if (!goes_on) {
      Result<std::filesystem::path> aside = keep::set_checkpoint_aside(checkpoint_file_);
      if (!aside) return aside.error();
      set_aside_ = aside.value().string();
    }
    keep::CheckpointOptions options;
    options.file = checkpoint_file_;
    options.version = SLOSH_VERSION;
    options.place = place_;
    options.interval = options_.checkpoint_seconds;
    if (task_tap_) options.task_done = [tap = task_tap_.get()] { return tap->took(); };
    options.run = server_->world_number();
    // The first file already has everything that a newcomer needs: this may be all that there ever is.
    server_->save_state();
    options.server_state = saved_state_ = server_->state_blob();
    auto writer = keep::CheckpointWriter::start(p.scene, p.sampled.spacing, hosted_.start, host_->world(),
                                                hosted_.state, options);
    if (!writer) return writer.error();
    checkpoint_ = std::move(writer.value());
    host_->add_tap(*checkpoint_);
  }
  Result<std::unique_ptr<WorldFiles>> files = WorldFiles::create(p, p.sampled, false);
  if (!files) return files.error();
  files_ = std::move(files.value());
  return files_->follow(*host_, options_.record, p.backend);
}

HostedRun::~HostedRun() {
  stop("the host ends");
}

void HostedRun::start() {
  snapshots_ = std::make_unique<SnapshotThread>(channel_->snapshots(), desk_, demand_,
                                                hosted_.prepared.sampled.spacing, hosted_.state.run,
                                                [this] { server_->mailbox().wake(); });
  net_->start();
  host_->start();
}

void HostedRun::stop(const std::string& why) {
  if (stopped_) return;
  stopped_ = true;
  if (net_) net_->stop(why);
  if (host_) {
    host_->request_stop();
    host_->wait();
  }
  if (channel_) channel_->snapshots().close();  // also when the host never started
  if (snapshots_) coding_seconds_ = snapshots_->seconds();
  snapshots_.reset();
  save_server_state();
  if (checkpoint_) checkpoint_->flush();
  if (!files_) return;
  files_->finish_recording();
  files_->stop();
}

std::vector<std::string> HostedRun::news() {
  const std::lock_guard lock(news_mutex_);
  return std::exchange(news_, {});
}

std::string HostedRun::trouble() const {
  std::string all;
  const auto say = [&all](const char* what, const std::string& why) {
    if (!why.empty()) all += (all.empty() ? "" : "; ") + (what + why);
  };
  if (files_->recording()) say("the recording has ended: ", files_->recording()->trouble());
  if (checkpoint_) say("the world is not saved: ", checkpoint_->report().problem);
  if (files_->measurer()) say("the instruments are not written: ", files_->measurer()->problem());
  if (files_->exporter()) say("", files_->exporter()->problem());
  return all;
}

void HostedRun::save_server_state() {
  if (!checkpoint_) return;
  wire::Bytes blob = server_->state_blob();
  if (blob.empty() || blob == saved_state_) return;
  saved_state_ = blob;
  checkpoint_->set_server_state(std::move(blob));
}

}  // namespace slosh
