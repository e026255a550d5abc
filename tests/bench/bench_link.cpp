// How the link fares: poses under loss, round trips, and how many spectators one sending core feeds.
//
// Every figure is of this machine and of what else runs on it.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <thread>

#include "net/clock.h"
#include "net/histogram.h"
#include "net/impair/relay.h"
#include "net/quic/endpoint.h"
#include "tests/bench/link_kit.h"

namespace {

using namespace slosh;
using namespace slosh::bench;

std::ofstream csv;
bool trace = false;
std::string only_link;
void row(const std::string& bench, const std::string& setting, const std::string& what, double value,
         const char* unit) {
  std::printf("  %-34s %-28s %10.4g %s\n", setting.c_str(), what.c_str(), value, unit);
  if (csv) csv << bench << ',' << setting << ',' << what << ',' << value << ',' << unit << '\n';
}

struct PoseHost : Quiet {
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override {
    std::uint64_t head[2];
    if (bytes.size() < sizeof(head)) return;
    std::memcpy(head, bytes.data(), sizeof(head));
    if (head[0] > newest) {
      newest = head[0];
      ages.push_back(1e-6 * static_cast<double>(steady_now_ns() - static_cast<std::int64_t>(head[1])));
    }
    // The newest sample and its repeats: as `repeats` samples, newest first.
    for (std::uint64_t i = 0; i < repeats && i < head[0]; ++i) seen.insert(head[0] - i);
  }
  std::uint64_t repeats = 4;
  std::uint64_t newest = 0;
  std::set<std::uint64_t> seen;
  std::vector<double> ages;  // ms, of the newest
};

/// Poses up at `rate` while snapshots of 25 datagrams flow down at 60 Hz; 5 % loss, 40 ms RTT.
void poses(double rate, int repeats, double loss, double burst, double seconds) {
  const Identity key = Identity::generate();
  PoseHost at_host;
  at_host.repeats = static_cast<std::uint64_t>(repeats);
  Quiet at_peer;
  auto host = listen_quic("127.0.0.1:0", key, at_host);
  Impairment link;
  link.delay = 0.02;
  link.loss = loss;
  link.burst = burst;
  auto relay = Relay::start({"127.0.0.1:0", host.value()->local_address(), link, link, 1});
  auto peer = connect_quic({relay.value()->address()}, key.fingerprint(), Identity::generate(), at_peer);
  if (!meet(*host.value(), at_host, *peer.value(), at_peer)) return;

  std::atomic<bool> stop = false;
  std::uint64_t snapshots = 0;
  std::thread host_thread([&] {
    const SharedBytes piece = filled(1100);
    std::int64_t due = steady_now_ns();
    const std::int64_t start = due;
    double told = 0.2;
    while (!stop) {
      if (trace && to_seconds(steady_now_ns() - start) > told) {
        tell(told, host.value()->stats(at_host.connections[0]));
        told += 0.2;
      }
      if (steady_now_ns() >= due) {
        for (int i = 0; i < 25; ++i)
          snapshots += host.value()->send_datagram(at_host.connections[0], Priority::kSnapshot, piece);
        due += kNanosecondsPerSecond / 60;
      }
      host.value()->run_once(due);
    }
  });
  const std::int64_t period = to_nanoseconds(1.0 / rate);
  const auto count = static_cast<std::uint64_t>(rate * seconds);
  const std::size_t size = 100 * static_cast<std::size_t>(repeats);
  std::int64_t due = steady_now_ns();
  for (std::uint64_t number = 1; number <= count; ++number) {
    while (steady_now_ns() < due) peer.value()->run_once(due);
    Bytes bytes(size);
    const std::uint64_t head[2] = {number, static_cast<std::uint64_t>(steady_now_ns())};
    std::memcpy(bytes.data(), head, sizeof(head));
    peer.value()->send_datagram(1, Priority::kPose, std::make_shared<const Bytes>(std::move(bytes)));
    peer.value()->run_once(0);
    due += period;
  }
  const std::int64_t until = steady_now_ns() + kNanosecondsPerSecond / 2;
  while (steady_now_ns() < until) peer.value()->run_once(until);
  const ConnectionStats up = peer.value()->stats(1);
  stop = true;
  host.value()->wake();
  host_thread.join();
  char setting[80];
  std::snprintf(setting, sizeof(setting), "%.0f Hz x %d, loss %.0f %%%s", rate, repeats, 100 * loss,
                burst > 1 ? " in bursts" : "");
  row("poses", setting, "delivered",
      100.0 * static_cast<double>(at_host.seen.size()) / static_cast<double>(count), "%");
  row("poses", setting, "age of the newest, p50", percentile(at_host.ages, 0.5), "ms");
  row("poses", setting, "age of the newest, p99", percentile(at_host.ages, 0.99), "ms");
  row("poses", setting, "dropped before sending", static_cast<double>(up.datagrams_dropped[0]), "");
  row("poses", setting, "snapshot pieces that arrived",
      100.0 * static_cast<double>(at_peer.received) / static_cast<double>(snapshots), "%");
}

struct Viewer : Quiet {
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override {
    std::int64_t sent = 0;
    std::memcpy(&sent, bytes.data(), sizeof(sent));
    const std::int64_t now = steady_now_ns();
    if (bytes.size() < 500)
      state_ages.push_back(1e-6 * static_cast<double>(now - sent));
    else
      ++pieces_in_second[static_cast<std::size_t>((now - start) / kNanosecondsPerSecond)];
  }
  std::int64_t start = steady_now_ns();
  std::vector<double> state_ages;  // ms
  std::map<std::size_t, std::uint64_t> pieces_in_second;
};

/// Snapshots of 25 datagrams at 60 Hz and states at 250 Hz come down, with no snapshots for half a second
/// first and three in the middle: what a link's measure of itself must outlive.
void snapshots(const std::string& name, const Impairment& down, int runs, double seconds) {
  if (name.find(only_link) == std::string::npos) return;
  std::vector<double> mean, worst, age;
  for (int run = 0; run < runs; ++run) {
    const Identity key = Identity::generate();
    Quiet at_host;
    Viewer at_peer;
    auto host = listen_quic("127.0.0.1:0", key, at_host);
    Impairment up;
    up.delay = down.delay;
    auto relay = Relay::start(
        {"127.0.0.1:0", host.value()->local_address(), up, down, static_cast<std::uint64_t>(run + 1)});
    auto peer = connect_quic({relay.value()->address()}, key.fingerprint(), Identity::generate(), at_peer);
    if (!meet(*host.value(), at_host, *peer.value(), at_peer)) return;
    at_peer.start = steady_now_ns();
    std::atomic<bool> stop = false;
    std::thread peer_thread([&] {
      while (!stop) peer.value()->run_once(steady_now_ns() + 20'000'000);
    });
    const std::int64_t start = at_peer.start;
    const auto elapsed = [&] { return to_seconds(steady_now_ns() - start); };
    const auto quiet = [&](double t) { return t < 0.5 || (t > seconds / 2 && t < seconds / 2 + 3.0); };
    std::int64_t state_due = start, picture_due = start;
    std::uint64_t offered = 0;
    const auto send = [&](Priority priority, std::size_t size) {
      Bytes bytes(size);
      const std::int64_t now = steady_now_ns();
      std::memcpy(bytes.data(), &now, sizeof(now));
      host.value()->send_datagram(at_host.connections[0], priority,
                                  std::make_shared<const Bytes>(std::move(bytes)));
    };
    double told = 1.0;
    while (elapsed() < seconds) {
      const std::int64_t now = steady_now_ns();
      if (trace && elapsed() > told) {
        tell(told, host.value()->stats(at_host.connections[0]));
        told += 1.0;
      }
      if (now >= picture_due) {
        // As the host does: what has no room yet is not piled up.
        const ConnectionStats stats = host.value()->stats(at_host.connections[0]);
        if (!quiet(elapsed()) && offered <= stats.datagrams_sent[2] + stats.datagrams_dropped[2] + 25)
          for (int i = 0; i < 25; ++i, ++offered) send(Priority::kSnapshot, 1100);
        picture_due += kNanosecondsPerSecond / 60;
      }
      if (now >= state_due) {
        send(Priority::kState, 150);
        state_due += kNanosecondsPerSecond / 250;
      }
      host.value()->run_once(std::min(state_due, picture_due));
    }
    stop = true;
    peer_thread.join();
    double sum = 0.0, least = 1.0;
    int count = 0;
    for (std::size_t second = 1; second + 1 < static_cast<std::size_t>(seconds); ++second) {
      const auto begin = static_cast<double>(second);
      if (quiet(begin - 0.2) || quiet(begin) || quiet(begin + 1.0)) continue;
      const double share = static_cast<double>(at_peer.pieces_in_second[second]) / (25.0 * 60.0);
      sum += share;
      least = std::min(least, share);
      ++count;
    }
    mean.push_back(100.0 * sum / std::max(count, 1));
    worst.push_back(100.0 * least);
    age.push_back(percentile(at_peer.state_ages, 0.99));
  }
  row("snapshots", name, "arrived, median run", percentile(mean, 0.5), "%");
  row("snapshots", name, "arrived, worst run", percentile(mean, 0.0), "%");
  row("snapshots", name, "worst second of all runs", percentile(worst, 0.0), "%");
  row("snapshots", name, "age of states, p99, median run", percentile(age, 0.5), "ms");
}

struct Echo : Quiet {
  void on_datagram(ConnectionId connection, std::span<const std::uint8_t> bytes) override {
    endpoint->send_datagram(connection, Priority::kPose,
                            std::make_shared<const Bytes>(bytes.begin(), bytes.end()));
  }
  Endpoint* endpoint = nullptr;
};
struct Timer : Quiet {
  void on_datagram(ConnectionId, std::span<const std::uint8_t> bytes) override {
    std::int64_t sent = 0;
    std::memcpy(&sent, bytes.data(), sizeof(sent));
    trips.push_back(1e-3 * static_cast<double>(steady_now_ns() - sent));
  }
  std::vector<double> trips;  // µs
};

void round_trip(double seconds) {
  const Identity key = Identity::generate();
  Echo at_host;
  Timer at_peer;
  auto host = listen_quic("127.0.0.1:0", key, at_host);
  at_host.endpoint = host.value().get();
  auto peer = connect_quic({host.value()->local_address()}, key.fingerprint(), Identity::generate(), at_peer);
  if (!meet(*host.value(), at_host, *peer.value(), at_peer)) return;
  std::atomic<bool> stop = false;
  double host_cpu = 0.0;
  std::thread host_thread([&] {
    while (!stop) host.value()->run_once(steady_now_ns() + kNanosecondsPerSecond);
    host_cpu = thread_cpu();
  });
  const double cpu = thread_cpu();
  std::int64_t due = steady_now_ns();
  for (int i = 0; i < static_cast<int>(1000 * seconds); ++i) {
    while (steady_now_ns() < due) peer.value()->run_once(due);
    Bytes bytes(64);
    const std::int64_t now = steady_now_ns();
    std::memcpy(bytes.data(), &now, sizeof(now));
    peer.value()->send_datagram(1, Priority::kPose, std::make_shared<const Bytes>(std::move(bytes)));
    peer.value()->run_once(0);
    due += 1'000'000;
  }
  const std::int64_t until = steady_now_ns() + kNanosecondsPerSecond / 5;
  while (steady_now_ns() < until) peer.value()->run_once(until);
  const double peer_cpu = thread_cpu() - cpu;
  stop = true;
  host.value()->wake();
  host_thread.join();
  row("loopback", "1 kHz, 64 bytes", "round trip p50", percentile(at_peer.trips, 0.5), "us");
  row("loopback", "1 kHz, 64 bytes", "round trip p99", percentile(at_peer.trips, 0.99), "us");
  row("loopback", "1 kHz, 64 bytes", "came back",
      100.0 * static_cast<double>(at_peer.trips.size()) / (1000 * seconds), "%");
  row("loopback", "1 kHz, 64 bytes", "a core, host", 100.0 * host_cpu / seconds, "%");
  row("loopback", "1 kHz, 64 bytes", "a core, peer", 100.0 * peer_cpu / seconds, "%");
}

/// One endpoint sends the same 26 kB in datagrams to `count` connections, 30 times a s.
void fan_out(int count, double seconds) {
  const Identity key = Identity::generate();
  EndpointOptions options;
  options.handshakes_per_second = options.handshakes_in_all = 1e6;
  options.idle_timeout = 20.0;
  Quiet at_host;
  auto host = listen_quic("127.0.0.1:0", key, at_host, options);
  std::vector<std::unique_ptr<Quiet>> events;
  std::vector<std::unique_ptr<Endpoint>> peers;
  const Identity spectator = Identity::generate();
  for (int i = 0; i < count; ++i) {
    events.push_back(std::make_unique<Quiet>());
    auto peer =
        connect_quic({host.value()->local_address()}, key.fingerprint(), spectator, *events.back(), options);
    if (!peer || !meet(*host.value(), at_host, *peer.value(), *events.back())) return;
    peers.push_back(std::move(peer.value()));
  }
  std::atomic<bool> stop = false;
  std::thread receivers([&] {
    while (!stop) {
      const std::int64_t next = steady_now_ns() + 1'000'000;
      for (const auto& peer : peers) peer->run_once(0);
      sleep_until_ns(next);
    }
  });
  std::vector<SharedBytes> pieces;
  for (int i = 0; i < 24; ++i) pieces.push_back(filled(1090 + static_cast<std::size_t>(i * 7 % 40)));
  const auto frames = static_cast<int>(30 * seconds);
  const double cpu = thread_cpu();
  const std::int64_t start = steady_now_ns();
  std::int64_t due = start;
  for (int frame = 0; frame < frames; ++frame) {
    for (const ConnectionId connection : at_host.connections)
      for (const SharedBytes& piece : pieces)
        host.value()->send_datagram(connection, Priority::kSnapshot, piece);
    due += kNanosecondsPerSecond / 30;
    while (steady_now_ns() < due) host.value()->run_once(due);
  }
  const double used = thread_cpu() - cpu;
  const double wall = to_seconds(steady_now_ns() - start);
  std::uint64_t sent = 0, dropped = 0, lost = 0;
  for (const ConnectionId connection : at_host.connections) {
    const ConnectionStats stats = host.value()->stats(connection);
    sent += stats.datagrams_sent[2];
    dropped += stats.datagrams_dropped[2];
    lost += stats.datagrams_lost;
  }
  stop = true;
  receivers.join();
  const std::string setting = std::to_string(count) + " spectators";
  row("fanout", setting, "a core, sending", 100.0 * used / wall, "%");
  row("fanout", setting, "a datagram costs",
      1e6 * used / static_cast<double>(std::max<std::uint64_t>(sent, 1)), "us");
  const double asked = static_cast<double>(frames) * count * static_cast<double>(pieces.size());
  row("fanout", setting, "sent of what was asked", 100.0 * static_cast<double>(sent) / asked, "%");
  row("fanout", setting, "dropped, lost", static_cast<double>(dropped + lost), "");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures slosh's QUIC link on this machine."};
  double seconds = 10.0;
  std::string file;
  std::string only;
  app.add_option("--seconds", seconds, "each measurement's length")->check(CLI::Range(0.5, 600.0));
  app.add_option("--csv", file, "also writes the figures here");
  int runs = 5;
  app.add_option("--only", only, "poses, snapshots, loopback or fanout")
      ->check(CLI::IsMember({"poses", "snapshots", "loopback", "fanout"}));
  app.add_option("--runs", runs, "how often each link of `snapshots` is tried")->check(CLI::Range(1, 1000));
  app.add_option("--link", only_link, "of `snapshots`, only links with this in their name");
  app.add_flag("--trace", trace, "also says how each link fares as it goes (`poses`, `snapshots`)");
  CLI11_PARSE(app, argc, argv);
  if (!file.empty()) {
    csv.open(file);
    csv << "bench,setting,figure,value,unit\n";
  }
  if (only.empty() || only == "poses") {
    std::printf("poses at 40 ms RTT while 60 snapshots a s of 25 datagrams come down (target: 99.9 %%)\n");
    poses(250, 4, 0.05, 1.0, seconds);
    poses(500, 4, 0.05, 1.0, seconds);
    poses(250, 6, 0.05, 2.0, seconds);
  }
  if (only.empty() || only == "snapshots") {
    std::printf("snapshots of 25 datagrams at 60 Hz (1.65 MB/s) and states at 250 Hz come down, 40 ms RTT\n");
    Impairment link;
    link.delay = 0.02;
    snapshots("no loss", link, runs, seconds);
    link.loss = 0.02;
    snapshots("2 % loss", link, runs, seconds);
    link.loss = 0.05;
    snapshots("5 % loss", link, runs, seconds);
    link.loss = 0.1;
    snapshots("10 % loss", link, runs, seconds);
    link.loss = 0.0;
    link.rate = 1e6;
    link.queue = 200e3;
    snapshots("1 MB/s, deep queue", link, runs, seconds);
    link.queue = 20e3;
    snapshots("1 MB/s, short queue", link, runs, seconds);
  }
  if (only.empty() || only == "loopback") {
    std::printf("loopback\n");
    round_trip(seconds);
  }
  if (only.empty() || only == "fanout") {
    std::printf("30 Hz x 24 datagrams of 1.1 kB to each (target: 100 spectators on one core)\n");
    for (const int count : {10, 50, 100, 150}) fan_out(count, seconds);
  }
}
