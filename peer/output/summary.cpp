#include "peer/output/summary.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "net/text/clean.h"
#include "peer/output/whole_file.h"
#include "sim/math/format.h"
#include "sim/snapshot.h"

namespace slosh {
namespace {

using Json = nlohmann::ordered_json;

// Of the fluid: what bounces out of a vessel is no less, and what is more was poured.
constexpr double kBounced = 0.02, kPoured = 0.1;

Json spread(const Spread& s) {
  return {{"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
}

Json network_json(const NetworkSummary& n) {
  const double seconds = n.seconds > 0.0 ? n.seconds : 1.0;
  return {{"host", n.host},
          {"name", n.name},
          {"role", n.participant ? "participant" : "spectator"},
          {"rtt_ms", 1e3 * n.round_trip},
          {"send_loss", n.send_loss},
          {"clock_error_ms", 1e3 * n.clock_error},
          {"hand_delay_ms", 1e3 * n.hand_delay},
          {"picture_delay_ms", 1e3 * n.picture_delay},
          {"age_ms", spread(n.age_ms)},
          {"bytes_received", n.bytes_received},
          {"bytes_sent", n.bytes_sent},
          {"received_bytes_per_s", static_cast<double>(n.bytes_received) / seconds},
          {"sent_bytes_per_s", static_cast<double>(n.bytes_sent) / seconds},
          {"poses_sent", n.poses_sent},
          {"body_states", {{"used", n.states}, {"incomplete", n.states_incomplete}}},
          {"snapshots", {{"complete", n.snapshots - n.snapshots_partial}, {"partial", n.snapshots_partial}}},
          {"refused", {{"datagrams", n.datagrams_refused}, {"pieces", n.pieces_refused}}},
          {"reconnects", n.reconnects},
          {"live_after_s", n.to_live},
          {"first_picture_after_s", n.to_first_picture},
          {"picture_time_s", {{"first", n.first_picture_time}, {"last", n.last_picture_time}}},
          {"ended", n.ended}};
}

std::string network_words(const RunSummary& s, const NetworkSummary& n) {
  std::string text = format("%s, %s at %s: %.1f s of %s fluid particles at %.1f mm in %.1f s%s.\n",
                            s.scene.c_str(), n.participant ? "a guest" : "looking on", n.host.c_str(),
                            s.simulated, grouped(s.fluid_particles).c_str(), 1e3 * s.spacing, s.wall,
                            s.interrupted ? ", interrupted" : "");
  text += format(
      "Round trip %.1f ms, %.1f %% of what was sent was lost; hands lived %.1f ms behind the host, "
      "pictures %.0f ms (p99 %.0f).\n",
      1e3 * n.round_trip, 100.0 * n.send_loss, 1e3 * n.hand_delay, n.age_ms.p50, n.age_ms.p99);
  text += format("%s snapshots, %s of them with parts missing; %s kB received, %s kB sent; %s reconnects.\n",
                 grouped(n.snapshots).c_str(), grouped(n.snapshots_partial).c_str(),
                 grouped(n.bytes_received / 1000).c_str(), grouped(n.bytes_sent / 1000).c_str(),
                 grouped(n.reconnects).c_str());
  if (!n.ended.empty()) text += "Ended: " + n.ended + "\n";
  return text;
}

/// "12 of 400 fluid particles were spilled over the domain's edge"; empty where none was.
std::string share_words(std::uint64_t count, std::uint64_t of, const char* what) {
  if (count == 0) return {};
  return grouped(count) + " of " + grouped(of) +
         (count == 1 ? " fluid particles was " : " fluid particles were ") + what;
}

/// What left the world, and how: before the run and in it.
std::string left_words(const RunSummary& s) {
  const std::string lost = std::string("lost: ") +
                           (s.walls_hold ? "not finite any more"
                                         : "they left the domain, over its edge or through a wall, which the "
                                           "published model does not hold");
  const auto add = [&](std::string& text, const std::string& words, const std::string& end) {
    if (!words.empty()) text += words + end + ".\n";
  };
  std::string text;
  const char* spilled = "spilled over the edge of the domain";
  const char* settled = ", while the world settled, before the run";
  add(text, share_words(s.retired_settling - s.lost_settling, s.fluid_particles, spilled), settled);
  add(text, share_words(s.lost_settling, s.fluid_particles, lost.c_str()), settled);
  if (s.fluid_mass_start <= 0.0 || s.retired_particles <= s.retired_settling) return text;
  const std::uint64_t at_start = s.fluid_particles - s.retired_settling;
  const std::uint64_t lost_now = s.lost_particles - s.lost_settling;
  const std::uint64_t spilled_now = s.retired_particles - s.retired_settling - lost_now;
  const double gone = s.fluid_mass_start - s.fluid_mass_end;
  // What came while it ran, or was taken away, is in the difference.
  const std::string mass =
      s.fluid_came ? std::string() : format(", %.3g of %.3g kg", gone, s.fluid_mass_start);
  add(text, share_words(spilled_now, at_start, spilled), lost_now == 0 ? mass : "");
  add(text, share_words(lost_now, at_start, lost.c_str()),
      spilled_now == 0 ? mass : "; with what was spilled" + mass);
  // Measured: tests/peer/python/first_scene_test.py.
  if (!s.fluid_came && gone > kBounced * s.fluid_mass_start && gone < kPoured * s.fluid_mass_start)
    text +=
        "  (If it bounced off what it fell on: of a mug that spilled 4 %, \"model\": \"incompressible\" on "
        "the scene kept all but\n"
        "  0.9 %, and viscosity_pa_s 2 on those bodies all.)\n";
  return text;
}

std::string world_words(const RunSummary& s) {
  std::string text =
      format("%s: %.1f s of %s fluid and %s body particles at %.1f mm in %.1f s (real time × %.2f)",
             s.scene.c_str(), s.simulated, grouped(s.fluid_particles).c_str(),
             grouped(s.boundary_particles).c_str(), 1e3 * s.spacing, s.wall, s.real_time_factor);
  text += s.interrupted ? ", interrupted.\n" : ".\n";
  text += format("A step of %.2f ms took %.2f ms (p99 %.2f) on %d thread%s (%s).\n", 1e3 * s.time_step,
                 s.step_ms.p50, s.step_ms.p99, s.threads, s.threads == 1 ? "" : "s", s.backend.c_str());
  return text;
}

nlohmann::ordered_json task_json(const std::vector<TaskStepSummary>& task) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const TaskStepSummary& step : task) {
    steps.push_back({{"say", step.say}, {"done", step.done}});
    if (!step.done) continue;
    steps.back()["took_s"] = step.took;
    steps.back()["late"] = step.late;
    steps.back()["measured"] = step.measured;
  }
  return steps;
}

std::string task_words(const std::vector<TaskStepSummary>& task) {
  if (task.empty()) return {};
  std::size_t done = 0;
  double took = 0.0;
  std::string steps;
  for (const TaskStepSummary& step : task) {
    done += step.done ? 1 : 0;
    took += step.took;
    steps += step.done ? format("  %5.1f s  ", step.took) : std::string("  not done ");
    steps += step.say + (step.late ? " (late)\n" : "\n");
    for (const std::string& measured : step.measured) steps += "           " + measured + "\n";
  }
  return format("Task: %zu of %zu steps done, in %.1f s.\n", done, task.size(), took) + steps;
}

}  // namespace

std::vector<std::string> status_words(std::uint32_t status) {
  std::vector<std::string> words;
  for (int bit = 0; bit < 32; ++bit) {
    const std::uint32_t one = status & (1u << bit);
    if (one == 0) continue;
    const std::string text = status_text(one);
    if (!text.empty()) words.push_back(text);
  }
  return words;
}

std::vector<std::string> status_words(const RunSummary& s) {
  std::vector<std::string> words;
  for (std::size_t bit = 0; bit < s.status_steps.size(); ++bit) {
    const std::uint32_t one = s.status & (1u << bit);
    std::string text = one != 0 ? status_text(one) : std::string();
    if (text.empty()) continue;
    std::string numbers;
    // A body may be what is not finite. Where walls do not hold, lost is what left the domain as well.
    const std::uint64_t left = one == kStatusEscaped && s.walls_hold ? s.retired_particles - s.lost_particles
                               : one == kStatusEscaped || (one == kStatusNonFinite && s.walls_hold)
                                   ? s.lost_particles
                                   : 0;
    if (left > 0) numbers = grouped(left) + " of " + grouped(s.fluid_particles);
    if (one == kStatusInputRejected && s.rejected_poses > 0) numbers = grouped(s.rejected_poses) + " poses";
    if (s.status_steps[bit] > 0) {
      numbers += (numbers.empty() ? "in " : ", in ") + grouped(s.status_steps[bit]) + " of " +
                 grouped(s.steps) + (s.steps == 1 ? " step" : " steps");
    }
    words.push_back(numbers.empty() ? text : text + " (" + numbers + ")");
  }
  return words;
}

std::string grouped(std::uint64_t number) {
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3;) {
    at -= 3;
    text.insert(at, 1, ' ');
  }
  return text;
}

Json to_json(const RunSummary& s) {
  Json devices = Json::array();
  for (const DeviceSummary& d : s.devices) {
    devices.push_back({{"grip", d.grip},
                       {"device", d.device},
                       {"peak_force_n", d.peak_force},
                       {"peak_torque_nm", d.peak_torque},
                       {"clipped_s", d.clipped}});
  }
  Json json;
  json["scene"] = s.scene;
  json["scene_file"] = s.scene_file;
  json["spacing_m"] = s.spacing;
  json["spacing_reason"] = s.spacing_reason;
  json["particles"] = {{"fluid", s.fluid_particles},
                       {"boundary", s.boundary_particles},
                       {"retired", s.retired_particles},
                       {"spilled", s.retired_particles - s.lost_particles},
                       {"lost", s.lost_particles},
                       {"retired_settling", s.retired_settling},
                       {"spilled_settling", s.retired_settling - s.lost_settling},
                       {"lost_settling", s.lost_settling},
                       {"in_solids", s.particles_in_solids}};
  json["steps"] = s.steps;
  json["time_step_s"] = s.time_step;
  json["simulated_s"] = s.simulated;
  json["wall_s"] = s.wall;
  json["real_time_factor"] = s.real_time_factor;
  json["step_ms"] = spread(s.step_ms);
  json["step_share"] = nlohmann::ordered_json::object();
  for (const auto& [pass, share] : s.step_share) json["step_share"][pass] = share;
  json["device_loop_us"] = spread(s.device_loop_us);
  json["device_loop_us"]["ticks"] = s.device_ticks;
  json["device_loop_us"]["missed"] = s.device_missed;
  json["device_loop_us"]["scheduler"] = s.device_scheduler;
  json["device_loop_us"]["memory_locked"] = s.device_memory_locked;
  json["render"] = {{"on", s.rendered},
                    {"renderer", s.renderer},
                    {"quality", s.fast_picture ? "fast" : "full"},
                    {"width", s.width},
                    {"height", s.height},
                    {"frames", s.frames},
                    {"dropped", s.frames_dropped},
                    {"ms", spread(s.frame_ms)}};
  json["status"] = status_words(s);
  if (!s.gone.empty()) json["gone"] = s.gone;
  json["slips"] = {{"count", s.slips}, {"seconds", s.slipped}};
  json["rejected_poses"] = s.rejected_poses;
  json["samples_lost"] = s.samples_lost;
  json["fluid_mass_kg"] = {{"start", s.fluid_mass_start}, {"end", s.fluid_mass_end}};
  if (s.measured.interval > 0.0) json["measured"] = to_json(s.measured);
  if (!s.task.empty()) {
    json["task"] = task_json(s.task);
    json["task_spilled_kg"] = s.spilled_mass;
  }
  json["devices"] = devices;
  json["backend"] = s.backend;
  json["threads"] = s.threads;
  json["machine"] = {{"cpu", s.machine.cpu}, {"cores", s.machine.cores}, {"system", s.machine.system}};
  json["version"] = s.version;
  json["interrupted"] = s.interrupted;
  if (!s.verdict.empty()) json["verdict"] = s.verdict;
  if (!s.recording.empty()) json["recording"] = {{"file", s.recording}, {"problem", s.recording_problem}};
  if (s.export_frames + s.export_left_out > 0) {
    json["export"] = {
        {"frames", s.export_frames}, {"left_out", s.export_left_out}, {"seconds", s.export_seconds}};
  }
  if (s.network) json["network"] = network_json(*s.network);
  json["files"] = s.files;
  json["problems"] = s.problems;
  return json;
}

std::string in_words(const RunSummary& s) {
  constexpr std::size_t kMax = 20'000;
  constexpr std::uint64_t kTolerated = 1000;  // ticks of which one may be missed
  std::string text = s.network ? network_words(s, *s.network) : world_words(s);
  if (!s.devices.empty() && s.device_ticks > 0) {
    text += format("The device loop ran every %.0f µs (p99 %.0f, longest %.0f, %s missed, %s).\n",
                   s.device_loop_us.p50, s.device_loop_us.p99, s.device_loop_us.max,
                   grouped(s.device_missed).c_str(), s.device_scheduler.c_str());
    // Where it was quick enough without, nobody need do anything.
    if (s.device_scheduler == "SCHED_OTHER" && kTolerated * s.device_missed > s.device_ticks)
      text +=
          "The kernel granted it no real-time priority: `YOUR_NAME - rtprio 20` in "
          "/etc/security/limits.d/slosh.conf lets it, from the next login on.\n";
  }
  if (!s.devices.empty()) {
    for (const DeviceSummary& d : s.devices) {
      text += format("%s (%s) felt up to %.1f N and %.2f N·m", d.grip.c_str(), d.device.c_str(), d.peak_force,
                     d.peak_torque);
      if (d.clipped > 0.0)
        text += format(", for %.2g s all that its device gives, and more was asked", d.clipped);
      text += ".\n";
    }
  }
  if (s.rendered) {
    text += format(
        "%s pictures of %d × %d in %s quality, %.0f ms each%s.\n", grouped(s.frames).c_str(), s.width,
        s.height, s.fast_picture ? "fast" : "full", s.frame_ms.p50,
        s.frames_dropped == 0 ? "" : (std::string(", ") + grouped(s.frames_dropped) + " dropped").c_str());
  }
  text += task_words(s.task);
  text += score_words(s.scores);
  text += left_words(s);
  if (s.particles_in_solids > 0)
    text += s.particles_in_solids == 1
                ? "1 fluid particle is inside a solid.\n"
                : grouped(s.particles_in_solids) + " fluid particles are inside solids.\n";
  for (const std::string& body : s.gone) text += body + ".\n";
  text += in_words(s.measured);
  if (s.export_frames > 0) {
    text += format("%s frames for other programs, %.2f s each.\n", grouped(s.export_frames).c_str(),
                   s.export_seconds / static_cast<double>(s.export_frames));
  }
  if (!s.recording.empty()) text += "Recorded to " + s.recording + ".\n";
  if (!s.recording_problem.empty()) text += "The recording is not whole: " + s.recording_problem + ".\n";
  if (!s.verdict.empty()) text += "Compared with the recording: " + s.verdict + ".\n";
  std::string status;
  for (const std::string& words : status_words(s)) status += (status.empty() ? "" : "; ") + words;
  if (!status.empty()) text += "Status: " + status + ".\n";
  if (!s.files.empty()) {
    text += "Written to " + s.folder + ":";
    for (std::size_t i = 0; i < s.files.size(); ++i) text += (i == 0 ? " " : ", ") + s.files[i];
    text += ".\n";
  }
  return clean_lines(text, kMax);
}

Result<bool> write_summary(const std::filesystem::path& file, const RunSummary& summary) {
  return write_whole(file,
                     to_json(summary).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace slosh
