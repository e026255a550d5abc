// A world that a server can serve at any size for next to nothing: bodies that do not move, fluid that sways.
// What is measured is the network's part alone.
#pragma once

#include <atomic>
#include <cmath>
#include <memory>
#include <thread>

#include "host/server/net_loop.h"
#include "host/server/snapshot_coder.h"
#include "net/clock.h"

namespace slosh::bench {

inline Scene small_scene() {
  Scene scene;
  scene.name = "bench";
  scene.fluids.push_back({});
  Body body;
  body.motion = BodyMotion::kFree;
  scene.bodies.push_back(body);
  for (int i = 0; i < 4; ++i) {
    Grip grip;
    grip.name = std::to_string(i);
    grip.body = 0;
    scene.grips.push_back(grip);
  }
  return scene;
}

/// Publishes bodies 540 times and snapshots 60 times a second, as a host's thread does.
class ServedWorldThread {
 public:
  ServedWorldThread(Channel& channel, Mailbox& mailbox, std::size_t particles)
      : channel_(channel), mailbox_(mailbox), particles_(particles) {
    for (int k = 0; k < kPhases; ++k) snapshots_.push_back(snapshot_of(k));
    thread_ = std::thread([this] { run(); });
  }
  ~ServedWorldThread() {
    stop_ = true;
    thread_.join();
    channel_.snapshots().close();
  }

 private:
  static constexpr int kPhases = 240;

  // A tank of particles, 10 mm apart, whose columns rise and fall in waves.
  std::shared_ptr<Snapshot> snapshot_of(int phase) const {
    auto snapshot = std::make_shared<Snapshot>();
    const int side = static_cast<int>(std::ceil(std::cbrt(static_cast<double>(particles_))));
    for (std::size_t i = 0; i < particles_; ++i) {
      const int x = static_cast<int>(i) % side;
      const int y = static_cast<int>(i) / side % side;
      const int z = static_cast<int>(i) / side / side;
      const double angle = 2.0 * M_PI * phase / kPhases;
      const double wave =
          0.015 * std::sin(angle * 3.0 + 0.3 * x) * y / side + 0.0004 * std::sin(7.0 * angle + i);
      snapshot->positions.emplace_back(0.01 * x + 0.5 * wave, 0.01 * y + wave, 0.01 * z);
      snapshot->fluid_index.push_back(0);
      const bool edge = x == 0 || y == 0 || z == 0 || x == side - 1 || y == side - 1 || z == side - 1;
      snapshot->shell.push_back(edge ? 1 : 0);
    }
    return snapshot;
  }

  void run() {
    constexpr double kStep = 1.0 / 540.0;
    std::int64_t due = steady_now_ns();
    for (std::uint64_t tick = 1; !stop_; ++tick) {
      due += to_nanoseconds(kStep);
      sleep_until_ns(due);
      BodyMessage& message = channel_.bodies().back();
      message.bodies.tick = tick;
      message.bodies.time = kStep * static_cast<double>(tick);
      message.bodies.bodies.resize(1);
      message.bodies.grips.resize(4);
      message.rate = 1.0;
      message.stamp_ns = due;
      message.pose_numbers.resize(4);
      for (std::size_t i = 0; i < 4; ++i) {
        channel_.pose(i).update();
        message.pose_numbers[i] = channel_.pose(i).front().number;
      }
      channel_.bodies().publish();
      if (tick % 9 == 0) {
        auto shown = std::make_shared<Snapshot>(*snapshots_[tick / 9 % kPhases]);
        shown->rigid.tick = tick;
        shown->rigid.time = message.bodies.time;
        channel_.snapshots().push(std::move(shown));
      }
      mailbox_.wake();
    }
  }

  Channel& channel_;
  Mailbox& mailbox_;
  std::size_t particles_;
  std::vector<std::shared_ptr<Snapshot>> snapshots_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// A whole host on a free port of loopback.
class BenchHost {
 public:
  explicit BenchHost(std::size_t particles, std::size_t spectators)
      : channel_(scene_.grips.size(), BodyMessage{}, std::size_t{64} << 20) {
    ServedWorld world;
    world.scene = &scene_;
    world.package = wire::Bytes(20'000, 1);
    world.channel = &channel_;
    world.desk = &desk_;
    world.spacing = 0.01;
    world.time_step = 1.0 / 540.0;
    world.particles = particles;
    world.command = [](const HostCommand&, const HostAnswer& answer) {
      if (answer) answer(true);
    };
    ServerOptions options;
    options.hands_to_start = 0;
    options.limits = {8, spectators};
    options.admission.a_site = 10'000;
    server_ = std::make_unique<Server>(std::move(world), options);
    EndpointOptions link;
    link.max_connections = spectators + 64;
    auto listening = listen_quic("127.0.0.1:0", identity_, *server_, link);
    if (!listening) throw std::runtime_error(listening.error().text());
    endpoint_ = std::move(listening.value());
    server_->use(*endpoint_);
    hold = server_->links().create(LinkRole::kHold, {}, 1)->token;
    watch = server_->links().create(LinkRole::kWatch, {}, 1)->token;
    loop_ = std::make_unique<NetLoop>(*server_, *endpoint_);
    snapshots_ = std::make_unique<SnapshotThread>(channel_.snapshots(), desk_, demand_, 0.01, 0,
                                                  [this] { server_->mailbox().wake(); });
    loop_->start();
    world_ = std::make_unique<ServedWorldThread>(channel_, server_->mailbox(), particles);
  }
  ~BenchHost() {
    world_.reset();
    loop_->stop("the bench ends");
    snapshots_.reset();
  }

  NetLoop& loop() { return *loop_; }
  std::string address() const { return endpoint_->local_address(); }
  const KeyFingerprint& key() const { return identity_.fingerprint(); }
  wire::Token hold{};
  wire::Token watch{};

 private:
  Scene scene_ = small_scene();
  Channel channel_;
  SnapshotDemand demand_;
  SnapshotDesk desk_;
  Identity identity_ = Identity::generate();
  std::unique_ptr<Server> server_;
  std::unique_ptr<Endpoint> endpoint_;
  std::unique_ptr<NetLoop> loop_;
  std::unique_ptr<SnapshotThread> snapshots_;
  std::unique_ptr<ServedWorldThread> world_;
};

}  // namespace slosh::bench
