// A link that snapshots fill: states pass them, and do not stand behind them in a router.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#include "tests/net/quic/virtual_link.h"

namespace slosh::testing {
namespace {

constexpr std::size_t kPieceBytes = 1100;  // of a snapshot
constexpr std::size_t kPieces = 25;        // a snapshot, 60 a second: 1.65 MB/s are offered
constexpr std::size_t kStateBytes = 150;   // 250 a second

/// What came down of `seconds` after `warm_up`.
struct Came {
  double age_p50 = 0.0, age_p99 = 0.0, age_most = 0.0;  ///< s, of states
  double states = 0.0;                                  ///< share of what was sent
  double pieces = 0.0;                                  ///< bytes a second
  double least_pieces = 0.0;                            ///< bytes in the worst second
};

Bytes stamped(std::int64_t now_ns, std::size_t size) {
  Bytes bytes(size, 1);
  std::memcpy(bytes.data(), &now_ns, sizeof(now_ns));
  return bytes;
}

Came flow(VirtualLink& link, double warm_up, double seconds) {
  std::vector<double> ages;
  std::vector<double> pieces(1, 0.0);  // bytes, one a second
  std::size_t states = 0;
  std::uint64_t offered = 0;
  const int begin = static_cast<int>(2000.0 * warm_up), end = begin + static_cast<int>(2000.0 * seconds);
  for (int i = 0; i < end; ++i) {
    if (i % 33 == 0) {
      // As the host does: what has no room yet is not piled up.
      const ConnectionStats stats = link.host->stats(link.at_host());
      if (offered <= stats.datagrams_sent[2] + stats.datagrams_dropped[2] + kPieces) {
        for (std::size_t piece = 0; piece < kPieces; ++piece, ++offered)
          link.host->send_datagram(link.at_host(), Priority::kSnapshot,
                                   shared(stamped(link.now_ns, kPieceBytes)));
      }
    }
    if (i % 8 == 0) {
      link.host->send_datagram(link.at_host(), Priority::kState, shared(stamped(link.now_ns, kStateBytes)));
      states += i >= begin ? 1 : 0;
    }
    link.step();
    for (const Bytes& datagram : link.peer_events.datagrams) {
      std::int64_t sent_ns = 0;
      std::memcpy(&sent_ns, datagram.data(), sizeof(sent_ns));
      if (i < begin) continue;
      if (datagram.size() == kStateBytes)
        ages.push_back(to_seconds(link.now_ns - sent_ns));
      else
        pieces.back() += static_cast<double>(datagram.size());
    }
    link.peer_events.datagrams.clear();
    if (i > begin && (i - begin) % 2000 == 0) pieces.push_back(0.0);
  }
  Came came;
  if (ages.empty() || states == 0) return came;
  std::sort(ages.begin(), ages.end());
  came.age_p50 = ages[ages.size() / 2];
  came.age_p99 = ages[ages.size() * 99 / 100];
  came.age_most = ages.back();
  came.states = static_cast<double>(ages.size()) / static_cast<double>(states);
  for (const double bytes : pieces) came.pieces += bytes / seconds;
  came.least_pieces = *std::min_element(pieces.begin(), pieces.end());
  std::printf(
      "states: %.2f %% came, age p50 %.0f, p99 %.0f, most %.0f ms; snapshots %.0f kB/s, worst second %.0f "
      "kB\n",
      1e2 * came.states, 1e3 * came.age_p50, 1e3 * came.age_p99, 1e3 * came.age_most, 1e-3 * came.pieces,
      1e-3 * came.least_pieces);
  return came;
}

struct Link {
  const char* name;
  double queue;    // bytes
  double delay;    // s, each way
  double age_p99;  // s, at most
  double states;   // share, at least
};

class FullLink : public ::testing::TestWithParam<Link> {};

// Bounds are a fifth above what was reached. With room for snapshots by the library's rate, and a queue that
// was never let run empty, states were 123, 107 and 140 ms old, and 11, 9 and 6 % of them were dropped by a
// short queue; as many snapshots came.
TEST_P(FullLink, StatesDoNotGrowOldBehindSnapshots) {
  Impairment down, up;
  up.delay = down.delay = GetParam().delay;
  down.rate = 1e6;
  down.queue = GetParam().queue;
  VirtualLink link(up, down);
  ASSERT_TRUE(link.connect());
  const Came came = flow(link, 3.0, 30.0);
  EXPECT_LE(came.age_p99, GetParam().age_p99);
  EXPECT_GE(came.states, GetParam().states);
  EXPECT_GE(came.pieces, 850e3) << "the link is used";
  EXPECT_GE(came.least_pieces, 700e3) << "and never stands";
}

INSTANTIATE_TEST_SUITE_P(OneMegabyteASecond, FullLink,
                         ::testing::Values(Link{"Deep5ms", 200e3, 0.005, 0.025, 0.999},
                                           Link{"Deep20ms", 200e3, 0.02, 0.055, 0.999},
                                           Link{"Deep50ms", 200e3, 0.05, 0.125, 0.999},
                                           Link{"Short5ms", 20e3, 0.005, 0.025, 0.999},
                                           Link{"Short20ms", 20e3, 0.02, 0.045, 0.98},
                                           Link{"Short50ms", 20e3, 0.05, 0.075, 0.93}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace slosh::testing
