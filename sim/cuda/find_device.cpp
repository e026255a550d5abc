// Whether this machine has a GPU that the program can run on.
#include "sim/backend.h"
#include "sim/cuda/device_buffer.h"
#include "sim/cuda/kernels.h"

namespace slosh {

CudaDevice find_cuda_device() {
  cuda::CallCheck check;
  int count = 0;
  cudaDeviceProp properties{};
  if (check.ok(cudaGetDeviceCount(&count), "no GPU") && count > 0) {
    check.ok(cudaGetDeviceProperties(&properties, 0), "cudaGetDeviceProperties");
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
  return {true, properties.name, ""};
}

}  // namespace slosh
