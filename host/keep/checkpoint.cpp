#include "host/keep/checkpoint.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>

#include "host/keep/file.h"
#include "host/keep/secrets.h"
#include "net/clock.h"
#include "net/wire/scene_package.h"

namespace slosh::keep {
namespace {

constexpr char kMagic[8] = {'S', 'L', 'O', 'S', 'H', 'C', 'P', '\n'};
// 1 had the secrets in it; 2, which is read as well, lacks task_done.
constexpr std::uint32_t kVersion = 3;
constexpr std::uint32_t kBeforeTask = 2;
constexpr double kLongestStep = 1e9;  // s
constexpr std::size_t kMaxAddresses = 64;
constexpr std::size_t kLongestAddress = 256;

// In this order, each once.
enum Part : std::uint8_t { kScene = 1, kStart, kHead, kWorld, kEnd };

/// What every version of the head begins with.
struct HeadVersion {
  std::uint32_t version = kVersion;
};
template <class V>
void visit(V& v, HeadVersion& m) {
  v.natural("version", m.version, 0, 0xffffffff);
}

struct FileHead {
  HeadVersion version;
  HostState state;
  std::uint64_t tick = 0;
  double time = 0.0;
  std::string program;
  std::uint64_t run = 0;
  HostPlace place;
};
template <class V>
void visit(V& v, FileHead& m) {
  visit(v, m.version);
  v.flag("paused", m.state.paused);
  v.natural("run", m.state.run, 0, 0xffffffff);
  v.natural("tick", m.tick, 0, wire::kMaxTick);
  v.real64("time", m.time, 0.0, 1e12);
  v.text("program", m.program, 64);
  v.bits64("host_run", m.run);
  v.text("listen", m.place.listen, kLongestAddress);
  v.list("addresses", m.place.addresses, kMaxAddresses,
         [](auto& each, std::string& address) { each.text("address", address, kLongestAddress); });
  if (m.version.version > kBeforeTask)
    v.list("task_done", m.state.task_done, kMaxTaskSteps,
           [](auto& each, double& took) { each.real64("took", took, 0.0, kLongestStep); });
}

std::uint32_t version_of(ByteView head) {
  HeadVersion version{0};
  wire::Reader reader(head);
  visit(reader, version);
  return reader.fault() ? 0 : version.version;
}

// What a checkpoint and what belongs to it are called after its own name.
const std::string kEndings[] = {"", previous_of({}).string(), secrets_of({}).string(),
                                previous_of(secrets_of({})).string()};

bool is_whole(const std::filesystem::path& path) {
  const Result<File> opened = open_to_read(path);
  return opened && read_checkpoint_file(opened.value().get(), path.string());
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
  if (first.world.size() > kLargestChunk) {
    return Error{options.file.string(),
                 "the world's state has " + std::to_string(first.world.size() >> 20) +
                     " MB, and a checkpoint takes " + std::to_string(kLargestChunk >> 20) + " MB of it",
                 "Host it with a larger --spacing, or with --checkpoint none"};
  }
  first.state = state;
  first.tick = world.tick();
  first.time = world.time();
  first.stamp_ns = writer->last_copy_ns_ = steady_now_ns();
  // The secrets first: a checkpoint without them could not be carried on with the same links.
  if (!options.server_state.empty()) {
    const Result<bool> kept = write_secrets(options.file, options.run, options.server_state);
    if (!kept) return kept.error();
  }
  const Result<bool> written =
      writer->write(first, is_whole(options.file) ? Replaced::kKept : Replaced::kDropped);
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

void CheckpointWriter::set_server_state(Bytes server_state) {
  {
    const std::lock_guard lock(mutex_);
    server_state_ = std::move(server_state);
    server_state_changed_ = true;
  }
  changed_.notify_all();
}

void CheckpointWriter::flush() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !has_waiting_ && !server_state_changed_ && !writing_; });
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
  changed_since_copy_ = false;
  const Result<bool> saved = world.save(copy.world);
  copy.state = state_;
  if (options_.task_done) copy.state.task_done = options_.task_done();
  copy.tick = world.tick();
  copy.time = world.time();
  copy.stamp_ns = begin_ns;
  const double took_ms = 1e3 * to_seconds(steady_now_ns() - begin_ns);
  {
    const std::lock_guard lock(mutex_);
    report_.copy_ms = std::max(report_.copy_ms, took_ms);
    report_.copies += 1;
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
  if (due()) take_copy(world);
}

// What was changed while the world stands is kept as soon as what is changed while it runs.
void CheckpointWriter::while_standing(const World& world) {
  if (changed_since_copy_ && due()) take_copy(world);
}

bool CheckpointWriter::due() const {
  return to_seconds(steady_now_ns() - last_copy_ns_) >= options_.interval;
}

void CheckpointWriter::after_change(const World& world, const HostCommand&, const HostState& state) {
  // Commands may come by the hundred: they are kept at the interval like everything else.
  state_ = state;
  changed_since_copy_ = true;
  if (due()) take_copy(world);
}

void CheckpointWriter::on_end(const World& world) {
  take_copy(world);
}

void CheckpointWriter::run() {
  bool failed = false;  // what is on the disk is not last_ and the server's state
  std::unique_lock lock(mutex_);
  while (true) {
    const auto wanted = [this] { return has_waiting_ || server_state_changed_ || stop_; };
    // A disk that was full may not be in a while, and the world may stand still by then.
    if (failed && !stop_)
      changed_.wait_for(lock, std::chrono::seconds(1), [this] { return has_waiting_ || stop_; });
    else
      changed_.wait(lock, wanted);
    if (!has_waiting_ && !server_state_changed_ && (stop_ || !failed)) return;
    const std::int64_t last_stamp_ns = last_.stamp_ns;
    if (has_waiting_) {
      spare_ = std::move(last_.world);
      last_ = std::move(waiting_);
    }
    const bool world = has_waiting_ || failed;
    const bool secrets = server_state_changed_ || (failed && !server_state_.empty());
    has_waiting_ = server_state_changed_ = false;
    writing_ = true;
    const Bytes server_state = server_state_;
    lock.unlock();
    const std::int64_t begin_ns = steady_now_ns();
    Result<bool> written = true;
    if (secrets) written = write_secrets(options_.file, options_.run, server_state);
    if (world && written) written = write(last_, Replaced::kKept);
    const double took_ms = 1e3 * to_seconds(steady_now_ns() - begin_ns);
    lock.lock();
    writing_ = false;
    failed = !written;
    report_.problem = written ? "" : written.error().text();
    if (written && world) report_.written += 1;
    report_.write_ms = std::max(report_.write_ms, took_ms);
    report_.longest_gap = std::max(report_.longest_gap, to_seconds(last_.stamp_ns - last_stamp_ns));
    changed_.notify_all();
  }
}

Result<bool> CheckpointWriter::write(const Copy& copy, Replaced old) {
  FileHead head;
  head.state = copy.state;
  head.tick = copy.tick;
  head.time = copy.time;
  head.program = options_.version.substr(0, 64);
  head.run = options_.run;
  head.place = options_.place;
  Bytes out = beginning_;
  append_chunk(kHead, wire::encoded(head), out);
  append_chunk(kWorld, copy.world, out);
  append_chunk(kEnd, {}, out);
  const Result<bool> replaced = replace_file(options_.file, out, old);
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
    const std::uint32_t version = part == kHead ? version_of(chunk.content) : kVersion;
    if (version > kVersion || version < kBeforeTask)
      return Error{name,
                   "is a checkpoint of format " + std::to_string(version) +
                       ", and this program reads format " + std::to_string(kVersion),
                   "Resume it with the version of slosh that wrote it; it is left as it is"};
    if (part == kScene) {
      Result<UnpackedScene> scene = unpack_scene(chunk.content);
      if (!scene) return damaged(name, scene.error().text());
      checkpoint.scene = std::move(scene.value().scene);
      checkpoint.spacing = scene.value().spacing;
    } else if (part == kHead) {
      FileHead head;
      if (const wire::Fault fault = wire::decode(chunk.content, head)) return damaged(name, fault.text());
      checkpoint.state = head.state;
      checkpoint.tick = head.tick;
      checkpoint.time = head.time;
      checkpoint.version = head.program;
      checkpoint.run = head.run;
      checkpoint.place = std::move(head.place);
    } else if (part == kStart) {
      checkpoint.start = std::move(chunk.content);
    } else if (part == kWorld) {
      checkpoint.world = std::move(chunk.content);
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
  const std::filesystem::path before = previous_of(file);
  Result<Checkpoint> previous = read(before);
  if (!previous) {
    std::error_code code;
    if (!std::filesystem::exists(before, code)) return newest;
    Error error = newest.error();
    error.what += "; and so is the one before it";
    error.mend = "Host the scene anew: both are then moved aside, not overwritten";
    return error;
  }
  char lost[120];
  std::snprintf(lost, sizeof lost, ". The one before it is used, of %.2f s: what came after is lost",
                previous.value().time);
  previous.value().note = newest.error().text() + lost;
  std::error_code code, none;
  const auto newest_time = std::filesystem::last_write_time(file, none);
  const auto previous_time = std::filesystem::last_write_time(before, code);
  if (!code && !none) {
    const double apart = std::chrono::duration<double>(newest_time - previous_time).count();
    std::snprintf(lost, sizeof lost, " (written %.1f s before it)", apart);
    previous.value().note += lost;
  }
  return previous;
}

Result<std::filesystem::path> set_checkpoint_aside(const std::filesystem::path& file) {
  std::error_code code;
  const auto any = [&code](const std::filesystem::path& begin) {
    return std::any_of(std::begin(kEndings), std::end(kEndings), [&](const std::string& ending) {
      return std::filesystem::exists(begin.string() + ending, code);
    });
  };
  if (!any(file)) return std::filesystem::path();
  std::filesystem::path aside;
  for (int number = 1; aside.empty() || any(aside); ++number)
    aside = file.string() + "." + std::to_string(number);
  const Result<bool> moved = move_files(file, aside, kEndings);
  if (!moved) return moved.error();
  return aside;
}

}  // namespace slosh::keep
