#include "tests/lab/coupling/study.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <numbers>
#include <random>

#include "net/clock.h"
#include "peer/devices/operator_device.h"
#include "peer/replica/held_body.h"
#include "tests/lab/coupling/particle_host.h"
#include "tests/lab/coupling/virtual_host.h"

namespace slosh::coupling {
namespace {

constexpr double kPeriod = 0.001;    // s, of every device loop
constexpr double kBegins = 0.5;      // s
constexpr double kMoves = 4.0;       // s
constexpr double kReach = 0.08;      // m
constexpr double kPace = 0.9;        // Hz
constexpr double kReleased = 2.0;    // s: about where a hand is fastest
constexpr double kBroken = 2000.0;   // N
constexpr double kGone = 3.0;        // m
constexpr double kStill = 2e-3;      // m/s: slower than this counts as still
constexpr double kStep = 1.0;        // N
constexpr double kRounding = 1e-9;   // s
constexpr double kToneSpeed = 0.03;  // m/s
constexpr double kToneWay = 0.008;   // m

/// What the host tells a site.
struct StateWord {
  double stamp = -1.0;
  RigidMotion motion;
  std::vector<HandWord> hands;
  std::vector<Wrench> on_hand;
  bool has_load = false;
  FluidLoad load;
  Wrench fluid;
};

/// One way of a link: each packet late by its own, or lost.
template <class T>
class Way {
 public:
  Way(const Case& c, bool perfect)
      : delay_(perfect ? 0.0 : 0.5 * c.round_trip),
        jitter_(perfect ? 0.0 : c.jitter),
        loss_(perfect ? 0.0 : c.loss) {}
  void send(const T& word, double now, std::mt19937_64& random) {
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    const double late = jitter_ * chance(random);
    if (chance(random) < loss_) return;
    waiting_.push_back({now + delay_ + late, word});
  }
  /// The newest that came by now and is newer than `newest`; true when there is one.
  bool receive(double now, T& newest) {
    bool fresh = false;
    for (auto packet = waiting_.begin(); packet != waiting_.end();) {
      if (packet->due > now + kRounding) {
        ++packet;
        continue;
      }
      if (packet->word.stamp > newest.stamp) {
        newest = std::move(packet->word);
        fresh = true;
      }
      packet = waiting_.erase(packet);
    }
    return fresh;
  }

 private:
  struct Packet {
    double due;
    T word;
  };
  double delay_, jitter_, loss_;
  std::deque<Packet> waiting_;
};

/// To and fro and round, from rest to rest.
std::vector<PoseKey> wanted_motion(const Pose& start, double share, bool released) {
  std::vector<PoseKey> keys;
  if (share == 0.0) return keys;
  const double end = released ? kReleased : kMoves;
  for (double u = 0.0; u <= end + kRounding; u += 0.01) {
    const double swell = 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * u / kMoves));
    const double place = share * kReach * swell * std::sin(2.0 * std::numbers::pi * kPace * u);
    PoseKey& key = keys.emplace_back();
    key.time = kBegins + u;
    key.pose.position = start.position + place * glm::dvec3(1.0, 0.6, 0.3);
    key.pose.orientation = rotate_by(start.orientation, 4.0 * place * glm::dvec3(0.2, 1.0, 0.3));
  }
  return keys;
}

/// A sum of tones whose phases keep it from leaping at once.
std::vector<PoseKey> toned_motion(const Pose& start, const std::vector<double>& tones, double seconds) {
  std::vector<PoseKey> keys;
  for (double t = 0.0; t <= seconds + kRounding; t += 0.002) {
    double place = 0.0;
    for (std::size_t i = 0; i < tones.size(); ++i) {
      const double pace = 2.0 * std::numbers::pi * tones[i];
      const double phase = std::numbers::pi * static_cast<double>(i * i) / static_cast<double>(tones.size());
      place += std::min(kToneSpeed / pace, kToneWay) * std::sin(pace * t + phase);
    }
    PoseKey& key = keys.emplace_back();
    key.time = t;
    key.pose = start;
    key.pose.position.x += place * std::min(t, 1.0);
  }
  return keys;
}

double share_of(Motion motion, int hand) {
  switch (motion) {
    case Motion::kTogether:
      return 1.0;
    case Motion::kOneMoves:
    case Motion::kRelease:
      return hand == 0 ? 1.0 : 0.0;
    case Motion::kOpposing:
      return hand % 2 == 0 ? 1.0 : -1.0;
  }
  return 0.0;
}

std::unique_ptr<StudyHost> host_of(const Case& c, double time_step) {
  if (c.load == Load::kBucket) return std::make_unique<ParticleHost>(c, time_step);
  return std::make_unique<VirtualHost>(c, time_step);
}

/// A person, their device and their end of the link.
struct StudySite {
  std::unique_ptr<OperatorDevice> person;
  Way<HandWord> up;
  Way<StateWord> down;
  StateWord state;
  std::unique_ptr<HeldBody> held;
  std::vector<OwnHand> own;
  HandWord hand;
  Wrench felt;
  glm::dvec3 row{0.0};  // N, felt at the last even tick
  Pose before;
  double put_in = 0.0;  // J, as it is, not as the site counts it
  double next_send = 0.0;
  double received = 0.0;  // s, when the newest state came
  bool has_state = false;
  std::uint64_t fired = 0;
};

class Study {
 public:
  Study(const Case& c, Scheme scheme, const ReplicaTuning& tuning)
      : c_(c),
        scheme_(scheme),
        perfect_(scheme == Scheme::kZeroDelay),
        time_step_(perfect_ ? kPeriod : 1.0 / c.host_rate),
        made_(host_of(c, time_step_)),
        host_(*made_),
        known_(static_cast<std::size_t>(c.hands)) {
    std::vector<ReplicaGrip> grips;
    for (const Pose& grip : host_.grips()) grips.push_back({grip, host_.gains()});
    ReplicaBody body = host_.body();
    body.mass *= c.replica_mass;
    body.inertia *= c.replica_mass;
    const Pose at{host_.motion().position, host_.motion().orientation};
    for (int i = 0; i < c.hands; ++i) {
      const auto g = static_cast<std::size_t>(i);
      const Pose start = compose(at, host_.grips()[g]);
      known_[g].pose = start;
      StudySite& site =
          *sites_.emplace_back(std::make_unique<StudySite>(StudySite{nullptr,
                                                                     Way<HandWord>(c, perfect_),
                                                                     Way<StateWord>(c, perfect_),
                                                                     {},
                                                                     nullptr,
                                                                     {},
                                                                     {},
                                                                     {},
                                                                     glm::dvec3(0.0),
                                                                     {},
                                                                     0.0,
                                                                     0.0,
                                                                     0.0,
                                                                     false,
                                                                     0}));
      std::vector<PoseKey> wanted;
      if (c.tones.empty())
        wanted = wanted_motion(start, share_of(c.motion, i), c.motion == Motion::kRelease);
      else if (i == 0)
        wanted = toned_motion(start, c.tones, c.seconds);
      const PoseTrack track(wanted, start);
      site.person = std::make_unique<OperatorDevice>(track, parse_operator(c.grip + ",correction=0").value());
      site.held = std::make_unique<HeldBody>(body, grips, tuning);
      site.own.resize(grips.size());
      site.own[g].here = true;
      site.before = start;
    }
  }

  Outcome all() {
    const auto ticks = static_cast<std::size_t>(std::lround(c_.seconds / kPeriod));
    run_.felt.reserve(ticks * sites_.size());
    run_.handles.reserve(ticks);
    for (std::size_t i = 0; i < ticks && !broken_; ++i) tick(i);
    run_.verdict = verdict();
    for (const auto& site : sites_) {
      run_.fired += static_cast<double>(site->held->fired()) / static_cast<double>(ticks * sites_.size());
    }
    return std::move(run_);
  }

 private:
  void tick(std::size_t i) {
    tick_ = i;
    now_ = kPeriod * static_cast<double>(i);
    for (const auto& site : sites_) read(*site);
    // At zero delay hand and body are compared at one moment: the body moves on when all have felt it.
    if (!perfect_ || i == 0) step_host();
    double put_in = 0.0;
    for (std::size_t g = 0; g < sites_.size(); ++g) {
      turn(*sites_[g], g);
      put_in += sites_[g]->put_in;
    }
    if (perfect_ && i > 0) step_host();
    // What a weight gave by sinking is nobody's making.
    run_.generated = std::max(run_.generated, -put_in - std::max(host_.given(), 0.0));
  }

  void read(StudySite& site) {
    const DeviceReport report = site.person->read({now_, kPeriod});
    site.put_in -=
        glm::dot(site.felt.force, report.pose.position - site.before.position) +
        glm::dot(site.felt.torque, rotation_between(site.before.orientation, report.pose.orientation));
    site.before = report.pose;
    const bool first = &site == sites_.front().get();
    if (first) run_.handles.push_back(report.pose);
    const bool let_go = first && c_.motion == Motion::kRelease && now_ > kBegins + kReleased;
    site.hand = {now_, report.pose, report.twist, !let_go, scheme_ == Scheme::kReplica ? 0.0 : site.put_in};
    if (!(glm::length(report.pose.position) < kGone)) broken_ = true;
    const double speed = glm::dot(report.twist.linear, report.twist.linear) +
                         0.02 * glm::dot(report.twist.angular, report.twist.angular);
    if (now_ >= c_.seconds - 1.0)
      last_ += speed;
    else if (now_ >= c_.seconds - 2.0)
      before_ += speed;
  }

  void step_host() {
    while (next_step_ <= now_ + kRounding) {
      next_step_ += time_step_;
      for (std::size_t g = 0; g < sites_.size(); ++g) sites_[g]->up.receive(now_, known_[g]);
      host_.step(known_);
      const StateWord word{now_,         host_.motion(), known_, host_.on_hand(), host_.has_load(),
                           host_.load(), host_.fluid()};
      for (const auto& site : sites_) site->down.send(word, now_, random_);
    }
  }

  void turn(StudySite& site, std::size_t g) {
    const bool fresh = site.down.receive(now_, site.state);
    if (fresh) {
      site.received = now_;
      site.has_state = true;
    }
    Wrench felt;
    if (site.has_state) felt = scheme_ == Scheme::kReplica ? by_replica(site, g, fresh) : by_host(site, g);
    if (scheme_ != Scheme::kReplica && !site.hand.engaged) felt = Wrench{};
    if (now_ >= site.next_send - kRounding) {
      site.next_send += perfect_ ? kPeriod : 1.0 / c_.pose_rate;
      site.up.send(site.hand, now_, random_);
    }
    const double force = glm::length(felt.force);
    if (!(force < kBroken)) broken_ = true;
    run_.peak = std::max(run_.peak, force);
    run_.felt.push_back(felt);
    if (tick_ % 2 == 0) {
      if (glm::length(felt.force - site.row) > kStep) run_.steps += 1;
      site.row = felt.force;
    }
    site.felt = felt;
    site.person->write(felt);
  }

  Wrench by_host(const StudySite& site, std::size_t g) const {
    if (scheme_ == Scheme::kHostForce) return site.state.on_hand[g];
    const double on = perfect_ ? 0.0 : std::min(now_ - site.received, 2.0 * time_step_);
    const RigidMotion& body = site.state.motion;
    const Pose pose = extrapolate({body.position, body.orientation}, body.twist, on);
    const Pose grip = compose(pose, host_.grips()[g]);
    const Twist twist{body.twist.linear + glm::cross(body.twist.angular, grip.position - pose.position),
                      body.twist.angular};
    return coupling_wrench_on_hand(host_.gains(), site.hand.pose, site.hand.twist, grip, twist);
  }

  Wrench by_replica(StudySite& site, std::size_t g, bool fresh) {
    HeldBody& held = *site.held;
    if (fresh) tell(site, g);
    OwnHand& own = site.own[g];
    own.engaged = site.hand.engaged;
    own.handle = site.hand.pose;
    own.twist = site.hand.twist;
    const GripState grip = held.grip(g);
    Wrench felt;
    if (own.engaged) {
      const Wrench wanted =
          coupling_wrench_on_hand(host_.gains(), own.handle, own.twist, grip.pose, grip.twist);
      felt = held.limit(g, wanted, own.handle, own.twist, kPeriod, c_.most_damping);
    } else {
      (void)held.limit(g, Wrench{}, own.handle, Twist{}, kPeriod, c_.most_damping);
    }
    held.sent(g, felt);
    site.hand.energy = held.energy(g);
    held.advance(site.own, kPeriod, to_nanoseconds(now_ + kPeriod) + 1);
    run_.fell_back = run_.fell_back || held.fallen_back();
    return felt;
  }

  void tell(StudySite& site, std::size_t g) {
    said_.assign(site.state.hands.size(), {});
    for (std::size_t j = 0; j < said_.size(); ++j) {
      const HandWord& hand = site.state.hands[j];
      said_[j] = {hand.engaged, hand.pose, site.state.on_hand[j], 0, true, hand.energy};
      // The step's end answers to the reading and its whole length.
      if (j == g && hand.stamp >= 0.0) said_[j].ack_ns = to_nanoseconds(hand.stamp + time_step_) + 1;
    }
    if (site.state.has_load) site.held->set_fluid(site.state.load);
    site.held->receive({to_nanoseconds(now_) + 1, site.state.stamp, time_step_, site.state.motion, said_, 1.0,
                        true, site.state.fluid});
  }

  Verdict verdict() {
    const double hand_ticks = static_cast<double>(sites_.size()) / kPeriod;
    run_.swing = std::sqrt(last_ / hand_ticks);
    if (broken_) return Verdict::kDiverged;
    const double before = std::sqrt(before_ / hand_ticks);
    return run_.swing > kStill && run_.swing > 0.98 * before ? Verdict::kLimitCycle : Verdict::kStable;
  }

  const Case& c_;
  Scheme scheme_;
  bool perfect_;
  double time_step_;
  std::unique_ptr<StudyHost> made_;
  StudyHost& host_;
  std::vector<HandWord> known_;
  std::vector<std::unique_ptr<StudySite>> sites_;
  std::vector<HostHand> said_;
  std::mt19937_64 random_{7};
  double now_ = 0.0;
  std::size_t tick_ = 0;
  double next_step_ = 0.0;
  double last_ = 0.0, before_ = 0.0;  // sums of squared speeds
  bool broken_ = false;
  Outcome run_;
};

}  // namespace

Outcome run(const Case& c, Scheme scheme, const ReplicaTuning& tuning) {
  return Study(c, scheme, tuning).all();
}

double force_error(const Outcome& felt, const Outcome& reference) {
  double off = 0.0, all = 0.0;
  for (std::size_t i = 0; i < std::min(felt.felt.size(), reference.felt.size()); ++i) {
    const glm::dvec3 difference = felt.felt[i].force - reference.felt[i].force;
    off += glm::dot(difference, difference);
    all += glm::dot(reference.felt[i].force, reference.felt[i].force);
  }
  return all > 0.0 ? std::sqrt(off / all) : 0.0;
}

double spring_bound(const Case& c) {
  const double own = parse_operator(c.grip).value().arm.damping;
  return std::max((own + 0.03 * c.stiffness) / c.stiffness - 0.5 * kPeriod, 0.0);
}

const char* word(Verdict verdict) {
  constexpr const char* kWords[] = {"stable", "limit cycle", "diverged"};
  return kWords[static_cast<std::size_t>(verdict)];
}

const char* word(Scheme scheme) {
  constexpr const char* kWords[] = {"zero delay", "host force", "peer spring", "replica"};
  return kWords[static_cast<std::size_t>(scheme)];
}

}  // namespace slosh::coupling
