#include "tests/hostile/attacker.h"

#include <array>

#include "net/clock.h"

namespace slosh::hostile {
namespace {

constexpr std::array<const char*, kHarms> kNames{
    "silent",   "half open",          "garbage",       "control", "datagrams", "out of turn", "thief",
    "texts",    "datagram flood",     "request flood", "streams", "moving",    "long length", "stalled",
    "feedback", "looks on and takes", "wrong token"};

constexpr std::size_t kGrips = 4;  // that are asked for; there may be fewer

}  // namespace

const char* name_of(Harm harm) {
  return kNames[static_cast<std::size_t>(harm)];
}

Attacker::Attacker(const Target& target, const Identity& identity, std::uint64_t seed)
    : mischief_(seed), harm_(static_cast<Harm>(mischief_.below(kHarms))) {
  const bool looks_on = harm_ == Harm::kLooksOnAndTakes || mischief_.one_in(3);
  token_ = looks_on ? target.watch.token : target.hold.token;
  if (harm_ == Harm::kWrongToken) token_[mischief_.below(token_.size())] ^= 1;
  auto made = connect_quic(target.hold.addresses, target.hold.host, identity, *this);
  if (!made) {
    problem_ = made.error().text();
    return;
  }
  end_ = std::move(made.value());
  until_ns_ = steady_now_ns() + to_nanoseconds(0.3 + 0.1 * static_cast<double>(mischief_.below(20)));
  if (harm_ == Harm::kSilent) until_ns_ += to_nanoseconds(3.0);
  acts_left_ = 1 + mischief_.below(200);
  turns_left_ = mischief_.below(12);
}

void Attacker::on_connected(ConnectionId id, const KeyFingerprint&, const std::string&) {
  connection_ = id;
  if (harm_ == Harm::kSilent || harm_ == Harm::kOutOfTurn || harm_ == Harm::kTexts) return;
  if (harm_ == Harm::kGarbage && mischief_.one_in(2)) return;
  hello(mischief_.one_in(4) ? "Ana" : "");
}

void Attacker::on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes, bool) {
  // The first byte of the control stream's first message: whatever it is, a Refused comes to those who stay
  // out.
  if (stream == control_ && !bytes.empty() &&
      bytes[0] != static_cast<std::uint8_t>(wire::ControlType::kRefused))
    ramp_ = true;
}

void Attacker::turn() {
  if (!end_) return;
  const std::int64_t now = steady_now_ns();
  if (now < stalled_until_ns_) return;
  end_->run_once(0);
  if (closed_) {
    end_.reset();
  } else if (harm_ == Harm::kHalfOpen && turns_left_-- == 0) {
    end_.reset();  // without a word
  } else if (now > until_ns_) {
    leave();
  } else if (connection_ != 0 && acts_left_ > 0) {
    acts_left_ -= 1;
    act();
  }
}

void Attacker::leave() {
  if (connection_ != 0 && mischief_.below(3) > 0) {
    if (mischief_.one_in(2)) raw(mischief_.with_text(wire::Bye{}, &wire::Bye::reason, wire::kMaxText));
    end_->close(connection_, mischief_.any() >> (2 + mischief_.below(62)), mischief_.text(600));
    end_->run_once(0);
  }
  end_.reset();
}

void Attacker::hello(const std::string& name) {
  wire::Hello hello;
  hello.token = token_;
  hello.name = name;
  say(hello);
}

void Attacker::raw(const wire::Bytes& bytes, bool end) {
  if (control_ < 0) control_ = end_->open_stream(connection_, true);
  if (control_ >= 0) end_->send_stream(connection_, control_, bytes, end);
  messages_ += 1;
}

void Attacker::raw_datagram(const wire::Bytes& bytes) {
  end_->send_datagram(connection_, Priority::kPose, std::make_shared<const wire::Bytes>(bytes));
  messages_ += 1;
}

void Attacker::act() {
  const auto grip = static_cast<std::uint32_t>(mischief_.below(kGrips));
  switch (harm_) {
    case Harm::kSilent:
    case Harm::kHalfOpen:
    case Harm::kWrongToken:
      return;
    case Harm::kGarbage:
      return raw(mischief_.noise(3000), mischief_.one_in(20));
    case Harm::kControl:
      return raw(mischief_.control(wire::PeerControl{}), mischief_.one_in(200));
    case Harm::kDatagrams:
      for (int i = 0; i < 4; ++i)
        raw_datagram(mischief_.one_in(6) ? mischief_.noise(1100) : mischief_.datagram(wire::PeerDatagrams{}));
      return;
    case Harm::kOutOfTurn:
      if (mischief_.one_in(3)) return hello();
      return raw(mischief_.one_in(2) ? mischief_.control(wire::HostControl{})
                                     : mischief_.control(wire::PeerControl{}));
    case Harm::kThief: {
      if (mischief_.one_in(8)) {
        wire::GripRequest request;
        request.grip = grip;
        request.take = !mischief_.one_in(4);
        say(request);
      }
      wire::PoseSample sample = wire::random_message<wire::PoseSample>(mischief_.any());
      sample.grip = mischief_.one_in(2) ? 0 : grip;
      sample.number = mischief_.one_in(8) ? mischief_.any() % wire::kMaxTick : ++number_;
      sample.engaged = mischief_.one_in(4) ? wire::HoldsOn::kUnfelt : wire::HoldsOn::kYes;
      wire::Poses poses;
      poses.samples.push_back(sample);
      return raw_datagram(wire::datagram(poses));
    }
    case Harm::kTexts: {
      if (mischief_.one_in(2)) {
        wire::Hello named;
        named.token = token_;
        return raw(mischief_.with_text(named, &wire::Hello::name, wire::kMaxName));
      }
      return raw(mischief_.with_text(wire::Bye{}, &wire::Bye::reason, wire::kMaxText));
    }
    case Harm::kDatagramFlood:
      for (int i = 0; i < 300; ++i) {
        wire::PoseSample sample;
        sample.grip = grip;
        sample.number = ++number_;
        wire::Poses poses;
        poses.samples.push_back(sample);
        raw_datagram(wire::datagram(poses));
      }
      return;
    case Harm::kRequestFlood:
      for (int i = 0; i < 40; ++i) {
        wire::GripRequest request;
        request.request = static_cast<std::uint32_t>(++number_);
        request.grip = grip;
        request.take = mischief_.one_in(2);
        say(request);
      }
      return;
    case Harm::kStreams: {
      const std::int64_t stream = end_->open_stream(connection_, !mischief_.one_in(3));
      if (stream >= 0) end_->send_stream(connection_, stream, mischief_.noise(20'000), mischief_.one_in(2));
      messages_ += 1;
      return;
    }
    case Harm::kMoving:
      if (mischief_.one_in(3)) (void)end_->rebind();
      return raw_datagram(mischief_.datagram(wire::PeerDatagrams{}));
    case Harm::kLongLength: {
      wire::Bytes bytes = mischief_.noise(1000);
      if (number_++ == 0)
        bytes.insert(bytes.begin(), {2, 0xff, 0xff, 0x07});  // a length of 131 071, which is allowed
      return raw(bytes);
    }
    case Harm::kStalled:
      stalled_until_ns_ = steady_now_ns() + to_nanoseconds(1.5);
      return;
    case Harm::kFeedback:
      for (int i = 0; i < 8; ++i)
        raw_datagram(wire::datagram(wire::random_message<wire::SnapshotFeedback>(mischief_.any())));
      return;
    case Harm::kLooksOnAndTakes:
      return raw(mischief_.control(
          wire::MessageList<wire::GripRequest, wire::WorldRequest, wire::ParameterRequest>{}));
  }
}

}  // namespace slosh::hostile
