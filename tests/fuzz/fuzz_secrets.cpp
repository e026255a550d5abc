// A host's secrets: as a file, behind its checksums, and the server's state in them.
#include <cstdio>

#include "host/keep/file.h"
#include "host/keep/secrets.h"
#include "host/server/server_state.h"
#include "tests/fuzz/fixed_chunks.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"

using namespace slosh;
using namespace slosh::keep;
using test::append_stored;
using test::fix_chunks;

namespace {

enum Mode : std::uint8_t { kFile, kFixed, kState, kModes };
constexpr std::size_t kMagicBytes = 8;

/// What a host that carries on does with it.
void carry_on(ByteView bytes) {
  ServerState state;
  if (const wire::Fault fault = wire::decode(bytes, state)) {
    test::must(!fault.text().empty(), "a fault has words");
    return;
  }
  const wire::Bytes once = wire::encoded(state);
  ServerState again;
  test::must(!wire::decode(once, again) && wire::encoded(again) == once, "what was read can be kept");
  LinkRegistry links;
  links.restore(state.links);
  for (const LinkRecord& link : state.links) {
    const LinkVerdict verdict = links.check(link.token, {}, 1);
    test::must(verdict.link != nullptr || !verdict.text.empty(), "a link is good, or refused in words");
  }
  SeatTable seats({"left", "right"}, {});
  seats.restore(state.seats, 1);
  for (const auto& [number, seat] : seats.seats()) {
    test::must(seat.grips.empty() || may_hold(seat.role), "who looks on holds nothing");
    for (const std::uint32_t grip : seat.grips)
      test::must(seats.holder(grip) == &seat, "a grip has one holder");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  Bytes bytes(data + 1, data + size);
  const auto mode = static_cast<Mode>(data[0] % kModes);
  if (mode == kState) {
    carry_on(bytes);
    return 0;
  }
  if (mode == kFixed) fix_chunks(bytes, kMagicBytes);
  const File file(fmemopen(bytes.data(), bytes.size(), "rb"));
  const Result<Secrets> read = read_secrets_file(file.get(), "input");
  if (read)
    carry_on(read.value().server_state);
  else
    test::must(!read.error().what.empty(), "an error has words");
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  KeyFingerprint key{};
  key.fill(9);
  ServerState state;
  state.private_key = Bytes(48, 7);
  state.world = 5;
  state.port = 4433;
  for (const LinkRole role : {LinkRole::kHold, LinkRole::kWatch, LinkRole::kRun}) {
    // The same every time, which what the kernel gives is not.
    LinkRecord link{"bak" + std::to_string(static_cast<int>(role)), {}, role, "Ana", 1, 0, false, {key}};
    link.token.fill(static_cast<std::uint8_t>(role));
    state.links.push_back(link);
  }
  state.seats = {{0, key, "Ana", LinkRole::kRun, {0, 1}, "bak0"},
                 {1, {}, "Ben", LinkRole::kWatch, {}, "bak1"}};
  state.bans = {{key, "Eve", 100}};
  const Bytes server = wire::encoded(state);
  Bytes file{'S', 'L', 'O', 'S', 'H', 'K', 'E', 'Y'};
  Bytes head{1};
  head.resize(9);
  append_stored(1, head, file);
  append_stored(2, server, file);
  append_stored(3, {}, file);
  fix_chunks(file, kMagicBytes);
  std::vector<Bytes> seeds{file, file, server};
  for (std::uint8_t mode = 0; mode < kModes; ++mode) seeds[mode].insert(seeds[mode].begin(), mode);
  return seeds;
}
