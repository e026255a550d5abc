#include <cmath>
#include <cstdio>
#include <cstring>

#include "host/keep/recording_format.h"
#include "net/wire/scene_package.h"

namespace slosh::keep {
namespace {

/// Takes one message off the front.
template <class M>
wire::Fault take(ByteView& in, M& message) {
  wire::Reader reader(in);
  visit(reader, message);
  in = in.subspan(in.size() - reader.left());
  return reader.fault();
}

}  // namespace

Result<std::unique_ptr<RecordingReader>> RecordingReader::open(const std::filesystem::path& path) {
  Result<File> file = open_to_read(path);
  if (!file) return file.error();
  Result<std::unique_ptr<RecordingReader>> reader = open(file.value().get(), path.string());
  if (reader) reader.value()->owned_ = std::move(file.value());
  return reader;
}

Result<std::unique_ptr<RecordingReader>> RecordingReader::open(std::FILE* file, const std::string& name) {
  char magic[sizeof kRecordingMagic];
  std::uint32_t version = 0;
  if (std::fread(magic, 1, sizeof magic, file) != sizeof magic ||
      std::memcmp(magic, kRecordingMagic, sizeof magic) != 0 ||
      std::fread(&version, 1, sizeof version, file) != sizeof version) {
    return Error{name, "is not a recording of slosh", "Give the file that --record wrote"};
  }
  if (version != kRecordingVersion)
    return Error{name,
                 "is a recording of version " + std::to_string(version) + ", and this program reads " +
                     std::to_string(kRecordingVersion),
                 "Replay it with the version of slosh that wrote it"};
  std::unique_ptr<RecordingReader> reader(new RecordingReader(file, name));
  const Result<bool> read = reader->read_head();
  if (!read) return read.error();
  return reader;
}

Error RecordingReader::damaged(const std::string& what) const {
  std::string mend = "Nothing of it can be replayed";
  if (steps_ > 0) {
    // A quarter of a step less than what is there: no rounding then leads to what follows.
    char text[120];
    std::snprintf(text, sizeof text, "What comes before is whole: replay it with --seconds %.9g",
                  head_.time_step * (static_cast<double>(steps_) - 0.25));
    mend = text;
  }
  return {name_,
          "this recording is damaged in the chunk at byte " + std::to_string(chunks_.at()) + ": " + what,
          mend};
}

Result<bool> RecordingReader::read_head() {
  for (const std::uint8_t wanted : {kHeadChunk, kSceneChunk, kStartChunk, kStateChunk}) {
    const ChunkOutcome outcome = chunks_.next(chunk_);
    if (outcome == ChunkOutcome::kDamaged) return damaged(chunks_.problem());
    if (outcome != ChunkOutcome::kChunk)
      return Error{name_, "this recording is cut off before its first state", "There is nothing to replay"};
    if (chunk_.type != wanted) return damaged("another kind of chunk belongs here");
    ByteView content = chunk_.content;
    if (wanted == kHeadChunk) {
      HeadRecord head;
      if (const wire::Fault fault = wire::decode(content, head)) return damaged(fault.text());
      head_.time_step = head.time_step;
      head_.version = head.version;
      head_.backend = head.backend;
      head_.state = head.state;
    } else if (wanted == kSceneChunk) {
      Result<UnpackedScene> scene = unpack_scene(content);
      if (!scene) return damaged(scene.error().text());
      head_.scene = std::move(scene.value().scene);
      head_.spacing = scene.value().spacing;
    } else if (wanted == kStartChunk) {
      head_.start = chunk_.content;
    } else {
      PlaceRecord place;
      if (const wire::Fault fault = take(content, place)) return damaged(fault.text());
      head_.world.assign(content.begin(), content.end());
      if (head_.start.empty()) head_.start = head_.world;
      tick_ = place.tick;
      run_ = place.run;
    }
  }
  const std::size_t viscosities = head_.state.viscosities.size();
  if (viscosities != 0 && viscosities != head_.scene.fluids.size())
    return damaged("it has another number of viscosities than of fluids");
  hands_ = HandCoder(head_.scene.grips.size());
  for (std::size_t b = 0; b < head_.scene.bodies.size(); ++b) {
    if (moves(head_.scene.bodies[b].motion)) free_bodies_.push_back(static_cast<std::uint32_t>(b));
  }
  return true;
}

Result<const RecordingEvent*> RecordingReader::next() {
  while (left_.empty()) {
    if (over_) return nullptr;
    const Result<bool> more = next_chunk();
    if (!more) return more.error();
    if (more.value()) return &event_;
  }
  const Result<bool> read = read_event();
  if (!read) {
    over_ = true;
    left_ = {};
    return read.error();
  }
  return &event_;
}

// True when the chunk was an event by itself, which is then in event_.
Result<bool> RecordingReader::next_chunk() {
  const ChunkOutcome outcome = chunks_.next(chunk_);
  if (outcome == ChunkOutcome::kEnd || outcome == ChunkOutcome::kCutOff) {
    over_ = true;
    return false;
  }
  over_ = true;  // unless all that follows is well
  if (outcome == ChunkOutcome::kDamaged) return damaged(chunks_.problem());
  ByteView content = chunk_.content;
  if (chunk_.type == kEndChunk) {
    if (const wire::Fault fault = wire::decode(content, event_.totals)) return damaged(fault.text());
    if (!chunks_.at_end()) return damaged("it is the recording's last, and something follows it");
    event_.kind = RecordingEvent::Kind::kEnd;
    complete_ = true;
    return true;
  }
  if (chunk_.type != kEventsChunk && chunk_.type != kStateChunk)
    return damaged("another kind of chunk belongs here");
  PlaceRecord place;
  if (const wire::Fault fault = take(content, place)) return damaged(fault.text());
  over_ = false;
  if (chunk_.type == kStateChunk) {
    if (place.tick != tick_ || place.run != run_)
      return damaged("its state is of another tick than comes next");
    event_.kind = RecordingEvent::Kind::kState;
    event_.tick = tick_;
    event_.run = run_;
    event_.state.assign(content.begin(), content.end());
    hands_.restart();
    return true;
  }
  // A reset leads elsewhere; else the steps go on where they were.
  if (place.run == run_ && place.tick != tick_) return damaged("its steps do not follow those before");
  tick_ = event_.tick = place.tick;
  run_ = event_.run = place.run;
  left_ = content;
  return false;
}

Result<bool> RecordingReader::read_event() {
  const std::uint8_t tag = left_.front();
  left_ = left_.subspan(1);
  event_.run = run_;
  switch (tag) {
    case kStepExpected:
    case kStepHands:
      if (tag == kStepExpected) {
        hands_.expected(event_.hands);
      } else if (!hands_.decode(left_, event_.hands)) {
        return damaged("a step's hands cannot be read");
      }
      event_.kind = RecordingEvent::Kind::kStep;
      tick_ += 1;
      steps_ += 1;
      break;
    case kBodiesTag:
      event_.kind = RecordingEvent::Kind::kBodies;
      event_.bodies.resize(free_bodies_.size());
      for (std::size_t i = 0; i < free_bodies_.size(); ++i) {
        event_.bodies[i].body = free_bodies_[i];
        if (const wire::Fault fault = take(left_, event_.bodies[i])) return damaged(fault.text());
      }
      break;
    case kHashTag:
      if (left_.size() < 8) return damaged("a hash is cut short");
      event_.kind = RecordingEvent::Kind::kHash;
      std::memcpy(&event_.hash, left_.data(), 8);
      left_ = left_.subspan(8);
      break;
    case kChangeTag: {
      ChangeRecord change;
      if (const wire::Fault fault = take(left_, change)) return damaged(fault.text());
      event_.kind = RecordingEvent::Kind::kChange;
      event_.change = change.command;
      break;
    }
    default:
      return damaged("it holds something that this program does not know");
  }
  event_.tick = tick_;
  return true;
}

}  // namespace slosh::keep
