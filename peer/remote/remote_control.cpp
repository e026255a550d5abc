// What a peer and its host say to each other on streams: RemoteLink's second half.
#include <algorithm>

#include "net/clock.h"
#include "net/wire/roster_change.h"
#include "net/wire/scene_package.h"
#include "peer/remote/remote_link.h"

namespace slosh {
namespace {

constexpr double kFirstStateWithin = 1.0;  // s that a world without a moving body is waited for
constexpr std::size_t kMaxNotices = 64;    // that nobody has read

/// What to do about a refusal.
std::string mend_of(wire::RefusalCode code) {
  switch (code) {
    case wire::RefusalCode::kBadToken:
    case wire::RefusalCode::kRevoked:
    case wire::RefusalCode::kExpired:
      return "Ask the host for a new link";
    case wire::RefusalCode::kFull:
      return "Try again later, or watch";
    case wire::RefusalCode::kVersion:
      return "Use the same version of slosh as the host";
    case wire::RefusalCode::kReplaced:
      return "One key is one person: use another --key for a second one";
    case wire::RefusalCode::kBadMessage:
    case wire::RefusalCode::kTooMuch:
      return "Report it: a peer should never do that";
    case wire::RefusalCode::kEnding:
    case wire::RefusalCode::kTimedOut:
    case wire::RefusalCode::kBanned:
    case wire::RefusalCode::kBusy:
      break;
  }
  return {};
}

}  // namespace

void RemoteLink::say_hello() {
  control_ = endpoint_->open_stream(connection_, true);
  if (control_ < 0) {
    endpoint_->close(connection_, 0, "no stream");
    return;
  }
  wire::Hello hello;
  hello.token = options_.token;
  hello.name = options_.name;
  if (!options_.fluid_models) hello.capabilities &= ~wire::kFluidWrenches;
  hello.snapshots = !options_.snapshots.wanted ? wire::SnapshotWish::kNone
                    : options_.snapshots.film  ? wire::SnapshotWish::kFilm
                                               : wire::SnapshotWish::kNewest;
  say(hello);
}

wire::Fault RemoteLink::receive(std::uint64_t type, wire::ByteView payload) {
  if (step_ == LinkStep::kEnded) return {};
  switch (static_cast<wire::ControlType>(type)) {
    case wire::ControlType::kWelcome:
      return on_welcome(payload);
    case wire::ControlType::kRefused:
      return on_refused(payload);
    case wire::ControlType::kRoster:
      return on_roster(payload);
    case wire::ControlType::kRosterChange:
      return on_roster_change(payload);
    case wire::ControlType::kAnswer:
      return on_answer(payload);
    case wire::ControlType::kWorldInfo:
      return on_world_info(payload);
    case wire::ControlType::kRights:
      return on_rights(payload);
    case wire::ControlType::kTask:
      return on_task(payload);
    case wire::ControlType::kCuts:
      return on_cuts(payload);
    case wire::ControlType::kNotice:
      return on_notice(payload);
    case wire::ControlType::kBye: {
      wire::Bye bye;
      const wire::Fault fault = wire::decode(payload, bye);
      if (!fault) end(std::nullopt, bye.reason);
      return fault;
    }
    default:
      return {"type", std::to_string(type) + " is no message of a host"};
  }
}

wire::Fault RemoteLink::on_welcome(wire::ByteView payload) {
  wire::Welcome welcome;
  if (wire::Fault fault = wire::decode(payload, welcome)) return fault;
  if (greeting_.welcome) return {"welcome", "came twice"};
  if (world_stage_ != WorldStage::kNone && welcome.world != status_.welcome.world) {
    end(Error{options_.address, "the host has begun another world since contact was lost",
              "Join again with the same link, or ask for a new one"});
    return {};
  }
  greeting_.welcome = true;
  status_.welcome = welcome;
  agreed_ = welcome.capabilities & wire::kOurCapabilities;
  const bool all = !(agreed_ & wire::kLinkRights) && welcome.role == wire::Role::kParticipant;
  status_.rights = {all, all, all};
  if (inbox_) inbox_->set_stands_until_felt((agreed_ & wire::kFeltHands) != 0);
  publish(now());
  return {};
}

wire::Fault RemoteLink::on_refused(wire::ByteView payload) {
  wire::Refused message;
  if (wire::Fault fault = wire::decode(payload, message)) return fault;
  refused(message.code, message.text);
  return {};
}

void RemoteLink::refused(wire::RefusalCode code, const std::string& words) {
  // What follows is the end of the connection, and we come back: contact was bad, or too many came at once.
  if (code == wire::RefusalCode::kBusy) return;
  if (code == wire::RefusalCode::kTimedOut && status_.live_ns != 0) return;
  if (code == wire::RefusalCode::kEnding && status_.live_ns != 0) {
    end(std::nullopt, words);
  } else {
    end(Error{options_.address, "the host says: " + (words.empty() ? std::string("no") : words),
              mend_of(code)},
        words);
  }
}

wire::Fault RemoteLink::on_roster(wire::ByteView payload) {
  wire::Roster roster;
  if (wire::Fault fault = wire::decode(payload, roster)) return fault;
  status_.peers = std::move(roster.peers);
  greeting_.roster = true;
  note_held();
  publish(now());
  return {};
}

wire::Fault RemoteLink::on_roster_change(wire::ByteView payload) {
  wire::RosterChange change;
  if (wire::Fault fault = wire::decode(payload, change)) return fault;
  if (!greeting_.roster) return {"roster change", "came before the roster"};
  wire::apply(change, status_.peers);
  note_held();
  publish(now());
  return {};
}

/// Which grips are ours, by the roster.
void RemoteLink::note_held() {
  std::fill(status_.held.begin(), status_.held.end(), false);
  if (!greeting_.welcome) return;
  for (const wire::RosterEntry& entry : status_.peers) {
    if (entry.peer != status_.welcome.peer) continue;
    for (const std::uint32_t grip : entry.grips) {
      if (grip < status_.held.size()) status_.held[grip] = true;
    }
  }
}

wire::Fault RemoteLink::on_answer(wire::ByteView payload) {
  wire::Answer answer;
  if (wire::Fault fault = wire::decode(payload, answer)) return fault;
  const auto found = std::find_if(requests_.begin(), requests_.end(),
                                  [&](const Request& r) { return r.number == answer.request; });
  if (found == requests_.end()) return {};
  const Request request = *found;
  requests_.erase(found);
  if (answer.granted) {
    if (!request.done.empty()) notice(request.done);
    return {};
  }
  const std::string why = answer.text.empty() ? "the host refused" : answer.text;
  if (!request.any || !take_a_free_grip(true)) notice(why);
  return {};
}

wire::Fault RemoteLink::on_world_info(wire::ByteView payload) {
  wire::WorldInfo info;
  if (wire::Fault fault = wire::decode(payload, info, agreed_)) return fault;
  status_.world = info;
  if (inbox_) inbox_->set_paused(info.paused);
  publish(now());
  return {};
}

wire::Fault RemoteLink::on_rights(wire::ByteView payload) {
  wire::Rights rights;
  if (wire::Fault fault = wire::decode(payload, rights)) return fault;
  status_.rights = rights;
  publish(now());
  return {};
}

wire::Fault RemoteLink::on_cuts(wire::ByteView payload) {
  wire::Cuts cuts;
  if (wire::Fault fault = wire::decode(payload, cuts)) return fault;
  if (inbox_)
    inbox_->take(cuts);
  else
    cuts_ = std::move(cuts);
  return {};
}

wire::Fault RemoteLink::on_task(wire::ByteView payload) {
  wire::Task task;
  if (wire::Fault fault = wire::decode(payload, task, agreed_)) return fault;
  status_.task = {task.title, task.say, task.now, task.hint, task.hands, task.done};
  publish(now());
  return {};
}

wire::Fault RemoteLink::on_notice(wire::ByteView payload) {
  wire::Notice said;
  if (wire::Fault fault = wire::decode(payload, said)) return fault;
  notice(said.text);
  return {};
}

void RemoteLink::take_scene(std::span<const std::uint8_t> bytes, bool end_of_stream) {
  if (world_stage_ != WorldStage::kNone) return;  // the same world again: a peer that came back has it
  if (scene_bytes_.size() + bytes.size() > wire::kMaxSceneBytes) {
    return bad_host({"scene", "is larger than allowed"}, "the scene");
  }
  scene_bytes_.insert(scene_bytes_.end(), bytes.begin(), bytes.end());
  if (!end_of_stream) return;
  Result<UnpackedScene> unpacked = unpack_scene(scene_bytes_);
  scene_bytes_ = {};
  if (!unpacked) return bad_host({unpacked.error().where, unpacked.error().what}, "the scene");
  world_.scene = std::move(unpacked.value().scene);
  world_.spacing = unpacked.value().spacing;
  world_stage_ = WorldStage::kScene;
}

/// Once the scene and the welcome are there: what the rest of the peer works with.
void RemoteLink::build_world() {
  const double time_step = status_.welcome.time_step;
  inbox_ = std::make_unique<BodyInbox>(world_.scene, time_step);
  inbox_->set_paused(status_.world.paused);
  if (cuts_) inbox_->take(*cuts_);
  inbox_->set_stands_until_felt((agreed_ & wire::kFeltHands) != 0);
  world_.channel =
      std::make_unique<Channel>(world_.scene.grips.size(), inbox_->state(), options_.snapshot_bytes);
  SnapshotMakerOptions snapshots = options_.snapshots;
  snapshots.has_fluid = status_.welcome.particles > 0 && snapshots.wanted;
  world_.maker = std::make_unique<SnapshotMaker>(snapshots, world_.channel->snapshots());
  world_.maker->note_clock(clock_);
  uplink_ = std::make_unique<PoseUplink>(*world_.channel);
  status_.held.assign(world_.scene.grips.size(), false);
  note_held();
  world_stage_ = WorldStage::kBuilt;
}

void RemoteLink::go_live_if_ready(std::int64_t now_ns) {
  if (!greeting_.welcome || !greeting_.roster || world_stage_ == WorldStage::kNone) return;
  if (world_stage_ == WorldStage::kScene) build_world();
  if (!greeting_.grips_asked) ask_for_grips();
  const bool waited = to_seconds(now_ns - step_ns_) > kFirstStateWithin;
  if (!clock_.known() || (!inbox_->started() && !waited)) return;
  if (step_ == LinkStep::kRejoining) {
    status_.numbers.reconnects += 1;
    notice("back with the host after " +
           std::to_string(static_cast<int>(to_seconds(now_ns - status_.lost_ns) + 0.5)) + " s");
  }
  if (!advance(LinkEvent::kReady)) return;
  if (status_.live_ns == 0) status_.live_ns = now_ns;
  pose_due_ns_ = now_ns;
  publish(now_ns);
}

void RemoteLink::bad_host(const wire::Fault& fault, const std::string& what) {
  if (endpoint_ && connection_ != 0) endpoint_->close(connection_, 1, "not understood: " + fault.text());
  end(Error{options_.address, what + " of the host's is not understood (" + fault.text() + ")",
            "Use the same version of slosh as the host"});
}

void RemoteLink::notice(const std::string& text) {
  {
    const std::lock_guard lock(shared_.mutex);
    if (shared_.notices.size() < kMaxNotices) shared_.notices.push_back(text);
  }
  shared_.changed.notify_all();
}

}  // namespace slosh
