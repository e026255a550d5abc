// sim/math as a CUDA kernel: "index, load, call, store". Built wherever there is a CUDA compiler, so that the
// shared maths stays shared; run by hand where there is a GPU (tests/cross/README.md).
#include <cmath>
#include <cstdio>
#include <vector>

#include "sim/math/coupling.h"
#include "sim/math/distance_field.h"
#include "sim/math/kernels.h"
#include "sim/math/pose.h"
#include "sim/model.h"
#include "sim/passes/density/corrected_state.h"

namespace {

using namespace slosh;

struct PairInput {
  ParticleView<float> p, i;
};

struct PairOutput {
  float poly6, spiky;
  ForceSum<float> paper, corrected, corrected_wall, corrected_body;
  Symmetric<float> directions;
  Wrench hand;
};

__host__ __device__ PairOutput evaluate(const PairInput& in, float h) {
  PairOutput out{};
  const float dx = in.p.x - in.i.x;
  const float dy = in.p.y - in.i.y;
  const float dz = in.p.z - in.i.z;
  const float r_squared = dx * dx + dy * dy + dz * dz;
  out.poly6 = poly6_shape(r_squared, h * h);
  out.spiky = spiky_shape(r_squared, h);
  const DragShape<float> shape{0.8f, 1.1f / h};
  add_pair_force<Spiky, PairRule::kPaper, DragRule::kAlongVelocity, true>(in.p, in.i, h, shape, 1.0f,
                                                                          out.paper);
  add_pair_force<Spiky, PairRule::kCorrected, DragRule::kCentral, true>(in.p, in.i, h, shape, 1.0f,
                                                                        out.corrected);
  add_pair_force<Spiky, PairRule::kCorrectedWall, DragRule::kCentral, true>(in.p, in.i, h, shape, 1.0f,
                                                                            out.corrected_wall);
  add_pair_force<Spiky, PairRule::kCorrectedBody, DragRule::kCentral, true>(in.p, in.i, h, shape, 1.0f,
                                                                            out.corrected_body);
  out.directions = pressure_directions(scaled_and_shifted(in.p.push, 0.3f, 0.8f), corrected_share(dx), 1.3f);
  Pose handle, grip;
  handle.position = {in.p.x, in.p.y, in.p.z};
  grip.position = {in.i.x, in.i.y, in.i.z};
  grip.orientation = rotate_by(grip.orientation, glm::dvec3(in.p.vx, in.p.vy, in.p.vz));
  out.hand = coupling_wrench_on_hand({1000.0, 20.0, 10.0, 0.2}, handle, {}, grip, {});
  return out;
}

__global__ void evaluate_all(const PairInput* in, PairOutput* out, int count, float h) {
  const int index = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (index < count) out[index] = evaluate(in[index], h);
}

float next_random(unsigned& state) {
  state = state * 1664525u + 1013904223u;
  return static_cast<float>(state >> 8) / 16777216.0f;
}

double worst_difference(const std::vector<PairInput>& in, const std::vector<PairOutput>& device, float h) {
  double worst = 0.0;
  const auto compare = [&](double host, double there, double scale) {
    worst = std::fmax(worst, std::abs(host - there) / scale);
  };
  for (std::size_t n = 0; n < in.size(); ++n) {
    const PairOutput host = evaluate(in[n], h);
    compare(host.poly6, device[n].poly6, std::pow(h, 6));
    compare(host.spiky, device[n].spiky, std::pow(h, 3));
    // Towards the support radius the force goes to zero and its relative error with it: the scale has a
    // hundredth of what the pair would do at no distance.
    const double tensor = 0.01 * h * h * 10.0;
    const auto all = [](const ForceSum<float>& f) { return std::abs(f.x) + std::abs(f.y) + std::abs(f.z); };
    compare(host.corrected.y, device[n].corrected.y, all(host.corrected) + tensor);
    compare(host.corrected_wall.y, device[n].corrected_wall.y, all(host.corrected_wall) + tensor);
    compare(host.corrected_body.z, device[n].corrected_body.z, all(host.corrected_body) + tensor);
    compare(host.directions.xy, device[n].directions.xy, 1.0);
    compare(host.directions.zz, device[n].directions.zz, 1.0);
    compare(host.hand.torque.y, device[n].hand.torque.y, 10.0);
  }
  return worst;
}

}  // namespace

int main() {
  int devices = 0;
  if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
    std::puts("no GPU here: compiled, not run");
    return 77;
  }
  const float h = 0.02f;
  unsigned state = 1;
  std::vector<PairInput> in(1 << 16);
  for (PairInput& pair : in) {
    const auto particle = [&] {
      return ParticleView<float>{0.012f * next_random(state),
                                 0.012f * next_random(state),
                                 0.012f * next_random(state),
                                 next_random(state),
                                 next_random(state),
                                 next_random(state),
                                 next_random(state),
                                 next_random(state),
                                 next_random(state),
                                 {next_random(state), next_random(state), next_random(state),
                                  next_random(state), next_random(state), next_random(state)},
                                 next_random(state),
                                 next_random(state),
                                 next_random(state)};
    };
    pair = {particle(), particle()};
  }
  PairInput* device_in = nullptr;
  PairOutput* device_out = nullptr;
  std::vector<PairOutput> out(in.size());
  bool fine =
      cudaMalloc(&device_in, in.size() * sizeof(PairInput)) == cudaSuccess &&
      cudaMalloc(&device_out, out.size() * sizeof(PairOutput)) == cudaSuccess &&
      cudaMemcpy(device_in, in.data(), in.size() * sizeof(PairInput), cudaMemcpyHostToDevice) == cudaSuccess;
  if (fine) {
    evaluate_all<<<static_cast<unsigned>(in.size() / 256), 256>>>(device_in, device_out,
                                                                  static_cast<int>(in.size()), h);
    fine = cudaGetLastError() == cudaSuccess &&
           cudaMemcpy(out.data(), device_out, out.size() * sizeof(PairOutput), cudaMemcpyDeviceToHost) ==
               cudaSuccess;
  }
  if (!fine) {
    std::printf("CUDA failed: %s\n", cudaGetErrorString(cudaGetLastError()));
    return 1;
  }
  const double worst = worst_difference(in, out, h);
  std::printf("%zu pairs, largest relative difference between host and device %.3g\n", in.size(), worst);
  return worst < 1e-4 ? 0 : 1;
}
