// Which machine steps the particles.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace slosh {

enum class Backend {
  kAuto,  ///< CUDA where a GPU answers, else the CPU
  kCpu,
  kCuda,
};

/// "auto", "cpu" or "cuda".
const char* backend_name(Backend backend);
/// The reverse; nothing for any other word.
std::optional<Backend> backend_named(std::string_view name);

struct CudaDevice {
  bool available = false;
  std::string name;    ///< of the GPU, empty without one
  std::string reason;  ///< why there is none, in words; empty with one
};

struct Plan;

/// How `fluid` particles of a plan are stepped on kCpu or kCuda (its GPU number `gpu`), and what decided it:
/// one line.
std::string variant_in_words(const Plan& plan, std::uint32_t fluid, Backend backend, int gpu = 0);

/// Asks the machine for its GPU number `gpu`, from 0 as CUDA counts, and whether this program can run on it.
/// Where it was built without CUDA there never is one.
CudaDevice find_cuda_device(int gpu = 0);

/// True where kCuda would work; `reason`, when given, receives why not.
bool cuda_available(std::string* reason = nullptr, int gpu = 0);

}  // namespace slosh
