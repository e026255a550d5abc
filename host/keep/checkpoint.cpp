#include "host/keep/checkpoint.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>

#include "host/keep/file.h"
#include "net/clock.h"
#include "net/wire/scene_package.h"

namespace slosh::keep {
namespace {

constexpr char kMagic[8] = {'S', 'L', 'O', 'S', 'H', 'C', 'P', '\n'};
constexpr std::uint32_t kVersion = 1;

// In this order, each once.
enum Part : std::uint8_t { kScene = 1, kStart, kHead, kWorld, kSession, kEnd };

struct FileHead {
  std::uint32_t version = kVersion;
  HostState state;
  std::uint64_t tick = 0;
  double time = 0.0;
  std::string program;
};
template <class V>
void visit(V& v, FileHead& m) {
  v.natural("version", m.version, kVersion, kVersion);
  v.flag("paused", m.state.paused);
  v.natural("run", m.state.run, 0, 0xffffffff);
  v.natural("tick", m.tick, 0, wire::kMaxTick);
  v.real64("time", m.time, 0.0, 1e12);
  v.text("program", m.program, 64);
}

Bytes head_bytes(const Checkpoint& c) {
  FileHead head{kVersion, c.state, c.tick, c.time, c.version.substr(0, 64)};
  return wire::encoded(head);
}

Error damaged(const std::string& name, const std::string& what) {
  return {name, "this checkpoint is damaged: " + what, ""};
}

}  // namespace

Result<std::unique_ptr<CheckpointWriter>> CheckpointWriter::start(const Scene& scene, double spacing,
                                                                  Bytes start, const World& world,
                                                                  const HostState& state,
                                                                  const CheckpointOptions& options) {
  std::unique_ptr<CheckpointWriter> writer(new CheckpointWriter(options));
  const Result<wire::Bytes> package = pack_scene(scene, spacing, SceneParts::kAll);
  if (!package) return package.error();
  writer->beginning_.assign(std::begin(kMagic), std::end(kMagic));
  append_chunk(kScene, package.value(), writer->beginning_);
  append_chunk(kStart, start, writer->beginning_);
  writer->state_ = state;
  Copy first;
  const Result<bool> saved = world.save(first.world);
  if (!saved) return saved.error();
  first.state = state;
  first.tick = world.tick();
  first.time = world.time();
  first.stamp_ns = writer->last_copy_ns_ = steady_now_ns();
  writer->session_ = options.session;
  const Result<bool> written = writer->write(first, options.session);
  if (!written) return written.error();
  writer->report_.written = 1;
  writer->last_ = std::move(first);
  writer->thread_ = std::thread([w = writer.get()] { w->run(); });
  return writer;
}

CheckpointWriter::~CheckpointWriter() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void CheckpointWriter::set_session(Bytes session) {
  {
    const std::lock_guard lock(mutex_);
    session_ = std::move(session);
    session_changed_ = true;
  }
  changed_.notify_all();
}

void CheckpointWriter::flush() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !has_waiting_ && !session_changed_ && !writing_; });
}

CheckpointReport CheckpointWriter::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void CheckpointWriter::take_copy(const World& world) {
  const std::int64_t begin_ns = steady_now_ns();
  Copy copy;
  {
    const std::lock_guard lock(mutex_);
    copy.world.swap(spare_);
  }
  copy.world.clear();
  last_copy_ns_ = begin_ns;
  const Result<bool> saved = world.save(copy.world);
  copy.state = state_;
  copy.tick = world.tick();
  copy.time = world.time();
  copy.stamp_ns = begin_ns;
  const double took_ms = 1e3 * to_seconds(steady_now_ns() - begin_ns);
  {
    const std::lock_guard lock(mutex_);
    report_.copy_ms = std::max(report_.copy_ms, took_ms);
    if (!saved) {
      report_.problem = saved.error().text();
      return;
    }
    waiting_ = std::move(copy);
    has_waiting_ = true;
  }
  changed_.notify_all();
}

void CheckpointWriter::after_step(const World& world) {
  if (to_seconds(steady_now_ns() - last_copy_ns_) >= options_.interval) take_copy(world);
}

void CheckpointWriter::after_change(const World& world, const HostCommand&, const HostState& state) {
  state_ = state;
  take_copy(world);
}

void CheckpointWriter::on_end(const World& world) {
  take_copy(world);
}

void CheckpointWriter::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return has_waiting_ || session_changed_ || stop_; });
    if (!has_waiting_ && !session_changed_) return;
    const std::int64_t last_stamp_ns = last_.stamp_ns;
    if (has_waiting_) {
      spare_ = std::move(last_.world);
      last_ = std::move(waiting_);
    }
    has_waiting_ = session_changed_ = false;
    writing_ = true;
    const Bytes session = session_;
    lock.unlock();
    const std::int64_t begin_ns = steady_now_ns();
    const Result<bool> written = write(last_, session);
    const double took_ms = 1e3 * to_seconds(steady_now_ns() - begin_ns);
    lock.lock();
    writing_ = false;
    report_.problem = written ? "" : written.error().text();
    if (written) report_.written += 1;
    report_.write_ms = std::max(report_.write_ms, took_ms);
    report_.longest_gap = std::max(report_.longest_gap, to_seconds(last_.stamp_ns - last_stamp_ns));
    changed_.notify_all();
    if (written || stop_) continue;
    // A disk that was full may not be in a while, and the world may stand still by then.
    changed_.wait_for(lock, std::chrono::seconds(1), [this] { return has_waiting_ || stop_; });
    session_changed_ = !stop_;
  }
}

Result<bool> CheckpointWriter::write(const Copy& copy, const Bytes& session) {
  Checkpoint facts;
  facts.state = copy.state;
  facts.tick = copy.tick;
  facts.time = copy.time;
  facts.version = options_.version;
  Bytes out = beginning_;
  append_chunk(kHead, head_bytes(facts), out);
  append_chunk(kWorld, copy.world, out);
  append_chunk(kSession, session, out);
  append_chunk(kEnd, {}, out);
  const Result<bool> replaced = replace_file(options_.file, out);
  if (replaced) {
    const std::lock_guard lock(mutex_);
    report_.bytes = out.size();
  }
  return replaced;
}

Result<Checkpoint> read_checkpoint_file(std::FILE* file, const std::string& name) {
  char magic[sizeof kMagic];
  if (std::fread(magic, 1, sizeof magic, file) != sizeof magic ||
      std::memcmp(magic, kMagic, sizeof magic) != 0) {
    return Error{name, "is not a checkpoint of slosh", "Give the file that --checkpoint wrote"};
  }
  Checkpoint checkpoint;
  ChunkReader reader(file);
  Chunk chunk;
  for (std::uint8_t part = kScene; part <= kEnd; ++part) {
    switch (reader.next(chunk)) {
      case ChunkOutcome::kEnd:
      case ChunkOutcome::kCutOff:
        return damaged(name, "it is cut off");
      case ChunkOutcome::kDamaged:
        return damaged(name, reader.problem());
      case ChunkOutcome::kChunk:
        break;
    }
    if (chunk.type != part)
      return damaged(name, "part " + std::to_string(chunk.type) + " stands where part " +
                               std::to_string(part) + " should");
    if (part == kScene) {
      Result<UnpackedScene> scene = unpack_scene(chunk.content);
      if (!scene) return damaged(name, scene.error().text());
      checkpoint.scene = std::move(scene.value().scene);
      checkpoint.spacing = scene.value().spacing;
    } else if (part == kHead) {
      FileHead head;
      if (const wire::Fault fault = wire::decode(chunk.content, head)) {
        if (fault.field == "version")
          return Error{name, "was written by another version of slosh", "Use that version to carry on"};
        return damaged(name, fault.text());
      }
      checkpoint.state = head.state;
      checkpoint.tick = head.tick;
      checkpoint.time = head.time;
      checkpoint.version = head.program;
    } else if (part == kStart) {
      checkpoint.start = std::move(chunk.content);
    } else if (part == kWorld) {
      checkpoint.world = std::move(chunk.content);
    } else if (part == kSession) {
      checkpoint.session = std::move(chunk.content);
    }
  }
  if (reader.next(chunk) != ChunkOutcome::kEnd) return damaged(name, "something follows its end");
  return checkpoint;
}

Result<Checkpoint> read_checkpoint(const std::filesystem::path& file) {
  const auto read = [](const std::filesystem::path& path) -> Result<Checkpoint> {
    const Result<File> opened = open_to_read(path);
    if (!opened) return opened.error();
    return read_checkpoint_file(opened.value().get(), path.string());
  };
  Result<Checkpoint> newest = read(file);
  if (newest) return newest;
  Result<Checkpoint> previous = read(previous_of(file));
  if (!previous) return newest;
  previous.value().note = newest.error().text() + ". The one before it is used";
  return previous;
}

}  // namespace slosh::keep
