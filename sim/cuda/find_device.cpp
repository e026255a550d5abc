// Whether this machine has a GPU that the program can run on.
#include "sim/backend.h"
#include "sim/cuda/device_buffer.h"
#include "sim/cuda/kernels.h"

namespace slosh {

CudaDevice find_cuda_device(int gpu) {
  cuda::CallCheck check;
  int count = 0;
  cudaDeviceProp properties{};
  if (check.ok(cudaGetDeviceCount(&count), "no GPU") && gpu >= 0 && gpu < count) {
    check.ok(cudaGetDeviceProperties(&properties, gpu), "cudaGetDeviceProperties");
    check.ok(cudaSetDevice(gpu), "choosing the GPU");
    // Runs something: a GPU that this program has no code for is found here.
    cuda::DeviceBuffer<float4> probe;
    probe.allocate(1, check);
    if (!check.failed()) {
      cuda::launch_damp(probe.data(), 1, 1.0f, nullptr);
      check.launched("the GPU cannot run this program's code");
      check.ok(cudaDeviceSynchronize(), "the GPU does not answer");
    }
  }
  cudaGetLastError();  // what was asked here is no one else's error
  if (check.failed()) return {false, "", check.failure()};
  if (count == 0) return {false, "", "no GPU"};
  if (gpu < 0 || gpu >= count)
    return {false, "",
            "there is no GPU " + std::to_string(gpu) + ": the last is GPU " + std::to_string(count - 1)};
  return {true, properties.name, ""};
}

}  // namespace slosh
