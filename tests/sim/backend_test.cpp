#include "sim/backend.h"

#include <gtest/gtest.h>

#include "sim/world.h"
#include "tests/support/tank.h"

namespace slosh {
namespace {

using testing::make_tank;
using testing::Tank;

Result<World> tank_on(Backend backend) {
  const Tank tank = make_tank({});
  return make_world(tank.scene, tank.sampled, make_plan(tank.scene, tank.sampled.spacing), {1, backend});
}

TEST(Backend, HasNames) {
  for (const Backend backend : {Backend::kAuto, Backend::kCpu, Backend::kCuda}) {
    EXPECT_EQ(backend_named(backend_name(backend)), backend);
  }
  EXPECT_EQ(backend_named("cpu"), Backend::kCpu);
  EXPECT_EQ(backend_named("CPU"), std::nullopt);
  EXPECT_EQ(backend_named(""), std::nullopt);
}

TEST(Backend, CudaIsThereOrSaysWhyNot) {
  std::string reason;
  const bool there = cuda_available(&reason);
  EXPECT_EQ(there, reason.empty()) << reason;
  const CudaDevice device = find_cuda_device();
  EXPECT_EQ(device.available, there);
  EXPECT_EQ(device.name.empty(), !there);
}

TEST(Backend, AGpuThatIsNotThereIsSaid) {
  for (const int gpu : {-1, 63}) {
    const CudaDevice device = find_cuda_device(gpu);
    EXPECT_FALSE(device.available);
    EXPECT_FALSE(device.reason.empty());
  }
}

// Asked for by name, the GPU is used or an error says what to do; it is never quietly the CPU.
TEST(Backend, AskingForCudaGivesCudaOrAnError) {
  Result<World> world = tank_on(Backend::kCuda);
  if (cuda_available()) {
    ASSERT_TRUE(world) << world.error().text();
    EXPECT_EQ(world.value().backend().rfind("CUDA, ", 0), 0u);
    return;
  }
  ASSERT_FALSE(world);
  EXPECT_FALSE(world.error().what.empty());
  EXPECT_NE(world.error().mend.find("CPU"), std::string::npos);
}

// On a GPU four threads share a particle of few, one has a particle of many to itself; the processor's is the
// same at any count.
TEST(Backend, ItsVariantGoesByTheCount) {
  const Tank tank = make_tank({});
  const Plan plan = make_plan(tank.scene, tank.sampled.spacing);
  const auto words = [&](std::uint32_t count, Backend on) { return variant_in_words(plan, count, on); };
  EXPECT_NE(words(1000, Backend::kCpu).find(" neighbours at a time ("), std::string::npos);
  EXPECT_EQ(words(1000, Backend::kCpu), words(1'000'000, Backend::kCpu));
  if (!cuda_available()) return;
  EXPECT_EQ(words(60'000, Backend::kCuda).rfind("4 threads a particle (no more than 60 thousand", 0), 0u)
      << words(60'000, Backend::kCuda);
  EXPECT_EQ(words(60'001, Backend::kCuda).rfind("1 thread a particle (more than 60 thousand", 0), 0u)
      << words(60'001, Backend::kCuda);
}

// No model is one backend's alone.
TEST(Backend, AutoTakesTheSameForEveryModel) {
  for (const ParticleModel model :
       {ParticleModel::kPaper, ParticleModel::kCorrected, ParticleModel::kIncompressible}) {
    Tank tank = make_tank({});
    tank.scene.model = model;
    Result<World> world = make_world(tank.scene, tank.sampled, make_plan(tank.scene, tank.sampled.spacing),
                                     {1, Backend::kAuto});
    ASSERT_TRUE(world) << name(model);
    EXPECT_EQ(world.value().backend().rfind(cuda_available() ? "CUDA, " : "CPU, ", 0), 0u) << name(model);
    for (int i = 0; i < 3; ++i) world.value().step({});
    EXPECT_EQ(world.value().failure(), "") << name(model);
    EXPECT_EQ(world.value().take_status(), 0u) << name(model);
  }
}

TEST(Backend, AutoTakesWhatThereIs) {
  Result<World> world = tank_on(Backend::kAuto);
  ASSERT_TRUE(world);
  EXPECT_EQ(world.value().backend().rfind(cuda_available() ? "CUDA, " : "CPU, ", 0), 0u);
  world.value().step({});
  EXPECT_EQ(world.value().take_status(), 0u);
  EXPECT_EQ(world.value().failure(), "");
}

TEST(Backend, FactoryAndConstructorGiveTheSameWorld) {
  const Tank tank = make_tank({});
  World constructed(tank.scene, tank.sampled, make_plan(tank.scene, tank.sampled.spacing),
                    {1, Backend::kCpu});
  Result<World> made = tank_on(Backend::kCpu);
  ASSERT_TRUE(made);
  EXPECT_EQ(made.value().backend(), "CPU, 1 thread");
  for (int i = 0; i < 20; ++i) {
    constructed.step({});
    made.value().step({});
  }
  EXPECT_EQ(made.value().hash(), constructed.hash());
}

}  // namespace
}  // namespace slosh
