#include "sim/particle_engine.h"

#include "sim/cpu/cpu_engine.h"
#include "sim/cuda/cuda_engine.h"

namespace slosh {

const char* backend_name(Backend backend) {
  switch (backend) {
    case Backend::kAuto:
      return "auto";
    case Backend::kCpu:
      return "cpu";
    case Backend::kCuda:
      return "cuda";
  }
  return "";
}

std::optional<Backend> backend_named(std::string_view name) {
  for (const Backend backend : {Backend::kAuto, Backend::kCpu, Backend::kCuda}) {
    if (name == backend_name(backend)) return backend;
  }
  return std::nullopt;
}

bool cuda_available(std::string* reason, int gpu) {
  const CudaDevice device = find_cuda_device(gpu);
  if (reason) *reason = device.reason;
  return device.available;
}

std::string variant_in_words(const Plan& plan, std::uint32_t fluid, Backend backend, int gpu) {
  return backend == Backend::kCuda ? cuda_variant(plan, fluid, gpu) : cpu_variant();
}

Result<std::unique_ptr<ParticleEngine>> make_particle_engine(const RunConstants& constants,
                                                             const ParticleStart& start,
                                                             std::span<const RigidBody> bodies,
                                                             const WorldOptions& options) {
  if (options.backend != Backend::kCpu) {
    const CudaDevice device = find_cuda_device(options.gpu);
    if (device.available) {
      Result<std::unique_ptr<ParticleEngine>> engine =
          make_cuda_engine(constants, start, bodies, options.gpu);
      if (engine || options.backend == Backend::kCuda) return engine;
    } else if (options.backend == Backend::kCuda) {
      return Error{"backend cuda", device.reason,
                   "Use the CPU backend (cpu or auto), or a machine with an NVIDIA GPU"};
    }
  }
  return make_cpu_engine(constants, start, bodies, options.threads);
}

}  // namespace slosh
