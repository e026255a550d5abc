// Every datagram but the snapshot piece, which has a target of its own.
#include "tests/fuzz/messages.h"
#include "tests/fuzz/seeds.h"

using namespace slosh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const wire::ByteView datagram(data, size);
  const auto check = [](const auto& message) { test::check_decoded(message); };
  const wire::Fault up = wire::dispatch_datagram(wire::PeerDatagrams{}, datagram, check);
  const wire::Fault down = wire::dispatch_datagram(wire::HostDatagrams{}, datagram, check);
  test::must(up || down, "no datagram goes both ways");
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  std::vector<std::vector<std::uint8_t>> seeds;
  const auto add = [&]<class M>(const M&) {
    for (std::uint64_t seed = 0; seed < 8; ++seed)
      seeds.push_back(wire::datagram(wire::random_message<M>(seed)));
  };
  wire::for_each_message(wire::PeerDatagrams{}, add);
  wire::for_each_message(wire::HostDatagrams{}, add);
  return seeds;
}
