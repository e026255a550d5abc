// `slosh check` is a doctor that runs: it says ok only of what works, and a run with nothing to feel does not
// end well.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "process.h"
#include "scenes/load.h"
#include "scenes/make/solid.h"
#include "scenes/make/writer.h"
#include "tests/support/contains.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::contains;
using test::Outcome;

/// A cup that a hand holds, with water in it.
struct Cup {
  json scene{{"title", "a cup"}, {"spacing_m", 0.012}, {"duration_s", 0.3}};
  json body{{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}};
  double size = 1.0;
  make::Solid water = make::box({-0.05, 0.02, -0.05}, {0.05, 0.09, 0.05});
  make::Solid vessel = make::tank({0.1, 0.12, 0.1}, 0.02);
  bool held = true;
  glm::dvec3 at{0.0};

  void write(const std::string& name) const {
    const glm::dmat4 scale{glm::dmat3(size)};
    make::SceneWriter writer(scene);
    const int paint = writer.add_material("paint", {});
    const Pose pose{at, {1.0, 0.0, 0.0, 0.0}};
    const int node =
        writer.add_node("cup", writer.add_mesh("cup", make::transformed(vessel, scale), paint), pose, body);
    if (!water.triangles.empty())
      writer.add_node("water", writer.add_mesh("water", make::transformed(water, scale), paint), pose,
                      {{"slosh", "fluid"}});
    const Pose grip{{0.0, 0.1 * size, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    if (held) {
      writer.add_node("handle", -1, grip, {{"slosh", "grip"}, {"stiffness_n_m", 3000.0}}, node);
      writer.add_hand("hand", "handle", [=](double) { return compose(pose, grip); }, 0.3);
    }
    writer.add_camera({0.3, 0.4, 0.5}, {0.0, 0.05, 0.0}, 40.0);
    std::filesystem::create_directories(test::test_folder());
    ASSERT_TRUE(writer.write(test::test_folder() / name));
  }
};

struct Said {
  int code = 0;
  json all;
  std::set<std::string> kinds;
  std::string text;
};

Said check(const std::string& name, std::vector<std::string> more = {}) {
  std::vector<std::string> words{"check", name, "--json"};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = test::slosh(words);
  Said said{outcome.code, json::parse(outcome.out), {}, outcome.out};
  for (const char* list : {"errors", "warnings"})
    for (const json& finding : said.all[list]) said.kinds.insert(finding["kind"].get<std::string>());
  return said;
}

class CheckTest : public ::testing::Test {
 protected:
  void SetUp() override { test::empty_folder(); }
};

TEST_F(CheckTest, ASoundSceneRestsAndSaysHowWell) {
  Cup().write("cup.gltf");
  const Said said = check("cup.gltf");
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_TRUE(said.kinds.empty()) << said.text;
  const json& hand = said.all["rest"]["hands"][0];
  EXPECT_EQ(hand["grip"], "handle");
  EXPECT_TRUE(hand["steady"]) << said.text;
  // It holds what hangs there: half a kilo of cup and seven tenths of water.
  EXPECT_NEAR(hand["force_n"].get<double>(), 9.81 * (0.5 + 0.7), 0.4) << said.text;
  EXPECT_TRUE(contains(test::slosh({"check", "cup.gltf"}).out, "handle feels"));
}

TEST_F(CheckTest, StaticLooksAtTheFileAlone) {
  Cup cup;
  cup.scene["settle_s"] = 0;
  cup.write("cup.gltf");
  EXPECT_TRUE(check("cup.gltf").kinds.contains("restless"));
  const Said still = check("cup.gltf", {"--static"});
  EXPECT_TRUE(still.kinds.empty()) << still.text;
  EXPECT_FALSE(still.all.contains("rest"));
}

TEST_F(CheckTest, AStartThatIsNotAtRestIsSaidWithItsNumber) {
  Cup cup;
  cup.scene["settle_s"] = 0;
  cup.write("cup.gltf");
  const Said said = check("cup.gltf");
  EXPECT_EQ(said.code, 0);
  EXPECT_EQ(said.kinds, std::set<std::string>{"restless"}) << said.text;
  EXPECT_TRUE(contains(said.text, "give or take"));
  EXPECT_TRUE(contains(said.text, "settle_s"));
}

TEST_F(CheckTest, FluidThatLiesInNoVessel) {
  Cup beside;
  beside.water = make::box({0.3, 0.02, -0.05}, {0.4, 0.09, 0.05});
  beside.scene["domain_min_m"] = {-1.0, -4.0, -1.0};
  beside.scene["domain_max_m"] = {1.0, 1.0, 1.0};
  beside.write("beside.gltf");
  const Said said = check("beside.gltf");
  EXPECT_EQ(said.code, 0) << "it plays: " << said.text;
  EXPECT_TRUE(said.kinds.contains("no-vessel") && said.kinds.contains("spills")) << said.text;
}

TEST_F(CheckTest, FluidThatAllLeavesWhileSettlingEndsNoRunWell) {
  Cup gone;
  gone.water = make::box({0.3, 0.02, -0.05}, {0.4, 0.09, 0.05});
  gone.scene["domain_min_m"] = {-1.0, -0.1, -1.0};
  gone.scene["domain_max_m"] = {1.0, 1.0, 1.0};
  gone.write("gone.gltf");
  const Said said = check("gone.gltf");
  EXPECT_EQ(said.code, 1) << said.text;
  EXPECT_TRUE(contains(said.text, "all of its fluid left the domain while the world settled")) << said.text;
  const Outcome run = test::slosh({"play", "gone.gltf", "--no-render", "--unpaced", "--out", "out"});
  EXPECT_EQ(run.code, 1) << run.out;
  EXPECT_TRUE(contains(run.err, "all of its fluid left the domain")) << run.err;
  EXPECT_TRUE(contains(run.err, "settle_s = 0")) << run.err;
}

TEST_F(CheckTest, AVesselWithAGapIsToldByWhatRunsOut) {
  Cup leaking;
  // The water stands higher than the cup's rim: what is above it runs over.
  leaking.water = make::box({-0.05, 0.02, -0.05}, {0.05, 0.25, 0.05});
  leaking.write("leaking.gltf");
  const Said said = check("leaking.gltf");
  EXPECT_TRUE(said.kinds.contains("spills")) << said.text;
  EXPECT_TRUE(contains(said.text, "fluid particles")) << said.text;
}

TEST_F(CheckTest, ALayerThinnerThanAParticle) {
  Cup tray;
  tray.vessel = make::tank({0.4, 0.06, 0.4}, 0.02);
  tray.water = make::box({-0.2, 0.02, -0.2}, {0.2, 0.026, 0.2});  // 0.96 litres, 6 mm deep
  tray.held = false;
  tray.body = {{"slosh", "body"}};
  tray.write("tray.gltf");
  const Said coarse = check("tray.gltf", {"--spacing", "0.012"});
  // Half a spacing deep: it is refused before it is found to be thin.
  EXPECT_TRUE(contains(coarse.text, "thinner than a particle")) << coarse.text;
  EXPECT_TRUE(contains(coarse.text, "'water'")) << coarse.text;
  Cup deep = tray;
  deep.water = make::box({-0.2, 0.02, -0.2}, {0.2, 0.06, 0.2});
  deep.write("deep.gltf");
  EXPECT_FALSE(check("deep.gltf", {"--spacing", "0.012"}).kinds.contains("thin-layer"));
}

TEST_F(CheckTest, TwoFluidsInOnePlace) {
  Cup().write("cup.gltf");
  json j = json::parse(test::read_text(test::test_folder() / "cup.gltf"));
  for (const json& node : json(j["nodes"])) {
    if (node["name"] != "water") continue;
    json oil = node;
    oil["name"] = "oil";
    oil["translation"] = {0.0, 0.02, 0.0};
    oil["extras"]["density_kg_m3"] = 900.0;
    j["nodes"].push_back(oil);
    j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
  }
  std::ofstream(test::test_folder() / "two.gltf") << j.dump();
  const Said said = check("two.gltf");
  // The second finds no room: it is refused before the place is found to be shared.
  EXPECT_TRUE(contains(said.text, "another fluid is where it would be")) << said.text;
  EXPECT_TRUE(contains(said.text, "'oil'")) << said.text;
}

TEST_F(CheckTest, SizesInAnotherUnit) {
  Cup millimetres;
  millimetres.size = 1000.0;
  millimetres.scene.erase("spacing_m");
  millimetres.write("mm.gltf");
  const Said far = check("mm.gltf", {"--static"});
  EXPECT_TRUE(contains(far.text, "millimetres")) << far.text;
  Cup centimetres;
  centimetres.size = 100.0;
  centimetres.scene = {{"title", "cm"}, {"spacing_m", 1.0}};
  centimetres.write("cm.gltf");
  const Said large = check("cm.gltf", {"--static"});
  EXPECT_TRUE(large.kinds.contains("units")) << large.text;
  EXPECT_TRUE(contains(large.text, "centimetres")) << large.text;
}

TEST_F(CheckTest, AKilometreFromTheOriginIsRefusedByCheckAndByARun) {
  Cup far;
  far.at = {1000.0, 0.0, 0.0};
  far.write("far.gltf");
  const Said said = check("far.gltf");
  EXPECT_EQ(said.code, 1) << said.text;
  EXPECT_TRUE(contains(said.text, "1000 m from the scene's origin")) << said.text;
  EXPECT_EQ(test::slosh({"play", "far.gltf", "--no-render", "--unpaced", "--out", "out"}).code, 1);
}

TEST_F(CheckTest, ARunWhoseHandsCouldNeverActDoesNotEndWell) {
  Cup elsewhere;
  elsewhere.water = {};
  elsewhere.scene["domain_min_m"] = {100.0, 0.0, 0.0};
  elsewhere.scene["domain_max_m"] = {101.0, 1.0, 1.0};
  elsewhere.write("elsewhere.gltf");
  EXPECT_TRUE(check("elsewhere.gltf").kinds.contains("hand-out-of-reach"));
  const Outcome run = test::slosh({"play", "elsewhere.gltf", "--no-render", "--unpaced", "--spacing", "0.012",
                                   "--device", "script", "--out", "out"});
  EXPECT_EQ(run.code, 1) << run.out << run.err;
  EXPECT_TRUE(contains(run.err, "nothing was held by 'handle'")) << run.err;
  EXPECT_TRUE(contains(run.err, "more than 5 m outside the scene")) << run.err;
}

TEST_F(CheckTest, TheLedgerIsSaidAtTheTopOfARunToo) {
  Cup().write("cup.gltf");
  json j = json::parse(test::read_text(test::test_folder() / "cup.gltf"));
  for (json& mesh : j["meshes"]) {
    if (mesh["name"] != "cup") continue;
    for (json& primitive : mesh["primitives"])
      primitive["targets"] = {{{"POSITION", primitive["attributes"]["POSITION"]}}};
    mesh["weights"] = {1.0};
  }
  std::ofstream(test::test_folder() / "keyed.gltf") << j.dump();
  EXPECT_EQ(check("keyed.gltf", {"--static"}).kinds, std::set<std::string>{"shape-key"});
  const Outcome run = test::slosh({"play", "keyed.gltf", "--no-render", "--unpaced", "--out", "out"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "shape key")) << run.err;
}

TEST_F(CheckTest, NamesThatBeginWithADashOrAreInCapitals) {
  Cup().write("-cup.glb");
  std::filesystem::copy(test::test_folder() / "-cup.glb", test::test_folder() / "CUP.GLB");
  for (const char* name : {"-cup.glb", "CUP.GLB", "./-cup.glb"})
    EXPECT_EQ(test::slosh({"check", name, "--static"}).code, 0) << name;
  const Outcome none = test::slosh({"check", "-nothing.glb"});
  EXPECT_NE(none.code, 0) << "what is no file is an option, and there is none such";
}

TEST_F(CheckTest, ParticlesAreCountedInPowersOfTenToo) {
  Cup().write("cup.gltf");
  const Outcome run = test::slosh({"play", "cup.gltf", "--no-render", "--unpaced", "--seconds", "0.01",
                                   "--particles", "5e2", "--out", "out"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "asked for 500 fluid particles")) << run.err;
  for (const char* wrong : {"5.5", "many", "1e99", "-3", "0"})
    EXPECT_EQ(test::slosh({"play", "cup.gltf", "--particles", wrong}).code, 2) << wrong;
}

}  // namespace
}  // namespace slosh
