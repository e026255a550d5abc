// A recording: as a file, behind its checksums, and its events, states and end.
#include <cstdio>

#include "host/keep/recording_format.h"
#include "net/wire/scene_package.h"
#include "tests/fuzz/fixed_chunks.h"
#include "tests/fuzz/must.h"
#include "tests/fuzz/seeds.h"
#include "tests/support/small_scene.h"

using namespace slosh;
using namespace slosh::keep;

namespace {

// The first byte of an input says what the rest is.
enum Mode : std::uint8_t { kFile, kEvents, kState, kEnd, kFixed, kModes };

constexpr std::size_t kHeadBytes = 12;  // the magic and the format, before the first chunk

Bytes beginning() {
  const Scene scene = test::small_scene();
  Bytes out(std::begin(kRecordingMagic), std::end(kRecordingMagic));
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(kRecordingVersion >> (8 * i)));
  HeadRecord head{0.002, "fuzz", "cpu", {}};
  for (const Fluid& fluid : scene.fluids) head.state.viscosities.push_back(fluid.dynamic_viscosity);
  append_chunk(kHeadChunk, wire::encoded(head), out);
  append_chunk(kSceneChunk, pack_scene(scene, 0.01, SceneParts::kAll).value(), out);
  append_chunk(kStartChunk, {}, out);
  append_chunk(kStateChunk, wire::encoded(PlaceRecord{}), out);
  return out;
}

Bytes some_events() {
  const std::size_t grips = test::small_scene().grips.size();
  Bytes events;
  wire::encode(PlaceRecord{0, 0}, events);
  HandCoder coder(grips);
  std::vector<HandleInput> hands(grips);
  for (int i = 0; i < 5; ++i) {
    for (HandleInput& hand : hands) {
      hand.engaged = true;
      hand.pose.position.x = 0.1 * i;
    }
    events.push_back(kStepHands);
    coder.encode(hands, events);
    events.push_back(kStepExpected);
    std::vector<HandleInput> expected;
    coder.expected(expected);
  }
  events.push_back(kHashTag);
  for (int i = 0; i < 8; ++i) events.push_back(static_cast<std::uint8_t>(i));
  events.push_back(kChangeTag);
  wire::encode(ChangeRecord{{HostAction::kViscosity, 0, 0.1}}, events);
  return events;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  static const Bytes kBeginning = beginning();
  const ByteView rest(data + 1, size - 1);
  Bytes bytes;
  switch (data[0] % kModes) {
    case kFile:
      bytes.assign(rest.begin(), rest.end());
      break;
    case kFixed:
      bytes.assign(rest.begin(), rest.end());
      test::fix_chunks(bytes, kHeadBytes);
      break;
    case kEvents:
      bytes = kBeginning;
      append_chunk(kEventsChunk, rest, bytes);
      break;
    case kState:
      bytes = kBeginning;
      append_chunk(kStateChunk, rest, bytes);
      break;
    default:
      bytes = kBeginning;
      append_chunk(kEndChunk, rest, bytes);
  }
  const File file(fmemopen(bytes.data(), bytes.size(), "rb"));
  auto reader = RecordingReader::open(file.get(), "input");
  if (!reader) {
    test::must(!reader.error().what.empty(), "an error has words");
    return 0;
  }
  // An event takes a byte at least, a chunk as many as its head.
  std::size_t events = 0;
  while (true) {
    const Result<const RecordingEvent*> event = reader.value()->next();
    if (!event || event.value() == nullptr) break;
    test::must(++events <= kMaxExpansion * bytes.size(), "no more events than bytes");
    if (event.value()->kind != RecordingEvent::Kind::kStep) continue;
    test::must(event.value()->hands.size() == reader.value()->head().scene.grips.size(), "a hand a grip");
  }
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  const Bytes events = some_events();
  Bytes file = beginning();
  append_chunk(kEventsChunk, events, file);
  append_chunk(kEndChunk, wire::encoded(RecordingTotals{10, 1, 1, 0, ""}), file);
  Bytes stored(file.begin(), file.begin() + kHeadBytes);
  {
    const File packed(fmemopen(file.data(), file.size(), "rb"));
    std::fseek(packed.get(), kHeadBytes, SEEK_SET);
    ChunkReader reader(packed.get());
    for (Chunk chunk; reader.next(chunk) == ChunkOutcome::kChunk;)
      test::append_stored(chunk.type, chunk.content, stored);
  }
  test::fix_chunks(stored, kHeadBytes);
  std::vector<Bytes> seeds{file, events, wire::encoded(PlaceRecord{}), wire::encoded(RecordingTotals{}),
                           stored};
  for (std::uint8_t mode = 0; mode < kModes; ++mode) seeds[mode].insert(seeds[mode].begin(), mode);
  return seeds;
}
