// The shipped bucket and its water in several hands far away, over a bad link, in virtual time: the cells of
// `slosh report coupling` that take the longest, of which some stand here for all.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/lab/coupling/cells.h"
#include "tests/lab/coupling/particle_host.h"

namespace slosh::coupling {
namespace {

/// 300 ms, 40 ms of jitter, 20 % lost each way, six axes, every other hand the other way: the fewest and the
/// most hands, the softest and the hardest hold, tight and loose.
TEST(BucketAtADistance, IsSteadyInSeveralHandsOverABadLink) {
  const std::shared_ptr<const Bucket> bucket = load_bucket().value();
  int tried = 0;
  for (Case c : bucket_cases(bucket)) {
    const bool both = c.jitter > 0.0 && c.loss > 0.0;
    const bool corner = (c.hands == 2 && c.stiffness == 2000.0) || (c.hands == 8 && c.stiffness == 200.0);
    if (!both || !corner) continue;
    c.round_trip = kBucketRoundTrip;
    const Outcome r = run(c, Scheme::kReplica);
    std::printf("%-34s %s, %.2g mJ generated, peak %.1f N, swing %.2f mm/s\n", c.name.c_str(),
                word(r.verdict), 1e3 * r.generated, r.peak, 1e3 * r.swing);
    EXPECT_EQ(r.verdict, Verdict::kStable) << c.name;
    EXPECT_LE(r.generated, 1e-3) << c.name;
    ++tried;
  }
  EXPECT_EQ(tried, 4);
}

/// The same cells do break a spring at the peer, so they say something.
TEST(BucketAtADistance, ASpringAtThePeerIsNotSteadyThere) {
  const std::shared_ptr<const Bucket> bucket = load_bucket().value();
  int tried = 0;
  for (Case c : bucket_cases(bucket)) {
    if (c.hands != 2 || c.stiffness != 2000.0 || c.loss == 0.0 || c.jitter == 0.0) continue;
    c.round_trip = kBucketRoundTrip;
    const Outcome r = run(c, Scheme::kPeerSpring);
    std::printf("%-34s by a spring: %s, %.2g J generated, peak %.1f N\n", c.name.c_str(), word(r.verdict),
                r.generated, r.peak);
    EXPECT_NE(r.verdict, Verdict::kStable) << c.name;
    EXPECT_GT(r.generated, 0.1) << c.name;
    ++tried;
  }
  EXPECT_EQ(tried, 2);
}

}  // namespace
}  // namespace slosh::coupling
