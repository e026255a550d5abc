#include "peer/output/export/exporter.h"

#include <cmath>
#include <utility>

#include "net/clock.h"
#include "peer/output/export/fluid_surface.h"
#include "peer/output/export/particle_files.h"
#include "peer/output/export/surface_files.h"
#include "peer/output/whole_file.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxWaitingBytes = std::size_t{512} << 20;
constexpr double kRounding = 1e-9;  // s

std::size_t bytes_of(const ParticleFrame& frame) {
  return frame.size() * (2 * sizeof(glm::vec3) + sizeof(float) + sizeof(std::uint32_t) + 1);
}

}  // namespace

Result<std::unique_ptr<Exporter>> Exporter::create(const ExportedFluids& fluids, const ExportOptions& options,
                                                   const std::filesystem::path& folder) {
  const std::filesystem::path frames = folder / "frames";
  std::error_code code;
  std::filesystem::create_directories(frames, code);
  if (code)
    return Error{frames.string(), "cannot be made: " + code.message(), "Choose another folder with --out"};
  Result<std::unique_ptr<Table>> table = Table::create(frames / "frames.csv", kFramesHeader);
  if (!table) return table.error();
  std::unique_ptr<Exporter> exporter(new Exporter(fluids, options, frames));
  exporter->table_ = std::move(table.value());
  exporter->thread_ = std::thread([raw = exporter.get()] { raw->run(); });
  return exporter;
}

Exporter::~Exporter() {
  stop();
}

bool Exporter::due(double time) const {
  return time + kRounding >= static_cast<double>(next_) / options_.rate;
}

void Exporter::add(ParticleFrame frame) {
  frame.number = static_cast<std::uint64_t>((frame.time + kRounding) * options_.rate);
  next_ = frame.number + 1;
  const std::size_t bytes = bytes_of(frame);
  std::unique_lock lock(mutex_);
  const auto room = [&] { return queue_.empty() || queued_bytes_ + bytes <= kMaxWaitingBytes; };
  if (options_.waits) changed_.wait(lock, [&] { return stopping_ || room(); });
  if (stopping_ || !problem_.empty()) return;
  if (!room()) {
    report_.left_out += 1;
    return;
  }
  queued_bytes_ += bytes;
  queue_.push_back(std::move(frame));
  changed_.notify_all();
}

void Exporter::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

ExportReport Exporter::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

std::size_t Exporter::waiting() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

std::string Exporter::problem() const {
  const std::lock_guard lock(mutex_);
  if (!problem_.empty()) return problem_;
  if (report_.left_out == 0) return {};
  return format(
      "%llu frames for export are left out, as they came faster than they could be written (a replay, and "
      "--unpaced, wait for them)",
      static_cast<unsigned long long>(report_.left_out));
}

std::vector<std::string> Exporter::files() const {
  if (report().frames == 0) return {};
  std::vector<std::string> names{"frames/frames.csv"};
  for (const ExportKind kind : options_.kinds) {
    names.push_back(std::string("frames/") + stem(kind) + "_*." + extension(kind));
    if (kind == ExportKind::kParticlesVtu) names.emplace_back("frames/particles.pvd");
  }
  return names;
}

void Exporter::run() {
  while (true) {
    ParticleFrame frame;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
      if (queue_.empty()) return;
      frame = std::move(queue_.front());
      queue_.pop_front();
    }
    const std::int64_t begin = steady_now_ns();
    write(frame);
    const std::lock_guard lock(mutex_);
    report_.seconds += to_seconds(steady_now_ns() - begin);
    queued_bytes_ -= bytes_of(frame);
    if (!problem_.empty()) {
      queue_.clear();
      queued_bytes_ = 0;
    }
    changed_.notify_all();
  }
}

void Exporter::write(const ParticleFrame& frame) {
  double surface_volume = -1.0;
  const Result<bool> written = write_files(frame, surface_volume);
  std::string problem = written ? std::string() : written.error().text();
  if (written) {
    const double volume =
        static_cast<double>(frame.size()) * fluids_.spacing * fluids_.spacing * fluids_.spacing;
    table_->add(format("%llu,%.9g,%zu,%.9g,", static_cast<unsigned long long>(frame.number), frame.time,
                       frame.size(), volume) +
                (surface_volume >= 0.0 ? format("%.9g\n", surface_volume) : "\n"));
    if (!table_->flush()) problem = table_->problem();
  }
  const std::lock_guard lock(mutex_);
  if (written) report_.frames += 1;
  if (!problem.empty()) problem_ = "the frames for export have ended: " + problem;
}

Result<bool> Exporter::write_files(const ParticleFrame& frame, double& surface_volume) {
  bool any_surface = false;
  bool vdb = false;
  for (const ExportKind kind : options_.kinds) {
    any_surface = any_surface || is_surface(kind);
    vdb = vdb || kind == ExportKind::kSurfaceVdb;
  }
  SurfaceFrame surface;
  if (any_surface) {
    surface = make_surfaces(frame, fluids_, vdb, options_.threads);
    surface_volume = 0.0;
    for (const FluidSurface& fluid : surface.fluids) surface_volume += fluid.volume;
  }
  for (const ExportKind kind : options_.kinds) {
    const std::filesystem::path file = file_of(kind, frame.number);
    std::string bytes;
    switch (kind) {
      case ExportKind::kParticlesPly:
        bytes = particles_as_ply(frame, fluids_);
        break;
      case ExportKind::kParticlesVtu:
        bytes = particles_as_vtu(frame, fluids_);
        break;
      case ExportKind::kSurfacePly:
        bytes = surface_as_ply(surface, frame, fluids_);
        break;
      case ExportKind::kSurfaceGlb:
        bytes = surface_as_glb(surface, frame, fluids_);
        break;
      case ExportKind::kSurfaceVdb:
        bytes = std::move(surface.vdb);
        break;
    }
    if (const Result<bool> written = write_whole(file, bytes); !written) return written;
    if (kind != ExportKind::kParticlesVtu) continue;
    vtu_files_.push_back(file.filename().string());
    vtu_times_.push_back(frame.time);
    const Result<bool> listed =
        write_whole(folder_ / "particles.pvd", vtu_collection(vtu_files_, vtu_times_));
    if (!listed) return listed;
  }
  return true;
}

std::filesystem::path Exporter::file_of(ExportKind kind, std::uint64_t number) const {
  return folder_ /
         format("%s_%05llu.%s", stem(kind), static_cast<unsigned long long>(number), extension(kind));
}

}  // namespace slosh
