// What stands in for OpenVDB where slosh was built without it (-DSLOSH_OPENVDB=OFF), compiled into this test
// alone.
#include <gtest/gtest.h>

#include "peer/output/export/export_options.h"

namespace slosh {
namespace {

TEST(ExportWithoutOpenVdb, SurfacesAreRefusedInWordsAndParticlesAreNot) {
  EXPECT_FALSE(can_make_surfaces());
  for (const char* word : {"surface:vdb", "surface:ply", "surface:glb"}) {
    const auto refused = parse_exports({"particles:ply", word});
    ASSERT_FALSE(refused) << word;
    EXPECT_NE(refused.error().where.find(word), std::string::npos);
    EXPECT_NE(refused.error().what.find("built without OpenVDB"), std::string::npos) << refused.error().what;
    EXPECT_NE(refused.error().mend.find("libopenvdb-dev"), std::string::npos) << refused.error().mend;
  }
  const auto particles = parse_exports({"particles:ply", "particles:vtu"});
  ASSERT_TRUE(particles);
  EXPECT_EQ(particles.value().size(), 2u);
}

}  // namespace
}  // namespace slosh
