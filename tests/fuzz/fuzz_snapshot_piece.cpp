// Any bytes as snapshot pieces: the input is a sequence of datagrams, each behind its length in two bytes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "net/codec/snapshot_codec.h"
#include "tests/fuzz/seeds.h"
#include "tests/net/codec/codec_kit.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  slosh::SnapshotDecoder decoder;
  std::span<const std::uint8_t> left(data, size);
  while (left.size() >= 2) {
    const std::size_t wanted = left[0] | static_cast<std::size_t>(left[1]) << 8;
    left = left.subspan(2);
    const std::size_t length = wanted < left.size() ? wanted : left.size();
    decoder.take(left.first(length));
    left = left.subspan(length);
    while (const auto frame = decoder.next()) {
      if (frame->positions.size() != frame->fluid_index.size() || frame->complete > 1.0) std::abort();
    }
    if (decoder.feedback().missing.size() > 256) std::abort();
  }
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  std::vector<std::vector<std::uint8_t>> seeds;
  for (const bool with_mending : {false, true}) {
    slosh::CodecOptions options;
    options.shell_only = with_mending;
    slosh::SnapshotEncoder encoder(options);
    std::vector<std::uint8_t> seed;
    const auto add = [&](const slosh::Piece& piece) {
      seed.push_back(static_cast<std::uint8_t>(piece.bytes->size()));
      seed.push_back(static_cast<std::uint8_t>(piece.bytes->size() >> 8));
      seed.insert(seed.end(), piece.bytes->begin(), piece.bytes->end());
    };
    for (int frame = 0; frame < 8; ++frame) {
      slosh::Snapshot world = slosh::codec_kit::swirl(140, frame);
      world.shell.assign(140, 1);
      for (std::size_t i = 0; frame < 2 && i < 70; ++i) world.shell[i] = 0;  // the rest comes later
      for (const slosh::Piece& piece : encoder.encode(world, 0).pieces) add(piece);
      std::vector<slosh::Piece> mended;
      const slosh::wire::BlockRange all{0, 4};
      if (with_mending) encoder.mend({&all, 1}, mended);
      for (const slosh::Piece& piece : mended) add(piece);
    }
    seeds.push_back(seed);
  }
  return seeds;
}
