// The payload of every control message: type byte, payload.
#include "tests/fuzz/messages.h"
#include "tests/fuzz/seeds.h"

using namespace slosh;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const wire::ByteView payload(data + 1, size - 1);
  test::take(wire::PeerControl{}, data[0], payload);
  test::take(wire::HostControl{}, data[0], payload);
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  std::vector<std::vector<std::uint8_t>> seeds;
  const auto add = [&]<class M>(const M&) {
    for (std::uint64_t seed = 0; seed < 8; ++seed)
      seeds.push_back(wire::datagram(wire::random_message<M>(seed)));  // a type byte and the payload
  };
  wire::for_each_message(wire::PeerControl{}, add);
  wire::for_each_message(wire::HostControl{}, add);
  return seeds;
}
