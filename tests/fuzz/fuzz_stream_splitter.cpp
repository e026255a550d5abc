// A control stream, cut into pieces as its first byte says: the same messages and the same fault come out as
// when it comes whole.
#include <algorithm>

#include "net/wire/stream_splitter.h"
#include "tests/fuzz/messages.h"
#include "tests/fuzz/seeds.h"

using namespace slosh;

namespace {

struct Received {
  std::size_t messages = 0;
  std::size_t bytes = 0;
  std::uint64_t types = 0;
  std::string end;
  bool operator==(const Received&) const = default;
};

Received receive(wire::ByteView stream, std::size_t piece) {
  wire::StreamSplitter splitter;
  Received received;
  const auto each = [&](std::uint64_t type, wire::ByteView payload) {
    received.messages += 1;
    received.bytes += payload.size();
    received.types = 31 * received.types + type;
    test::take(wire::PeerControl{}, type, payload);
    return type == 255 ? wire::Fault{"type", "unwanted"} : wire::Fault{};
  };
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    splitter.feed(stream.subspan(at, std::min(piece, stream.size() - at)), each);
    test::must(splitter.held() <= wire::kMaxControlMessage + 8, "no more than one message is kept");
    test::must(splitter.held() <= at + piece, "and no more than came");
  }
  received.end = splitter.finish().text();
  return received;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const wire::ByteView stream(data + 1, size - 1);
  const std::size_t piece = 1 + data[0] % 64;
  test::must(receive(stream, piece) == receive(stream, std::max<std::size_t>(stream.size(), 1)),
             "pieces make no difference");
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  std::vector<std::vector<std::uint8_t>> seeds;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    std::vector<std::uint8_t> stream{static_cast<std::uint8_t>(7 * seed)};
    wire::for_each_message(wire::PeerControl{}, [&]<class M>(const M&) {
      const wire::Bytes bytes = wire::control(wire::random_message<M>(seed));
      stream.insert(stream.end(), bytes.begin(), bytes.end());
    });
    seeds.push_back(stream);
  }
  return seeds;
}
