#include "peer/output/summary.h"

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "sim/snapshot.h"

namespace slosh {
namespace {

using Json = nlohmann::ordered_json;

Json spread(const Spread& s) {
  return {{"p50", s.p50}, {"p99", s.p99}, {"max", s.max}};
}

template <class... Numbers>
std::string format(const char* pattern, Numbers... numbers) {
  char text[400];
  std::snprintf(text, sizeof text, pattern, numbers...);
  return text;
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
                       {"peak_torque_nm", d.peak_torque}});
  }
  Json json;
  json["scene"] = s.scene;
  json["scene_file"] = s.scene_file;
  json["spacing_m"] = s.spacing;
  json["spacing_reason"] = s.spacing_reason;
  json["particles"] = {
      {"fluid", s.fluid_particles}, {"boundary", s.boundary_particles}, {"retired", s.retired_particles}};
  json["steps"] = s.steps;
  json["time_step_s"] = s.time_step;
  json["simulated_s"] = s.simulated;
  json["wall_s"] = s.wall;
  json["real_time_factor"] = s.real_time_factor;
  json["step_ms"] = spread(s.step_ms);
  json["step_share"] = {
      {"sort", s.share_sort}, {"density", s.share_density}, {"force", s.share_force}, {"body", s.share_body}};
  json["device_loop_us"] = spread(s.device_loop_us);
  json["device_loop_us"]["ticks"] = s.device_ticks;
  json["device_loop_us"]["missed"] = s.device_missed;
  json["device_loop_us"]["scheduler"] = s.device_scheduler;
  json["render"] = {{"on", s.rendered},        {"renderer", s.renderer}, {"width", s.width},
                    {"height", s.height},      {"frames", s.frames},     {"dropped", s.frames_dropped},
                    {"ms", spread(s.frame_ms)}};
  json["status"] = status_words(s.status);
  json["slips"] = {{"count", s.slips}, {"seconds", s.slipped}};
  json["rejected_poses"] = s.rejected_poses;
  json["samples_lost"] = s.samples_lost;
  json["fluid_mass_kg"] = {{"start", s.fluid_mass_start}, {"end", s.fluid_mass_end}};
  json["devices"] = devices;
  json["backend"] = s.backend;
  json["threads"] = s.threads;
  json["machine"] = {{"cpu", s.machine.cpu}, {"cores", s.machine.cores}, {"system", s.machine.system}};
  json["version"] = s.version;
  json["interrupted"] = s.interrupted;
  json["files"] = s.files;
  return json;
}

std::string in_words(const RunSummary& s) {
  std::string text =
      format("%s: %.1f s of %s fluid and %s body particles at %.1f mm in %.1f s (real time × %.2f)",
             s.scene.c_str(), s.simulated, grouped(s.fluid_particles).c_str(),
             grouped(s.boundary_particles).c_str(), 1e3 * s.spacing, s.wall, s.real_time_factor);
  text += s.interrupted ? ", interrupted.\n" : ".\n";
  text += format("A step of %.2f ms took %.2f ms (p99 %.2f) on %d thread%s (%s).\n", 1e3 * s.time_step,
                 s.step_ms.p50, s.step_ms.p99, s.threads, s.threads == 1 ? "" : "s", s.backend.c_str());
  if (!s.devices.empty()) {
    text += format("The device loop ran every %.0f µs (p99 %.0f, longest %.0f, %s missed, %s).\n",
                   s.device_loop_us.p50, s.device_loop_us.p99, s.device_loop_us.max,
                   grouped(s.device_missed).c_str(), s.device_scheduler.c_str());
    for (const DeviceSummary& d : s.devices) {
      text += format("%s (%s) felt up to %.1f N and %.2f N·m.\n", d.grip.c_str(), d.device.c_str(),
                     d.peak_force, d.peak_torque);
    }
  }
  if (s.rendered) {
    text += format(
        "%s pictures of %d × %d, %.0f ms each%s.\n", grouped(s.frames).c_str(), s.width, s.height,
        s.frame_ms.p50,
        s.frames_dropped == 0 ? "" : (std::string(", ") + grouped(s.frames_dropped) + " dropped").c_str());
  }
  if (s.fluid_mass_start > 0.0 && s.retired_particles > 0) {
    text += format("%.2f of %.2f kg of fluid left the domain.\n", s.fluid_mass_start - s.fluid_mass_end,
                   s.fluid_mass_start);
  }
  const std::string status = status_text(s.status);
  if (!status.empty()) text += "Status: " + status + ".\n";
  if (!s.files.empty()) {
    text += "Written to " + s.folder + ":";
    for (std::size_t i = 0; i < s.files.size(); ++i) text += (i == 0 ? " " : ", ") + s.files[i];
    text += ".\n";
  }
  return text;
}

Result<bool> write_summary(const std::filesystem::path& file, const RunSummary& summary) {
  const std::filesystem::path part = file.string() + ".part";
  {
    std::ofstream out(part);
    out << to_json(summary).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    if (!out.flush()) {
      return Error{file.string(), std::string("cannot be written: ") + std::generic_category().message(errno),
                   "Choose another folder with --out"};
    }
  }
  std::error_code code;
  std::filesystem::rename(part, file, code);
  if (code)
    return Error{file.string(), "cannot be written: " + code.message(), "Choose another folder with --out"};
  return true;
}

}  // namespace slosh
