// quic_storm: real ends of ours over loopback against ends that say anything, correctly encrypted.
//
// A decoder's fuzzer never gets behind the encryption: this one is inside it. It rewrites the plaintext of
// packets, sends made-up frames, changes ports and connection ids while others do, breaks handshakes off, and
// looks every while whether a bystander still hears a host and a peer still reaches one. Ends by itself.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <random>

#include "tests/net/quic/crafted_end.h"
#include "tests/net/quic/ends.h"

namespace slosh::testing {
namespace {

using Random = std::mt19937_64;

std::uint64_t below(Random& random, std::uint64_t count) {
  return random() % count;
}
bool chance(Random& random, double share) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random) < share;
}

/// A number that is likely to be at somebody's edge.
std::uint64_t edge(Random& random) {
  static constexpr std::uint64_t kEdges[] = {0,          1,          2,        3,           4,
                                             5,          6,          7,        8,           15,
                                             16,         20,         63,       64,          255,
                                             256,        1200,       16383,    16384,       65535,
                                             1073741823, 1073741824, 1u << 31, 0xffffffffu, (1ull << 62) - 1};
  return chance(random, 0.8) ? kEdges[below(random, std::size(kEdges))] : random() >> (2 + below(random, 60));
}

void put_bytes(Bytes& out, Random& random, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(random()));
}

/// A frame of some type, most of the time well formed, with odd numbers in it.
Bytes odd_frame(Random& random) {
  static constexpr std::uint8_t kTypes[] = {0x00, 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08,
                                            0x0a, 0x0c, 0x0e, 0x0f, 0x10, 0x11, 0x12, 0x13, 0x14,
                                            0x15, 0x16, 0x17, 0x18, 0x18, 0x18, 0x19, 0x19, 0x1a,
                                            0x1a, 0x1b, 0x1b, 0x1c, 0x1d, 0x1e, 0x30, 0x31, 0x31};
  const std::uint8_t type =
      chance(random, 0.97) ? kTypes[below(random, std::size(kTypes))] : static_cast<std::uint8_t>(random());
  Bytes out{type};
  const auto number = [&] { put_integer(out, edge(random)); };
  const auto sized = [&] {
    const std::size_t size = below(random, 40);
    put_integer(out, chance(random, 0.9) ? size : edge(random));
    put_bytes(out, random, size);
  };
  if (type >= 0x08 && type <= 0x0f) {
    put_integer(out, chance(random, 0.7) ? below(random, 24) : edge(random));
    if (type & 0x04) number();
    if (type & 0x02) sized();
    return out;
  }
  switch (type) {
    case 0x02:
    case 0x03: {
      const std::uint64_t largest = below(random, 64);
      put_integer(out, chance(random, 0.8) ? largest : edge(random));
      number();
      const std::uint64_t ranges = below(random, 4);
      put_integer(out, chance(random, 0.9) ? ranges : edge(random));
      put_integer(out, chance(random, 0.8) ? below(random, largest + 1) : edge(random));
      for (std::uint64_t i = 0; i < 2 * ranges; ++i)
        put_integer(out, chance(random, 0.8) ? below(random, 4) : edge(random));
      if (type == 0x03)
        for (int i = 0; i < 3; ++i) number();
      break;
    }
    case 0x04:
      put_integer(out, below(random, 24)), number(), number();
      break;
    case 0x05:
    case 0x11:
    case 0x15:
      put_integer(out, below(random, 24)), number();
      break;
    case 0x06:
      number(), sized();
      break;
    case 0x07:
    case 0x31:
      sized();
      break;
    case 0x18: {
      const std::uint64_t sequence = chance(random, 0.8) ? below(random, 24) : edge(random);
      const std::uint64_t prior = chance(random, 0.6) ? 0 : below(random, sequence + 2);
      out = new_connection_id(sequence, prior, static_cast<std::uint8_t>(below(random, 3)));
      break;
    }
    case 0x19:
      put_integer(out, chance(random, 0.9) ? below(random, 10) : edge(random));
      break;
    case 0x1a:
    case 0x1b:
      put_bytes(out, random, 8);
      break;
    case 0x1c:
      number(), number(), sized();
      break;
    case 0x1d:
      number(), sized();
      break;
    case 0x10:
    case 0x12:
    case 0x13:
    case 0x14:
    case 0x16:
    case 0x17:
      number();
      break;
    default:
      put_bytes(out, random, below(random, 8));
  }
  return out;
}

/// A frame that any peer may send at any time, in an order and number that none does.
Bytes fair_frame(Random& random) {
  Bytes out;
  switch (below(random, 8)) {
    case 0:
      return {0x01};
    case 1:
      out = {static_cast<std::uint8_t>(0x10 + 2 * below(random, 2))};  // MAX_DATA, MAX_STREAMS
      put_integer(out, below(random, 1000));
      return out;
    case 2:
      return new_connection_id(1 + below(random, 8), 0);
    case 3:
      out = {static_cast<std::uint8_t>(0x1a + below(random, 2))};
      put_bytes(out, random, 8);
      return out;
    case 4:
      out = {0x19};
      put_integer(out, below(random, 4));
      return out;
    case 5:
      out = {0x31, 3, 1, 2, 3};
      return out;
    case 6:
      out = {0x0a, 0x04, 2, 7, 7};  // STREAM
      return out;
    default:
      return {0x00, 0x00, 0x00};
  }
}

/// What closes a connection at once makes for short stories: most of the time it is left out.
Bytes odd_frames(Random& random) {
  Bytes all;
  const bool fair = chance(random, 0.8);
  for (std::uint64_t i = 1 + below(random, 6); i > 0; --i) {
    Bytes frame = fair ? fair_frame(random) : odd_frame(random);
    if ((frame[0] == 0x1c || frame[0] == 0x1d) && !chance(random, 0.05)) continue;
    all.insert(all.end(), frame.begin(), frame.end());
  }
  if (all.size() > 900) all.resize(900);
  return all;
}

struct Counts {
  std::uint64_t rewritten = 0;
  std::uint64_t frames_sent = 0;
  std::uint64_t moves = 0;
  std::uint64_t ends = 0;
  std::uint64_t opened = 0;
};

/// Rewrites packets on their way: `wild` is the share of those that are.
CraftedEnd::Rewrite rewriter(Random& random, double wild, Counts& counts) {
  return [&random, wild, &counts](std::uint8_t, std::span<std::uint8_t> payload) {
    if (payload.empty() || !chance(random, wild)) return;
    ++counts.rewritten;
    switch (below(random, 4)) {
      case 0:
        for (std::uint64_t i = 1 + below(random, 4); i > 0; --i)
          payload[below(random, payload.size())] ^= static_cast<std::uint8_t>(1u << below(random, 8));
        break;
      case 1: {
        const Bytes frames = odd_frames(random);
        const std::size_t at = below(random, payload.size());
        std::copy_n(frames.begin(), std::min(frames.size(), payload.size() - at),
                    payload.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      }
      case 2:
        for (std::uint8_t& byte : payload.subspan(below(random, payload.size())))
          byte = static_cast<std::uint8_t>(random());
        break;
      default: {
        const std::size_t from = below(random, payload.size()), to = below(random, payload.size());
        const std::size_t size = std::min(payload.size() - std::max(from, to), std::size_t{40});
        std::memmove(&payload[to], &payload[from], size);
      }
    }
  };
}

double how_wild(Random& random) {
  static constexpr double kShares[] = {0.0, 0.0, 0.0, 0.02, 0.1, 0.5};
  return kShares[below(random, std::size(kShares))];
}

/// Something that `end` does now.
void act(CraftedEnd& end, Random& random, Counts& counts) {
  if (!end.open() || end.over()) return;
  switch (below(random, 8)) {
    case 0:
    case 1:
    case 2:
    case 3:
      counts.frames_sent += end.send_frames(odd_frames(random)) ? 1 : 0;
      break;
    case 4:
      end.send_datagram(Bytes(1 + below(random, 300), 7));
      break;
    case 5:
    case 6: {
      const std::size_t other = below(random, 4);
      while (end.sockets() <= other) end.add_socket();
      end.use_socket(other);
      end.send_datagram({1});
      ++counts.moves;
      break;
    }
    default: {
      const std::size_t other = below(random, 4);
      while (end.sockets() <= other) end.add_socket();
      if (!end.is_host() && end.migrate_to(other)) ++counts.moves;
    }
  }
}

/// Clients that keep no rules at a host of ours.
class HostUnderStorm {
 public:
  HostUnderStorm(Random& random, Counts& counts) : random_(random), counts_(counts) {
    EndpointOptions options;
    options.max_connections = 24;
    options.max_strangers = 20;
    options.handshakes_per_second = options.handshakes_in_all = 1e6;
    options.handshake_timeout = 2.0;
    pair_.emplace(options);
    pair_->establish();
    pair_->host->admit(pair_->at_host());
  }
  bool turn() {
    if (clients_.size() < 8) {
      clients_.push_back(CraftedEnd::client(pair_->host->local_address(), "127.0.0.1:0",
                                            rewriter(random_, how_wild(random_), counts_)));
      ++counts_.ends;
    }
    pair_->host->run_once(0);
    pair_->peer->run_once(0);
    for (auto& client : clients_) {
      const bool was = client->open();
      client->turn();
      counts_.opened += !was && client->open() ? 1 : 0;
      if (chance(random_, 0.3)) act(*client, random_, counts_);
    }
    std::erase_if(clients_, [&](const auto& client) {
      return client->over() || chance(random_, client->open() ? 0.002 : 0.0005);
    });
    Recorder& told = pair_->host_events;
    if (told.datagrams.size() > 1000) told.datagrams.clear();
    if (told.streams.size() > 16) told.streams.clear(), told.ended.clear();
    for (auto& [id, bytes] : told.streams)
      if (bytes.size() > 1 << 16) bytes.clear();
    return pair_->peer_events.closed.empty();
  }
  /// Whether a datagram still gets to the bystander and a packet of theirs back.
  bool well() {
    const std::size_t had = pair_->peer_events.datagrams.size();
    pair_->host->send_datagram(pair_->host_events.connected.front(), Priority::kState, shared({1}));
    return pair_->run([&] { return pair_->peer_events.datagrams.size() > had; });
  }
  const char* who() const { return "host"; }

 private:
  Random& random_;
  Counts& counts_;
  std::optional<Pair> pair_;
  std::vector<std::unique_ptr<CraftedEnd>> clients_;
};

/// A peer of ours at hosts that keep no rules.
class PeersUnderStorm {
 public:
  PeersUnderStorm(Random& random, Counts& counts)
      : random_(random), counts_(counts), identity_(Identity::generate()), peer_key_(Identity::generate()) {}
  bool turn() {
    if (links_.size() < 4) {
      auto link = std::make_unique<Link>();
      link->host = CraftedEnd::host(identity_, rewriter(random_, how_wild(random_), counts_));
      EndpointOptions options;
      options.handshake_timeout = 2.0;
      link->peer = std::move(
          connect_quic({link->host->address()}, identity_.fingerprint(), peer_key_, link->events, options)
              .value());
      links_.push_back(std::move(link));
      ++counts_.ends;
    }
    for (auto& link : links_) {
      const bool was = link->host->open();
      link->peer->run_once(0);
      link->host->turn();
      counts_.opened += !was && link->host->open() ? 1 : 0;
      if (chance(random_, 0.3)) act(*link->host, random_, counts_);
      if (chance(random_, 0.05) && !link->events.connected.empty())
        link->peer->send_datagram(1, Priority::kPose, shared({1, 2, 3}));
    }
    std::erase_if(links_, [&](const auto& link) {
      return !link->events.closed.empty() || link->host->over() || chance(random_, 0.001);
    });
    return true;
  }
  bool well() { return true; }  // it is alive: that is all there is to say
  const char* who() const { return "peer"; }

 private:
  struct Link {
    std::unique_ptr<CraftedEnd> host;
    Recorder events;
    std::unique_ptr<Endpoint> peer;
  };
  Random& random_;
  Counts& counts_;
  Identity identity_;
  Identity peer_key_;
  std::vector<std::unique_ptr<Link>> links_;
};

template <class Storm>
int run(double seconds, std::uint64_t seed) {
  Random random(seed);
  Counts counts;
  Storm storm(random, counts);
  const std::int64_t start = steady_now_ns(), end = start + to_nanoseconds(seconds);
  std::int64_t look = start;
  while (steady_now_ns() < end) {
    const bool due = steady_now_ns() >= look;
    if (!storm.turn() || (due && !storm.well())) {
      std::fprintf(stderr, "quic_storm: seed %llu: the %s lost its bystander\n",
                   static_cast<unsigned long long>(seed), storm.who());
      return 1;
    }
    if (due) look = steady_now_ns() + kNanosecondsPerSecond / 2;
  }
  std::printf(
      "%s, seed %llu, %.0f s: %llu ends, %llu handshakes finished, %llu packets rewritten, %llu of frames, "
      "%llu moves\n",
      storm.who(), static_cast<unsigned long long>(seed), seconds,
      static_cast<unsigned long long>(counts.ends), static_cast<unsigned long long>(counts.opened),
      static_cast<unsigned long long>(counts.rewritten), static_cast<unsigned long long>(counts.frames_sent),
      static_cast<unsigned long long>(counts.moves));
  return counts.opened > 0 ? 0 : 1;
}

}  // namespace
}  // namespace slosh::testing

int main(int argc, char** argv) {
  constexpr char kUsage[] =
      "quic_storm [host|peer] [--seconds S] [--seed N]\n"
      "  host    clients that keep no rules at a host of ours (what it is without a word)\n"
      "  peer    a peer of ours at hosts that keep no rules\n"
      "Ends with 0 when the end of ours lived and its bystander was served to the end.\n";
  bool peer = false;
  double seconds = 10.0;
  std::uint64_t seed = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool more = i + 1 < argc;
    if (word == "peer" || word == "host") {
      peer = word == "peer";
    } else if (word == "--seconds" && more && std::atof(argv[i + 1]) > 0.0) {
      seconds = std::atof(argv[++i]);
    } else if (word == "--seed" && more) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else {
      std::fputs(kUsage, word == "--help" ? stdout : stderr);
      return word == "--help" ? 0 : 2;
    }
  }
  using namespace slosh::testing;
  return peer ? run<PeersUnderStorm>(seconds, seed) : run<HostUnderStorm>(seconds, seed);
}
