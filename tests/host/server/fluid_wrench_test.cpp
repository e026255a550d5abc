// Whose fluid wrenches are asked for, who is sent them, and whether they tell what the host has next.
#include <gtest/gtest.h>

#include <cmath>

#include "host/host.h"
#include "net/grip_start.h"
#include "tests/host/server/server_kit.h"
#include "tests/physics/fluid_wrench_kit.h"

namespace slosh {
namespace {

/// Of each body that a grip of served_scene() is on.
std::vector<FluidWrenchModel> models_of(std::uint64_t tick) {
  std::vector<FluidWrenchModel> models(2);
  for (std::uint32_t body = 0; body < 2; ++body) {
    models[body].body = body;
    models[body].tick = tick;
    models[body].wrench.force.x = 10.0 + body;
  }
  return models;
}

class FluidWrenchServer : public ServerTest {
 protected:
  void publish(std::uint64_t tick) {
    publish_bodies(tick);
    go(0.01);
    BodyMessage& message = channel.bodies().back();
    message = channel.bodies().front();
    message.bodies.tick = tick + 1;
    message.fluid_models = models_of(tick + 1);
    channel.bodies().publish();
    go(0.01);
  }
};

TEST_F(FluidWrenchServer, GoToWhoHoldsTheBodyAndUnderstandsThem) {
  ScriptedPeer& ana = join(1, "Ana");
  ScriptedPeer& ben = join(2, "Ben");
  EXPECT_EQ(fluid_demand.wanted(), 0u) << "nobody holds anything";
  ScriptedPeer& old = arrive(3, "Old", wire::kRosterChanges);
  go(0.1);
  ana.take(0);
  old.take(1);
  go(0.05);
  publish(10);
  EXPECT_EQ(fluid_demand.wanted(), 1u) << "Ana's left, and not the right of who would not understand";
  ASSERT_EQ(ana.fluid.size(), 1u);
  EXPECT_EQ(ana.fluid[0].body, 0u);
  EXPECT_EQ(ana.fluid[0].tick, 11u);
  EXPECT_EQ(ana.fluid[0].wrench.force.x, 10.0);
  EXPECT_TRUE(ben.fluid.empty());
  EXPECT_TRUE(old.fluid.empty());
  EXPECT_GT(old.bodies.size(), 0u) << "who has no models has states all the same";
  EXPECT_EQ(server->figures().fluid_models_sent, 1u);

  ben.take(2);
  go(0.05);
  publish(20);
  EXPECT_EQ(fluid_demand.wanted(), 0b101u);
  ASSERT_EQ(ben.fluid.size(), 1u);
  EXPECT_EQ(ben.fluid[0].wrench.force.x, 11.0);

  ana.release(0);
  ben.vanish();
  go(0.05);
  publish(30);
  EXPECT_EQ(ana.fluid.size(), 2u) << "one of the time when it held the body";
  EXPECT_EQ(fluid_demand.wanted() & 1u, 0u);
}

// The whole chain: a peer's hand stirs 2 Pa·s at the host, and its models come back by the wire.
class StirredHost : public HostTap {
 public:
  StirredHost(const Scene& scene, const SampledScene& sampled)
      : scene_(scene), channel_(scene.grips.size(), BodyMessage{}, 1 << 20) {
    World world(scene, sampled, make_plan(scene, sampled.spacing), {1, Backend::kCpu});
    step_ = world.plan().time_step;
    world.settle(0.3);
    channel_.bodies().back() = initial_message(world);
    channel_.bodies().publish();
    ServerOptions options = running();
    options.bodies.participant = 1e6;
    options.clock = [this] { return network_.now_ns(); };
    ServedWorld served;
    served.scene = &scene;
    served.package = wire::Bytes(100, 7);
    served.channel = &channel_;
    served.desk = &desk_;
    served.fluid_demand = &demand_;
    served.spacing = sampled.spacing;
    served.time_step = step_;
    server_ = std::make_unique<Server>(std::move(served), options);
    endpoint_ = network_.listen(*server_);
    server_->use(*endpoint_);
    const LinkRecord* link = server_->links().create(LinkRole::kHold, {}, 1);
    peer_ = std::make_unique<ScriptedPeer>(network_, 1);
    peer_->hello(link->token, "Ana");
    turn(0.1);
    peer_->take(0);
    turn(0.1);
    HostOptions host;
    host.paced = false;
    host.snapshot_rate = 0.0;
    host.until = 1.2;
    host.fluid_demand = &demand_;
    host_ = std::make_unique<Host>(std::move(world), scene, channel_, host);
    host_->add_tap(*this);
  }
  void run() {
    host_->start();
    host_->wait();
  }
  void before_step(const World& world, const StepInput&) override { stir(world.time()); }
  void after_publish() override { turn(step_); }
  const ScriptedPeer& peer() const { return *peer_; }
  const HostReport& report() const { return host_->report(); }

 private:
  void turn(double seconds) {
    for (double t = 0.0; t < seconds; t += 0.005) {
      network_.advance(std::min(0.005, seconds));
      peer_->end->run_once(0);
      endpoint_->run_once(0);
      server_->turn();
      peer_->end->run_once(0);
    }
  }
  void stir(double t) {
    wire::PoseSample sample;
    sample.number = ++number_;
    sample.stamp_ns = network_.now_ns();
    sample.time = t;
    sample.pose = grip_start(scene_, 0);
    const double turn = 2.0 * M_PI * 1.3;
    const double e = std::min(1.0, t / 0.3);
    sample.pose.position.x += 0.02 * e * std::sin(turn * t);
    sample.twist.linear.x = 0.02 * e * turn * std::cos(turn * t);
    sample.engaged = wire::HoldsOn::kYes;
    peer_->datagram(wire::Poses{{sample}});
  }

  const Scene& scene_;
  MemoryNetwork network_;
  Channel channel_;
  SnapshotDesk desk_;
  FluidDemand demand_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<Endpoint> endpoint_;
  std::unique_ptr<ScriptedPeer> peer_;
  std::unique_ptr<Host> host_;
  double step_ = 0.0;
  std::uint64_t number_ = 0;
};

TEST(FluidWrenchOverTheWire, TellsWhatTheHostHasInItsNextState) {
  const Scene scene = lab::spoon_in(2.0);
  const auto sampled = sample_scene(scene, 0.010);
  ASSERT_TRUE(sampled) << sampled.error().text();
  StirredHost host(scene, sampled.value());
  host.run();
  const ScriptedPeer& peer = host.peer();
  EXPECT_EQ(peer.fault, "");
  EXPECT_GT(host.report().fluid_models, 300u);
  ASSERT_GT(peer.fluid.size(), 300u);

  const auto spoon_in = [](const wire::Bodies& state) {
    for (const wire::BodyEntry& entry : state.bodies) {
      if (entry.body == 1) return entry;
    }
    return wire::BodyEntry{};
  };
  double off = 0.0, held = 0.0, square = 0.0, mean = 0.0, count = 0.0;
  std::size_t at = 1;
  for (const wire::FluidWrench& message : peer.fluid) {
    const FluidWrenchModel model = wire::to_model(message);
    if (model.time < 0.4) continue;
    // Three states on: some 6 ms.
    while (at + 1 < peer.bodies.size() && peer.bodies[at].tick < model.tick + 3) ++at;
    const wire::Bodies& next = peer.bodies[at];
    if (next.tick != model.tick + 3 || peer.bodies[at - 1].tick != model.tick + 2) continue;
    const wire::BodyEntry is = spoon_in(next);
    const wire::BodyEntry before = spoon_in(peer.bodies[at - 1]);
    Wrench said =
        fluid_wrench(model, {is.center_of_mass, is.pose.orientation}, is.twist, next.time - model.time);
    const double step = next.time - peer.bodies[at - 1].time;
    const glm::dvec3 a = (is.twist.linear - before.twist.linear) / step;
    const glm::dvec3 turning = (is.twist.angular - before.twist.angular) / step;
    const Vector6 all{a.x, a.y, a.z, turning.x, turning.y, turning.z};
    for (std::size_t j = 0; j < 6; ++j) said.force.x -= model.added_mass[0][j] * all[j];
    off += std::pow(said.force.x - is.fluid.force.x, 2);
    held += std::pow(message.wrench.force.x - is.fluid.force.x, 2);
    square += std::pow(is.fluid.force.x, 2);
    mean += is.fluid.force.x;
    count += 1.0;
  }
  ASSERT_GT(count, 200.0);
  const double signal = std::sqrt(square / count - mean * mean / (count * count));
  lab::report_value("over the wire, three states on, force, the model",
                    100.0 * std::sqrt(off / count) / signal, "%");
  lab::report_value("over the wire, three states on, force, held", 100.0 * std::sqrt(held / count) / signal,
                    "%");
  EXPECT_LE(std::sqrt(off / count), 0.03 * signal);
}

}  // namespace
}  // namespace slosh
