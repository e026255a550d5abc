#include "sim/cuda/shared_slots.h"

#include <cuda.h>
#include <cuda_runtime.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <string>

namespace slosh::cuda {
namespace {

/// One is drawn from, one waits to be, two may still be read by the GPU; two for a film that lags.
constexpr std::size_t kSlots = 6;
constexpr std::size_t kAlignment = 256;

std::size_t whole(std::size_t bytes, std::size_t of) {
  return (bytes + of - 1) / of * of;
}

/// The driver's calls for memory that can be exported: the runtime has none. Looked up, so that nothing links
/// to it.
struct Driver {
  decltype(&cuMemGetAllocationGranularity) granularity = nullptr;
  decltype(&cuMemCreate) create = nullptr;
  decltype(&cuMemRelease) release = nullptr;
  decltype(&cuMemAddressReserve) reserve = nullptr;
  decltype(&cuMemAddressFree) give_back = nullptr;
  decltype(&cuMemMap) map = nullptr;
  decltype(&cuMemUnmap) unmap = nullptr;
  decltype(&cuMemSetAccess) allow = nullptr;
  decltype(&cuMemExportToShareableHandle) export_to = nullptr;

  bool find() {
    return look_up("cuMemGetAllocationGranularity", granularity) && look_up("cuMemCreate", create) &&
           look_up("cuMemRelease", release) && look_up("cuMemAddressReserve", reserve) &&
           look_up("cuMemAddressFree", give_back) && look_up("cuMemMap", map) &&
           look_up("cuMemUnmap", unmap) && look_up("cuMemSetAccess", allow) &&
           look_up("cuMemExportToShareableHandle", export_to);
  }

 private:
  template <class Call>
  static bool look_up(const char* name, Call& call) {
    void* found = nullptr;
#if CUDART_VERSION >= 12050
    const cudaError_t code =
        cudaGetDriverEntryPointByVersion(name, &found, CUDART_VERSION, cudaEnableDefault, nullptr);
#else
    const cudaError_t code = cudaGetDriverEntryPoint(name, &found, cudaEnableDefault);
#endif
    static_cast<void>(cudaGetLastError());  // a call that is not there is no one else's error
    std::memcpy(&call, &found, sizeof call);
    return code == cudaSuccess && found != nullptr;
  }
};

std::uint64_t next_allocation() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

struct SharedSlots::Memory {
  Memory() = default;
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() {
    if (descriptor >= 0) close(descriptor);
    if (mapped) driver.unmap(address, bytes);
    if (address != 0) driver.give_back(address, bytes);
    if (created) driver.release(handle);  // who opened it keeps it
  }

  /// What failed, in words; nothing where all went well.
  const char* start(std::size_t particles) {
    if (!driver.find()) return "this driver lacks the calls for it";
    int ordinal = 0;
    cudaDeviceProp properties{};
    if (cudaGetDevice(&ordinal) != cudaSuccess ||
        cudaGetDeviceProperties(&properties, ordinal) != cudaSuccess)
      return "the GPU does not say which it is";
    std::memcpy(device.data(), properties.uuid.bytes, device.size());
    CUmemAllocationProp wanted{};
    wanted.type = CU_MEM_ALLOCATION_TYPE_PINNED;
    wanted.requestedHandleTypes = CU_MEM_HANDLE_TYPE_POSIX_FILE_DESCRIPTOR;
    wanted.location.type = CU_MEM_LOCATION_TYPE_DEVICE;
    wanted.location.id = ordinal;
    std::size_t unit = 0;
    if (driver.granularity(&unit, &wanted, CU_MEM_ALLOC_GRANULARITY_RECOMMENDED) != CUDA_SUCCESS || unit == 0)
      return "this GPU has no memory that can be exported";
    count = particles;
    fluids = whole(3 * sizeof(float) * count, kAlignment);
    slot_bytes = fluids + whole(count, kAlignment);
    bytes = whole(kSlots * slot_bytes, unit);
    created = driver.create(&handle, bytes, &wanted, 0) == CUDA_SUCCESS;
    if (!created) return "there is no memory left that can be exported";
    if (driver.reserve(&address, bytes, 0, 0, 0) != CUDA_SUCCESS) return "no addresses are left";
    mapped = driver.map(address, bytes, 0, handle, 0) == CUDA_SUCCESS;
    CUmemAccessDesc access{};
    access.location = wanted.location;
    access.flags = CU_MEM_ACCESS_FLAGS_PROT_READWRITE;
    if (!mapped || driver.allow(address, bytes, &access, 1) != CUDA_SUCCESS) return "it cannot be mapped";
    if (driver.export_to(&descriptor, handle, CU_MEM_HANDLE_TYPE_POSIX_FILE_DESCRIPTOR, 0) != CUDA_SUCCESS)
      return "the driver does not export it";
    return nullptr;
  }

  Driver driver;
  std::uint64_t allocation = next_allocation();
  std::array<std::uint8_t, 16> device{};
  std::size_t count = 0;
  std::size_t fluids = 0;  ///< byte in a slot
  std::size_t slot_bytes = 0;
  std::size_t bytes = 0;
  CUmemGenericAllocationHandle handle = 0;
  CUdeviceptr address = 0;
  int descriptor = -1;
  bool created = false;
  bool mapped = false;
  std::array<std::atomic<bool>, kSlots> taken{};
};

Result<bool> SharedSlots::start(std::size_t count) {
  if (memory_) return true;
  auto memory = std::make_shared<Memory>();
  const char* wrong = count == 0 ? "there are none" : memory->start(count);
  if (wrong)
    return Error{"particles for the picture", std::string("CUDA shares no memory: ") + wrong,
                 "Nothing needs to be done: they go through main memory"};
  memory_ = std::move(memory);
  return true;
}

SharedSlots::Slot SharedSlots::take() const {
  if (!memory_) return {};
  for (std::size_t i = 0; i < kSlots; ++i) {
    if (memory_->taken[i].exchange(true, std::memory_order_acquire)) continue;
    const std::size_t begin = i * memory_->slot_bytes;
    const auto* said =
        new SharedParticles{memory_->allocation,     memory_->descriptor, memory_->bytes, begin,
                            begin + memory_->fluids, memory_->count,      memory_->device};
    const auto give_back = [memory = memory_, i](const SharedParticles* particles) {
      delete particles;
      memory->taken[i].store(false, std::memory_order_release);
    };
    auto* at = reinterpret_cast<std::uint8_t*>(memory_->address + begin);
    return {reinterpret_cast<float*>(at), at + memory_->fluids,
            std::shared_ptr<const SharedParticles>(said, give_back)};
  }
  return {};
}

}  // namespace slosh::cuda
