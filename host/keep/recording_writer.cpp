#include <algorithm>
#include <cerrno>
#include <cstring>

#include "host/keep/recording_format.h"
#include "net/clock.h"
#include "net/wire/scene_package.h"

namespace slosh::keep {
namespace {

// Bytes of events that make a chunk whatever the time.
constexpr std::size_t kFullChunk = 64 << 10;
constexpr std::size_t kLongestReason = 200;  // bytes, as visit() of the totals has it

template <class M>
void append(const M& message, Bytes& out) {
  wire::encode(message, out);
}

void append_state(const World& world, std::uint32_t run, Bytes& out) {
  append(PlaceRecord{world.tick(), run}, out);
  (void)world.save(out);
}

}  // namespace

Result<bool> check_unrecorded(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code) || std::filesystem::file_size(file, code) == 0)
    return true;
  return Error{file.string(), "is there already, and a recording overwrites nothing",
               "Choose another file with --record, or move this one away"};
}

RecordingWriter::RecordingWriter(const Scene& scene, const RecordingOptions& options)
    : options_(options), hands_(scene.grips.size()) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (moves(scene.bodies[b].motion)) free_bodies_.push_back(b);
  }
}

Result<std::unique_ptr<RecordingWriter>> RecordingWriter::start(const Scene& scene, double spacing,
                                                                const Bytes& start, const World& world,
                                                                const HostState& state,
                                                                const RecordingOptions& options) {
  std::unique_ptr<RecordingWriter> writer(new RecordingWriter(scene, options));
  const Result<wire::Bytes> package = pack_scene(scene, spacing, SceneParts::kAll);
  if (!package) return package.error();
  if (const Result<bool> free = check_unrecorded(options.file); !free) return free.error();
  Result<File> file = open_to_write(options.file);
  if (!file) return file.error();
  writer->file_ = std::move(file.value());

  Bytes out(std::begin(kRecordingMagic), std::end(kRecordingMagic));
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(kRecordingVersion >> (8 * i)));
  // The world itself says what its parameters are, whatever the caller believes.
  const HostState now_state = state_of(world, scene.fluids.size(), state.paused, state.run);
  append_chunk(kHeadChunk,
               wire::encoded(HeadRecord{world.plan().time_step, options.version, options.backend, now_state}),
               out);
  append_chunk(kSceneChunk, package.value(), out);
  Bytes now;
  const Result<bool> saved = world.save(now);
  if (!saved) return saved.error();
  append_chunk(kStartChunk, start == now ? Bytes{} : start, out);
  Bytes first;
  append_state(world, state.run, first);
  if (first.size() > kLargestChunk) {
    return Error{options.file.string(),
                 "the world's state has " + std::to_string(first.size() >> 20) +
                     " MB, and a recording takes " + std::to_string(kLargestChunk >> 20) + " MB at a time",
                 "Record it with a larger --spacing"};
  }
  append_chunk(kStateChunk, first, out);
  std::FILE* raw = writer->file_.get();
  if (std::fwrite(out.data(), 1, out.size(), raw) != out.size() || !bring_to_disk(raw))
    return Error{options.file.string(), std::string("cannot be written: ") + std::strerror(errno), ""};
  writer->bytes_ = out.size();
  writer->run_ = state.run;
  writer->next_bodies_ = world.time();
  writer->next_state_ = world.time() + options.state_seconds;
  writer->thread_ = std::thread([w = writer.get()] { w->run(); });
  return writer;
}

RecordingWriter::~RecordingWriter() {
  finish();
}

RecordingReport RecordingWriter::finish() {
  if (thread_.joinable()) {
    if (!ended_) {
      flush_events();
      queue_end();
    }
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  return {totals_, bytes_, input_bytes_, problem_};
}

void RecordingWriter::begin_events(const World& world) {
  if (!events_.empty()) return;
  events_since_ns_ = steady_now_ns();
  append(PlaceRecord{world.tick(), run_}, events_);
}

void RecordingWriter::flush_events() {
  if (events_.empty()) return;
  queue_events(std::move(events_));
  events_ = {};
}

void RecordingWriter::queue_events(Bytes content) {
  if (ended_) return;
  std::string why;
  {
    const std::lock_guard lock(mutex_);
    why = problem_;
    if (why.empty() && waiting_bytes_ + content.size() > options_.queue_bytes) {
      why = "the disk did not keep up: more than " +
            std::to_string(std::max<std::size_t>(1, options_.queue_bytes >> 20)) + " MB waited for it";
    }
    if (why.empty()) {
      waiting_bytes_ += content.size();
      waiting_.push_back({kEventsChunk, std::move(content)});
    }
  }
  // What does not fit is missing: nothing after it could be run again.
  if (!why.empty()) return end_early(why);
  changed_.notify_one();
}

bool RecordingWriter::queue_state(const World& world) {
  {
    const std::lock_guard lock(mutex_);
    if (state_waits_) return false;
    state_waits_ = true;
  }
  Waiting state{kStateChunk, {}};
  append_state(world, run_, state.content);
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(state));
  }
  changed_.notify_one();
  return true;
}

void RecordingWriter::end_early(const std::string& why) {
  totals_.ended_early = why.substr(0, kLongestReason);
  {
    const std::lock_guard lock(mutex_);
    if (trouble_.empty()) trouble_ = why;
  }
  queue_end();
}

void RecordingWriter::queue_end() {
  if (ended_) return;
  ended_ = true;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({kEndChunk, wire::encoded(totals_)});
  }
  changed_.notify_one();
}

std::string RecordingWriter::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

void RecordingWriter::before_step(const World& world, const StepInput& input) {
  if (ended_) return;
  begin_events(world);
  tick_.clear();
  const std::size_t before = events_.size();
  if (hands_.encode(input.hands, tick_)) {
    events_.push_back(kStepHands);
    events_.insert(events_.end(), tick_.begin(), tick_.end());
  } else {
    events_.push_back(kStepExpected);
  }
  input_bytes_ += events_.size() - before;
  totals_.steps += 1;
  hash_is_new_ = false;
}

void RecordingWriter::add_bodies(const World& world) {
  world.fill(bodies_);
  events_.push_back(kBodiesTag);
  for (const std::size_t b : free_bodies_) {
    append(BodyRecord{static_cast<std::uint32_t>(b), bodies_.bodies[b].pose, bodies_.bodies[b].twist},
           events_);
  }
}

void RecordingWriter::add_hash(const World& world) {
  if (ended_ || hash_is_new_ || totals_.steps == 0) return;
  begin_events(world);
  events_.push_back(kHashTag);
  const std::uint64_t hash = world.hash();
  for (int i = 0; i < 8; ++i) events_.push_back(static_cast<std::uint8_t>(hash >> (8 * i)));
  totals_.hashes += 1;
  hash_is_new_ = true;
}

void RecordingWriter::after_step(const World& world) {
  if (ended_) return;
  const double half_step = 0.5 * world.plan().time_step;
  if (!free_bodies_.empty() && world.time() + half_step >= next_bodies_) {
    add_bodies(world);
    next_bodies_ += 1.0 / options_.body_rate;
  }
  if (world.tick() % options_.hash_ticks == 0) add_hash(world);
  if (world.time() + half_step >= next_state_) {
    flush_events();
    if (!ended_ && queue_state(world)) {
      totals_.states += 1;
      hands_.restart();
    }
    next_state_ += options_.state_seconds;
  }
  const bool due = to_seconds(steady_now_ns() - events_since_ns_) >= options_.chunk_seconds;
  if (due || events_.size() >= kFullChunk) flush_events();
}

void RecordingWriter::after_change(const World& world, const HostCommand& change, const HostState& state) {
  if (ended_) return;
  // A reset's place is where it leads: the reader then needs no rule for it.
  if (change.action == HostAction::kReset) {
    flush_events();
    run_ = state.run;
    hash_is_new_ = true;  // of what was before
    next_bodies_ = world.time();
    next_state_ = world.time() + options_.state_seconds;
  }
  begin_events(world);
  events_.push_back(kChangeTag);
  append(ChangeRecord{change}, events_);
  totals_.changes += 1;
  flush_events();
}

void RecordingWriter::on_end(const World& world) {
  add_hash(world);
  flush_events();
  queue_end();
}

// On the writer's thread, without the lock. False with errno when it could not be written.
bool RecordingWriter::write(const Waiting& next, Bytes& packed, bool sync) {
  packed.clear();
  append_chunk(next.type, next.content, packed);
  std::FILE* file = file_.get();
  return std::fwrite(packed.data(), 1, packed.size(), file) == packed.size() &&
         (sync ? bring_to_disk(file) : std::fflush(file) == 0);
}

void RecordingWriter::run() {
  Bytes packed;
  std::int64_t synced_ns = steady_now_ns();
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return !waiting_.empty() || stop_; });
    if (waiting_.empty()) break;
    const Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    const bool broken = !problem_.empty();
    lock.unlock();
    const bool sync =
        next.type == kEndChunk || to_seconds(steady_now_ns() - synced_ns) >= options_.sync_seconds;
    const bool written = !broken && write(next, packed, sync);
    const int code = errno;
    if (sync) synced_ns = steady_now_ns();
    lock.lock();
    if (next.type == kEventsChunk) waiting_bytes_ -= next.content.size();
    if (next.type == kStateChunk) state_waits_ = false;
    if (written) {
      bytes_ += packed.size();
    } else if (!broken) {
      problem_ = trouble_ = options_.file.string() + ": cannot be written: " + std::strerror(code);
    }
  }
}

}  // namespace slosh::keep
