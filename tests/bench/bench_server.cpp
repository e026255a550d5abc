// A host with peers over real QUIC on loopback: from hand to hand, from link to picture, what watchers cost,
// and what stays after many have come and gone.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "net/wire/all_messages.h"
#include "tests/bench/server_world.h"

namespace slosh::bench {
namespace {

struct Client final : EndpointEvents {
  Client(const BenchHost& host, const wire::Token& token, const Identity& identity, bool decodes)
      : token_(token), decodes_(decodes) {
    auto made = connect_quic({host.address()}, host.key(), identity, *this);
    if (!made) throw std::runtime_error(made.error().text());
    end = std::move(made.value());
  }
  void turn() {
    end->run_once(0);
    const std::int64_t now = steady_now_ns();
    if (!in || now < feedback_ns_) return;
    feedback_ns_ = now + 100'000'000;
    if (decodes_) {
      while (decoder.next()) frames += 1;
      send(decoder.feedback());
      return;
    }
    wire::SnapshotFeedback feedback;
    feedback.stream = stream_;
    feedback.pieces = feedback.pieces_sent = std::exchange(pieces_, 0);
    send(feedback);
  }
  template <class M>
  void send(const M& message) {
    end->send_datagram(connection, Priority::kPose,
                       std::make_shared<const wire::Bytes>(wire::datagram(message)));
  }
  template <class M>
  void say(const M& message) {
    if (control_ < 0) control_ = end->open_stream(connection, true);
    end->send_stream(connection, control_, wire::control(message), false);
  }
  void pose(std::uint64_t number) {
    wire::PoseSample sample;
    sample.number = number;
    sample.stamp_ns = steady_now_ns();
    sample.engaged = wire::HoldsOn::kYes;
    sample.pose.position.x = static_cast<double>(number % 8192);
    send(wire::Poses{{sample, sample, sample, sample}});
  }

  void on_connected(ConnectionId id, const KeyFingerprint&, const std::string&) override {
    connection = id;
    say(wire::Hello{wire::kProtocolVersion, token_, "bench", {}, 0, {}});
  }
  void on_stream(ConnectionId, std::int64_t stream, std::span<const std::uint8_t> bytes, bool) override {
    if (stream != control_) return;
    (void)splitter_.feed(bytes, [&](std::uint64_t type, wire::ByteView) {
      in = in || type == static_cast<std::uint64_t>(wire::ControlType::kWelcome);
      return wire::Fault{};
    });
  }
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override {
    const auto type = static_cast<wire::DatagramType>(bytes[0]);
    if (type == wire::DatagramType::kSnapshotPiece) {
      pieces_ += 1;
      stream_ = bytes[1];
      received += bytes.size();
      if (decodes_ && !decoder.take(bytes)) {
        std::optional<DecodedFrame> frame = decoder.next();
        if (frame && frame->complete == 1.0) complete = true;
      }
    } else if (type == wire::DatagramType::kHands && on_hands) {
      wire::Hands hands;
      if (!wire::decode(bytes.subspan(1), hands)) on_hands(hands);
    }
  }
  void on_closed(ConnectionId, const CloseReason& why) override { closed = why.text; }

  std::unique_ptr<Endpoint> end;
  ConnectionId connection = 0;
  SnapshotDecoder decoder;
  std::function<void(const wire::Hands&)> on_hands;
  std::uint64_t frames = 0;
  std::size_t received = 0;
  std::string closed;
  bool in = false;
  bool complete = false;

 private:
  wire::Token token_;
  bool decodes_;
  wire::StreamSplitter splitter_;
  std::int64_t control_ = -1;
  std::int64_t feedback_ns_ = 0;
  std::uint32_t pieces_ = 0;
  std::uint32_t stream_ = 0;
};

double at(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// Two participants: one moves at 500 Hz, the other takes down when each hand came. ms.
struct HandToHand {
  HandToHand(BenchHost& host, const Identity& a, const Identity& b)
      : from(host, host.hold, a, false), to(host, host.hold, b, false) {
    to.on_hands = [this](const wire::Hands& hands) {
      const auto which = static_cast<std::size_t>(hands.hands[0].pose.position.x + 0.5);
      const double ms = 1e-6 * static_cast<double>(steady_now_ns() - sent[which % sent.size()]);
      if (measuring) latencies.push_back(ms);
    };
  }
  bool ready() {
    const std::int64_t until = steady_now_ns() + to_nanoseconds(5.0);
    while (!(from.in && to.in) && steady_now_ns() < until) {
      from.end->run_once(steady_now_ns() + 1'000'000);
      to.end->run_once(steady_now_ns() + 1'000'000);
    }
    from.say(wire::GripRequest{1, 0, true});
    return from.in && to.in;
  }
  void run(double seconds, const std::atomic<bool>* stop = nullptr) {
    const std::int64_t until = steady_now_ns() + to_nanoseconds(seconds);
    std::int64_t next = steady_now_ns();
    while (steady_now_ns() < until && !(stop && *stop)) {
      if (steady_now_ns() >= next) {
        next += 2'000'000;
        number += 1;
        sent[number % sent.size()] = steady_now_ns();
        from.pose(number);
      }
      from.turn();
      to.turn();
      // Waits where the hands arrive: what this thread does besides must not count as the host's.
      to.end->run_once(std::min(next, steady_now_ns() + 200'000));
    }
  }
  Client from;
  Client to;
  std::vector<std::int64_t> sent = std::vector<std::int64_t>(8192);
  std::vector<double> latencies;
  std::uint64_t number = 0;
  bool measuring = true;
};

void bench_hands(std::ofstream& csv, double seconds) {
  BenchHost host(32768, 8);
  const Identity a = Identity::generate();
  const Identity b = Identity::generate();
  HandToHand pair(host, a, b);
  if (!pair.ready()) throw std::runtime_error("the peers were not let in");
  pair.measuring = false;
  pair.run(1.0);
  pair.measuring = true;
  pair.run(seconds);
  const double p50 = at(pair.latencies, 0.5);
  const double p99 = at(pair.latencies, 0.99);
  std::printf(
      "hand to hand, 500 Hz, 32 768 particles at 60 Hz to both: p50 %.2f ms, p99 %.2f ms, longest %.2f "
      "ms, %zu of %.0f arrived (target: p99 <= 4 ms added)\n",
      p50, p99, at(pair.latencies, 1.0), pair.latencies.size(), 500.0 * seconds);
  csv << "hands,p50_ms," << p50 << "\nhands,p99_ms," << p99 << "\n";
}

void bench_joins(std::ofstream& csv, int times) {
  BenchHost host(32768, 64);
  std::vector<double> took;
  std::vector<double> bytes;
  for (int i = 0; i < times; ++i) {
    const Identity identity = Identity::generate();
    const std::int64_t begin = steady_now_ns();
    Client client(host, host.watch, identity, true);
    while (!client.complete && to_seconds(steady_now_ns() - begin) < 5.0)
      client.end->run_once(steady_now_ns() + 5'000'000);
    took.push_back(to_seconds(steady_now_ns() - begin));
    bytes.push_back(static_cast<double>(client.received));
    client.end->close(client.connection, 0, "seen");
    for (int k = 0; k < 5; ++k) client.end->run_once(steady_now_ns() + 10'000'000);
  }
  const double median = at(took, 0.5);
  std::printf(
      "link to first whole picture (32 768 particles, what is seen): median %.0f ms, longest %.0f ms, %.0f "
      "kB "
      "until then (target: <= 1 s)\n",
      1e3 * median, 1e3 * at(took, 1.0), 1e-3 * at(bytes, 0.5));
  csv << "join,median_s," << median << "\njoin,longest_s," << at(took, 1.0) << "\n";
}

void bench_watchers(std::ofstream& csv, const std::vector<std::size_t>& counts, double seconds) {
  std::printf(
      "watchers of 32 768 particles (what is seen, 30 Hz)\n"
      "  watchers   network thread   MB/s out   hand to hand p50   p99    frames each/s   withheld\n");
  for (const std::size_t count : counts) {
    BenchHost host(32768, count + 8);
    std::vector<Identity> identities;
    std::vector<std::unique_ptr<Client>> watchers;
    const Identity own = Identity::generate();
    for (std::size_t i = 0; i < count; ++i)
      watchers.push_back(
          std::make_unique<Client>(host, host.watch, identities.emplace_back(Identity::generate()), false));
    std::atomic<bool> stop{false};
    std::thread crowd([&] {
      while (!stop) {
        for (const auto& watcher : watchers) watcher->turn();
        usleep(500);
      }
    });
    const Identity other = Identity::generate();
    HandToHand pair(host, own, other);
    const bool ready = pair.ready();
    pair.measuring = false;
    pair.run(3.0);
    pair.measuring = true;
    const double cpu = host.loop().cpu_seconds();
    const ServerFigures before = host.loop().figures();
    const std::int64_t begin = steady_now_ns();
    pair.run(seconds);
    const double wall = to_seconds(steady_now_ns() - begin);
    const double share = (host.loop().cpu_seconds() - cpu) / wall;
    const ServerFigures after = host.loop().figures();
    stop = true;
    crowd.join();
    std::size_t in = 0;
    for (const auto& watcher : watchers) in += watcher->in ? 1 : 0;
    const double rate = 1e-6 * static_cast<double>(after.bytes_sent - before.bytes_sent) / wall;
    const double frames = static_cast<double>(after.frames_sent - before.frames_sent) / wall /
                          std::max<double>(1.0, static_cast<double>(count));
    std::printf("  %4zu%s       %5.1f %%        %6.2f       %6.2f ms      %6.2f ms   %6.1f        %llu\n", in,
                ready && in == count ? " " : "!", 100.0 * share, rate, at(pair.latencies, 0.5),
                at(pair.latencies, 0.99), frames,
                static_cast<unsigned long long>(after.frames_withheld - before.frames_withheld));
    std::fflush(stdout);
    csv << "watchers," << count << ",share," << share << ",p99_ms," << at(pair.latencies, 0.99) << "\n";
  }
}

double resident_mb() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

void bench_churn(std::ofstream& csv, int joins) {
  BenchHost host(4096, 64);
  std::vector<Identity> people;
  for (int i = 0; i < 50; ++i) people.push_back(Identity::generate());
  std::printf("churn over QUIC, 50 people in turn\n  joins   resident MB   connections\n");
  for (int i = 0; i <= joins; ++i) {
    if (i % std::max(1, joins / 8) == 0) {
      std::printf("  %5d   %8.1f      %zu\n", i, resident_mb(), host.loop().figures().spectators);
      std::fflush(stdout);
      csv << "churn," << i << ",resident_mb," << resident_mb() << "\n";
    }
    Client client(host, host.watch, people[static_cast<std::size_t>(i) % people.size()], false);
    const std::int64_t until = steady_now_ns() + to_nanoseconds(2.0);
    while (!client.in && steady_now_ns() < until) client.end->run_once(steady_now_ns() + 2'000'000);
    client.turn();
    if (i % 3) client.end->close(client.connection, 0, "bye");
    client.end->run_once(steady_now_ns() + 1'000'000);
  }
}

}  // namespace
}  // namespace slosh::bench

int main(int argc, char** argv) {
  CLI::App app("A host with peers: from hand to hand, from link to picture, watchers, churn.");
  std::string only;
  std::string csv_file = "/dev/null";
  std::vector<std::size_t> counts{0, 25, 50, 100, 150};
  double seconds = 6.0;
  int joins = 1200;
  app.add_option("--only", only, "hands, joins, watchers or churn")
      ->check(CLI::IsMember({"hands", "joins", "watchers", "churn"}));
  app.add_option("--watchers", counts, "How many watch")->capture_default_str();
  app.add_option("--seconds", seconds, "Measured, each")->capture_default_str();
  app.add_option("--joins", joins, "Of the churn")->capture_default_str();
  app.add_option("--csv", csv_file, "File for the numbers");
  CLI11_PARSE(app, argc, argv);
  std::ofstream csv(csv_file);
  const auto wanted = [&](const char* name) { return only.empty() || only == name; };
  try {
    if (wanted("hands")) slosh::bench::bench_hands(csv, seconds);
    if (wanted("joins")) slosh::bench::bench_joins(csv, 20);
    if (wanted("watchers")) slosh::bench::bench_watchers(csv, counts, seconds);
    if (wanted("churn")) slosh::bench::bench_churn(csv, joins);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_server: %s\n", error.what());
    return 1;
  }
  return 0;
}
