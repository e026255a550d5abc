#include "tests/hostile/honest_peer.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "net/clock.h"
#include "net/wire/all_messages.h"

namespace slosh::hostile {
namespace {

constexpr std::int64_t kPoseEvery = 4'000'000;  // ns
constexpr const char* kName = "Honest";

}  // namespace

/// One connection of its.
class HonestPeer::Line final : public EndpointEvents {
 public:
  Line(const JoinLink& link, const Identity& identity) : token_(link.token) {
    auto made = connect_quic(link.addresses, link.host, identity, *this);
    if (made)
      end = std::move(made.value());
    else
      ended = made.error().text();
  }

  void turn() {
    const std::int64_t now = steady_now_ns();
    end->run_once(std::max(now, std::min(pose_due_, now + kPoseEvery)));
    if (!in || !ended.empty() || steady_now_ns() < pose_due_) return;
    pose_due_ = steady_now_ns() + kPoseEvery;
    if (peer_paused) {
      // Others may pause the world; this one goes on.
      peer_paused = false;
      wire::WorldRequest go_on;
      go_on.request = ++request_;
      go_on.action = wire::WorldAction::kContinue;
      say(go_on);
    }
    if (!holds && steady_now_ns() > ask_due_) {
      ask_due_ = steady_now_ns() + to_nanoseconds(0.5);
      wire::GripRequest request;
      request.request = ++request_;
      say(request);
    }
    wire::PoseSample sample;
    sample.number = ++poses_sent;
    sample.stamp_ns = steady_now_ns();
    sample.time = time_;
    sample.pose = handle_;
    sample.engaged = wire::HoldsOn::kYes;
    wire::Poses poses;
    poses.samples.push_back(sample);
    end->send_datagram(connection_, Priority::kPose,
                       std::make_shared<const wire::Bytes>(wire::datagram(poses, nullptr, 0)));
    if (poses_sent % 25 == 0) {
      wire::SnapshotFeedback feedback;
      end->send_datagram(connection_, Priority::kPose,
                         std::make_shared<const wire::Bytes>(wire::datagram(feedback)));
    }
  }
  void farewell() {
    if (!ended.empty() || connection_ == 0) return;
    say(wire::Bye{"done"});
    end->close(connection_, 0, "done");
    for (int i = 0; i < 20; ++i) end->run_once(steady_now_ns() + 10'000'000);
  }

  void on_connected(ConnectionId id, const KeyFingerprint&, const std::string&) override {
    connection_ = id;
    wire::Hello hello;
    hello.capabilities = 0;  // it reads whole rosters
    hello.token = token_;
    hello.name = kName;
    say(hello);
  }
  void on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes, bool) override {
    if (stream != control_) return;
    const wire::Fault found = splitter_.feed(bytes, [&](std::uint64_t type, wire::ByteView payload) {
      return wire::dispatch(wire::HostControl{}, type, payload, [&]<class M>(const M& m) { receive(m); }, 0);
    });
    if (found) fault = "the host's control stream: " + found.text();
  }
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override {
    if (bytes.empty() || bytes[0] != static_cast<std::uint8_t>(wire::DatagramType::kBodies)) return;
    wire::Bodies m;
    if (const wire::Fault found = wire::decode(bytes.subspan(1), m, 0)) {
      fault = "a state that does not decode: " + found.text();
      return;
    }
    states += 1;
    state_ns = steady_now_ns();
    poses_used = std::max(poses_used, m.pose_number);
    time_ = m.time;
    for (const wire::GripEntry& grip : m.grips) {
      if (grip.grip == 0 && poses_used == 0) handle_ = grip.handle;  // where it is taken hold of
    }
  }
  void on_closed(ConnectionId, const CloseReason& why) override {
    ended = why.text.empty() ? "closed without a word" : why.text;
    by_host = why.by_peer;
  }

  std::unique_ptr<Endpoint> end;
  std::string ended;
  bool by_host = false;
  std::string fault;
  bool in = false;
  bool holds = false;
  bool peer_paused = false;
  std::uint64_t states = 0;
  std::uint64_t poses_sent = 0;
  std::uint64_t poses_used = 0;
  std::int64_t state_ns = 0;

 private:
  template <class M>
  void say(const M& message) {
    if (control_ < 0) control_ = end->open_stream(connection_, true);
    if (control_ >= 0) end->send_stream(connection_, control_, wire::control(message), false);
  }
  void note(const std::vector<wire::RosterEntry>& entries) {
    for (const wire::RosterEntry& each : entries) {
      if (each.peer == me_) holds = std::find(each.grips.begin(), each.grips.end(), 0u) != each.grips.end();
    }
  }
  template <class M>
  void receive(const M& m) {
    if constexpr (std::is_same_v<M, wire::Welcome>) {
      in = true;
      me_ = m.peer;
      state_ns = steady_now_ns();
    } else if constexpr (std::is_same_v<M, wire::Roster>) {
      holds = false;
      note(m.peers);
    } else if constexpr (requires {
                           m.changed;
                           m.gone;
                         }) {  // what is new in the roster
      note(m.changed);
    } else if constexpr (std::is_same_v<M, wire::WorldInfo>) {
      peer_paused = m.paused;
    } else if constexpr (std::is_same_v<M, wire::Refused>) {
      // Who comes back may find the door busy, and tries again; who is in is not turned out.
      if (in) fault = "refused: " + m.text;
    }
  }

  wire::Token token_{};
  ConnectionId connection_ = 0;
  std::int64_t control_ = -1;
  wire::StreamSplitter splitter_;
  std::uint32_t me_ = 0;
  std::uint32_t request_ = 0;
  std::int64_t pose_due_ = 0;
  std::int64_t ask_due_ = 0;
  double time_ = 0.0;
  Pose handle_;
};

HonestPeer::HonestPeer(const JoinLink& link) : link_(link), thread_([this] { run(); }) {}

HonestPeer::~HonestPeer() {
  leave();
}

void HonestPeer::leave() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

HonestFigures HonestPeer::figures() const {
  const std::lock_guard lock(mutex_);
  return figures_;
}

void HonestPeer::run() {
  HonestFigures sums;  // of connections that are gone
  std::unique_ptr<Line> line = std::make_unique<Line>(link_, identity_);
  std::int64_t lost_ns = 0;
  std::string fault;
  while (!stop_) {
    if (line->ended.empty()) line->turn();
    const std::int64_t now = steady_now_ns();
    if (line->in && lost_ns != 0) {
      sums.longest_away = std::max(sums.longest_away, to_seconds(now - lost_ns));
      sums.came_back += 1;
      lost_ns = 0;
    }
    if (!line->fault.empty() && fault.empty()) fault = line->fault;
    if (!line->ended.empty()) {
      // A machine that stood still for longer than the timeout is no fault of the host's.
      if (fault.empty() && line->in && line->by_host && line->ended.find("timed out") == std::string::npos)
        fault = "closed by the host: " + line->ended;
      if (lost_ns == 0) lost_ns = now;
      sums.states += line->states;
      sums.poses_sent += line->poses_sent;
      if (!line->in) std::this_thread::sleep_for(std::chrono::milliseconds(200));
      line = std::make_unique<Line>(link_, identity_);
    }
    const std::lock_guard lock(mutex_);
    figures_.in = line->in;
    figures_.holds = line->holds;
    figures_.states = sums.states + line->states;
    figures_.poses_sent = sums.poses_sent + line->poses_sent;
    figures_.poses_used = line->poses_used;
    figures_.gap = line->in ? to_seconds(now - line->state_ns) : 0.0;
    figures_.longest_gap = std::max(figures_.longest_gap, figures_.gap);
    figures_.away = lost_ns == 0 ? 0.0 : to_seconds(now - lost_ns);
    figures_.longest_away = std::max(sums.longest_away, figures_.away);
    figures_.came_back = sums.came_back;
    figures_.fault = fault;
  }
  if (line->ended.empty()) line->farewell();
}

}  // namespace slosh::hostile
