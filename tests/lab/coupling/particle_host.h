// A host of the coupling study with the shipped bucket and its water: the real world's particles and models.
#pragma once

#include <memory>
#include <vector>

#include "scenes/sample.h"
#include "scenes/scene.h"
#include "sim/fluid_models.h"
#include "sim/world.h"
#include "tests/lab/coupling/study.h"
#include "tests/lab/coupling/study_host.h"

namespace slosh::coupling {

/// The shipped bucket, sampled: the same for every case.
struct Bucket {
  Scene scene;
  SampledScene sampled;
  double spacing = 0.0;  ///< m between particles
};
/// Errors: the shipped scene is not there.
Result<std::shared_ptr<const Bucket>> load_bucket(double spacing = 0.014);

/// As many grips as hands on a circle through its two handles, each as stiff as the case says. It has settled
/// in them.
class ParticleHost final : public StudyHost {
 public:
  /// `c.bucket` is there.
  ParticleHost(const Case& c, double time_step);

  void step(const std::vector<HandWord>& hands) override;

 private:
  void look();

  Scene scene_;
  World world_;
  FluidModels models_;
  std::size_t at_;  // the bucket, of the bodies
  std::vector<char> wanted_;
  BodySnapshot now_;
  std::vector<FluidWrenchModel> said_;
};

}  // namespace slosh::coupling
