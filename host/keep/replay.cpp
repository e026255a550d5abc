#include "host/keep/replay.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/keep/rebuild.h"

namespace slosh::keep {
namespace {

constexpr double kSameTurn = 0.1;  // rad

Backend choose(Backend wanted, const std::string& recorded) {
  if (wanted != Backend::kAuto) return wanted;
  return recorded == backend_name(Backend::kCuda) && cuda_available(nullptr) ? Backend::kCuda : Backend::kCpu;
}

}  // namespace

bool ReplayVerdict::same(double spacing) const {
  if (hashes_comparable) return agree == hashes;
  return farthest <= spacing && largest_turn <= kSameTurn;
}

std::string ReplayVerdict::text(double spacing) const {
  char line[400];
  std::string all;
  const auto add = [&](const char* pattern, auto... values) {
    std::snprintf(line, sizeof line, pattern, values...);
    all += line;
  };
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  if (hashes_comparable && hashes == 0) {
    all += "it holds no hash to compare";
  } else if (hashes_comparable) {
    add("%llu of %llu hashes agree", number(agree), number(hashes));
    if (agree < hashes) add("; the first that differs is at tick %llu", number(first_difference));
  } else {
    add("recorded on another backend, so that hashes cannot be compared; bodies %s within %.2g mm and %.2g "
        "rad",
        same(spacing) ? "stayed" : "did not stay", 1e3 * spacing, kSameTurn);
  }
  if (bodies > 0 && !(hashes_comparable && agree == hashes))
    add(" (off by at most %.3g mm and %.3g rad)", 1e3 * farthest, largest_turn);
  if (at_end && !complete) add("; the recording is cut off after %llu steps", number(steps));
  if (!ended_early.empty()) all += "; the recording ended early: " + ended_early;
  return all;
}

Result<std::unique_ptr<Replayer>> Replayer::open(const std::filesystem::path& file,
                                                 const ReplayOptions& options) {
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::open(file);
  if (!reader) return reader.error();
  const RecordingHead& head = reader.value()->head();
  const Backend backend = choose(options.backend, head.backend);
  Result<RebuiltWorld> rebuilt =
      rebuild_world(head.scene, head.spacing, head.world,
                    {.threads = options.threads, .backend = backend, .gpu = options.gpu});
  if (!rebuilt) {
    Error error = rebuilt.error();
    error.where = file.string() + ": " + error.where;
    return error;
  }
  const bool comparable = head.backend == backend_name(backend);
  std::unique_ptr<Replayer> replayer(new Replayer(std::move(reader.value()),
                                                  std::move(rebuilt.value().sampled),
                                                  std::move(rebuilt.value().world), backend));
  replayer->verdict_.hashes_comparable = comparable;
  return replayer;
}

double Replayer::elapsed() const {
  return static_cast<double>(verdict_.steps) * world_.plan().time_step;
}

Result<bool> Replayer::change(const HostCommand& command) {
  if (command.action != HostAction::kReset) return change_world(world_, command);
  verdict_.resets += 1;
  return reset_world(world_, head().scene.fluids.size(), head().start);
}

void Replayer::compare_hash(std::uint64_t recorded) {
  if (!verdict_.hashes_comparable) return;
  const bool same = recorded == world_.hash();
  if (!same && verdict_.agree == verdict_.hashes) verdict_.first_difference = world_.tick();
  verdict_.hashes += 1;
  verdict_.agree += same;
}

void Replayer::compare_bodies(const std::vector<BodyRecord>& recorded) {
  world_.fill(now_);
  for (const BodyRecord& then : recorded) {
    if (then.body >= now_.bodies.size()) continue;
    const Pose& pose = now_.bodies[then.body].pose;
    const double length = glm::length(then.pose.orientation);
    const double part =
        length > 0.5 ? std::abs(glm::dot(then.pose.orientation, pose.orientation)) / length : 0.0;
    verdict_.farthest = std::max(verdict_.farthest, glm::distance(then.pose.position, pose.position));
    verdict_.largest_turn = std::max(verdict_.largest_turn, 2.0 * std::acos(std::min(1.0, part)));
    verdict_.bodies += 1;
  }
}

Result<bool> Replayer::step() {
  while (true) {
    const Result<const RecordingEvent*> next = reader_->next();
    if (!next) return next.error();
    if (next.value() == nullptr) {
      verdict_.at_end = true;
      verdict_.complete = reader_->complete();
      return false;
    }
    const RecordingEvent& event = *next.value();
    switch (event.kind) {
      case RecordingEvent::Kind::kStep:
        world_.step(event.hands);
        status_ |= world_.take_status();
        verdict_.steps += 1;
        return true;
      case RecordingEvent::Kind::kBodies:
        compare_bodies(event.bodies);
        break;
      case RecordingEvent::Kind::kHash:
        compare_hash(event.hash);
        break;
      case RecordingEvent::Kind::kChange: {
        const Result<bool> changed = change(event.change);
        if (!changed) return changed.error();
        break;
      }
      case RecordingEvent::Kind::kState:
        break;
      case RecordingEvent::Kind::kEnd:
        verdict_.ended_early = event.totals.ended_early;
        break;
    }
  }
}

}  // namespace slosh::keep
