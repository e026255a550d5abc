// What a person reads when something is wrong, and the verbs that only look.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "process.h"
#include "scenes/load.h"
#include "sim/math/format.h"
#include "tests/support/contains.h"

namespace slosh {
namespace {

using test::contains;
using test::Outcome;
using Arguments = std::vector<std::string>;

/// Fails with `code`, and stderr says every one of `parts`; nothing crashes.
void expect_error(const Arguments& arguments, int code, const std::vector<std::string>& parts) {
  const Outcome outcome = test::slosh(arguments);
  EXPECT_EQ(outcome.code, code) << outcome.err;
  for (const std::string& part : parts) {
    EXPECT_TRUE(contains(outcome.err, part)) << "'" << part << "' is not in:\n" << outcome.err;
  }
}

TEST(Errors, AnUnknownSceneNamesTheKnownOnes) {
  expect_error({"play", "bukket", "--headless"}, 1, {"slosh: ", "bukket", "Did you mean bucket?", "pour"});
  expect_error({"plan", "bukket"}, 1, {"bukket"});
  expect_error({"plan", "bucket", "--backend", "gpu"}, 2, {"gpu", "cuda"});
  expect_error({"check", "nowhere.gltf"}, 1, {"nowhere.gltf"});
}

/// A slip of the finger is answered with what was meant, wherever a word stands for one of a few.
TEST(Errors, MisspeltWordsAreAnsweredWithTheNearest) {
  expect_error({"plya", "bucket"}, 2, {"'plya'", "Did you mean play?"});
  expect_error({"test"}, 2, {"./slosh"});
  expect_error({"play", "--headles"}, 2, {"--headles", "Did you mean --headless?", "slosh play --help"});
  expect_error({"play", "--secnds=3"}, 2, {"Did you mean --seconds?"});
  // An option of other verbs: which.
  expect_error({"check", "bucket", "--overwrite"}, 2,
               {"--overwrite is an option of play, host, join, watch and replay", "slosh check --help"});
  expect_error({"watch", "slosh://x", "--particles=100"}, 2, {"--particles is an option of play and host"});
  expect_error({"sweep", "spoon", "--set", "fluid.viscosity_pas=1,2", "--out", "swept"}, 1,
               {"Did you mean viscosity_pa_s?"});
  expect_error({"sweep", "spoon", "--set", "spon.friction=1", "--out", "swept"}, 1,
               {"'spon'", "Did you mean spoon?"});
  std::filesystem::create_directories(test::test_folder());
  std::ofstream(test::test_folder() / "kitchen.gltf") << "{}";
  expect_error({"check", "kichen.gltf"}, 1, {"there is no such file", "Did you mean kitchen.gltf?"});
}

/// The words of a verb's own verbs too, and the help that is named is theirs.
TEST(Errors, SoAreTheWordsBehindAVerb) {
  expect_error({"report", "errors"}, 2,
               {"report knows no 'errors'", "Did you mean error?", "slosh report --help"});
  expect_error({"links", "nwe", "Zoe"}, 2, {"links knows no 'nwe'", "Did you mean new?"});
  expect_error({"devices", "tset"}, 2, {"devices knows no 'tset'", "Did you mean test?"});
  expect_error({"report", "figure", "14"}, 2, {"14", "slosh report figure --help"});
  expect_error({"report", "error", "--spcing", "0.01"}, 2,
               {"Did you mean --spacing?", "slosh report error --help"});
  expect_error({"report"}, 2, {"slosh report --help"});
}

/// What cannot be met is said before anything is loaded, measured or settled.
TEST(Errors, AnAddressOrAPluginThatIsNoneIsSaidAtOnce) {
  const auto at_once = [](const Arguments& arguments, const std::vector<std::string>& parts) {
    const Outcome outcome = test::slosh(arguments);
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    for (const std::string& part : parts)
      EXPECT_TRUE(contains(outcome.err, part)) << part << " in\n" << outcome.err;
    for (const char* phase : {"measuring", "sampling", "settling"})
      EXPECT_FALSE(contains(outcome.err, phase)) << outcome.err;
  };
  at_once({"host", "bucket", "--listen", "here"}, {"'here'", "no port", "--listen"});
  at_once({"host", "bucket", "--listen", "127.0.0.1:99999"}, {"99999", "--listen"});
  at_once({"host", "bucket", "--listen", "127.0.0.1:0", "--address", "router"}, {"router", "port"});
  const int taken = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(taken, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(getsockname(taken, reinterpret_cast<sockaddr*>(&address), &size), 0);
  at_once({"host", "bucket", "--listen", "127.0.0.1:" + std::to_string(ntohs(address.sin_port))},
          {"in use", "--listen"});
  close(taken);
  at_once({"play", "bucket", "--no-render", "--device", "plugin:nothing.so"},
          {"nothing.so", "cannot be loaded"});
}

/// A table or a list that its disk has no room for is no success; who reads no further has what they want.
TEST(Errors, WhatCouldNotBePrintedIsSaid) {
  std::filesystem::create_directories(test::test_folder());
  const std::string error = (test::test_folder() / "error.txt").string();
  const std::string there = test::program();
  const char* const program = there.c_str();
  const auto code = [&](const std::string& rest) {
    const int status = std::system(format("'%s' %s 2> '%s'", program, rest.c_str(), error.c_str()).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  for (const char* what : {"check bucket --json", "plan bucket", "scenes", "--help"}) {
    EXPECT_EQ(code(std::string(what) + " > /dev/full"), 1) << what;
    EXPECT_TRUE(contains(test::read_text(error), "standard output: not all could be written: No space"))
        << what;
  }
  const std::string ended = (test::test_folder() / "ended.txt").string();
  ASSERT_EQ(std::system(format("{ '%s' plan bucket 2> '%s'; echo $? > '%s'; } | head -1 > /dev/null", program,
                               error.c_str(), ended.c_str())
                            .c_str()),
            0);
  EXPECT_EQ(test::read_text(ended), "0\n");
  EXPECT_EQ(test::read_text(error), "");
}

/// A run that was refused leaves no folder behind.
TEST(Errors, WhatWasRefusedLeavesNoFolder) {
  const std::filesystem::path folder = test::test_folder() / "refused";
  std::filesystem::remove_all(folder);
  expect_error({"play", "bucket", "--no-render", "--spacing", "0.05", "--out", "refused/deep"}, 1, {"50 mm"});
  EXPECT_FALSE(std::filesystem::exists(folder));
  expect_error({"host", "bucket", "--spacing", "0.05", "--out", "refused", "--listen", "127.0.0.1:0"}, 1,
               {"50 mm"});
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(Errors, BadCommandLinesPointToHelp) {
  expect_error({}, 2, {"--help"});
  expect_error({"dance"}, 2, {"dance", "--help"});
  expect_error({"play", "--frobnicate"}, 2, {"--frobnicate", "slosh play --help"});
  expect_error({"play", "--seconds", "soon"}, 2, {"--seconds", "--help"});
  expect_error({"play", "--seconds", "-1"}, 2, {"--seconds"});
  expect_error({"play", "--backend", "abacus"}, 2, {"--backend", "cuda"});
  expect_error({"play", "--spacing", "0.01", "--particles", "10"}, 2, {"--particles"});
  expect_error({"check"}, 2, {"FILE"});
}

TEST(Errors, OptionsThatCannotBeMetSayWhy) {
  expect_error({"play", "--headless", "--backend", "cuda"}, 1, {"CUDA", "--backend cpu"});
  expect_error({"play", "--headless", "--sim-gpu", "63"}, 1, {"--sim-gpu 63", "nvidia-smi"});
  expect_error({"play", "--headless", "--sim-gpu", "1", "--backend", "cpu"}, 1, {"--sim-gpu 1", "CPU"});
  expect_error({"play", "--headless", "--render-gpu", "63", "--seconds", "0.1"}, 1, {"GPU 63", "nvidia-smi"});
  expect_error({"play", "--headless", "--size", "640"}, 1, {"--size", "640x480"});
  expect_error({"play", "--headless", "--spacing", "thin"}, 1, {"--spacing", "thin", "auto"});
  const Arguments quick = {"play", "probe", "--no-render", "--seconds", "0.1", "--spacing", "0.012"};
  const auto with = [&quick](const Arguments& more) {
    Arguments all = quick;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_error(with({"--device", "joystick"}), 1, {"joystick", "script", "replay:FILE"});
  expect_error(with({"--device", "mouse"}), 1, {"mouse", "window"});
  expect_error(with({"--device", "script", "--device", "script"}), 1, {"2 devices", "1 grip"});
  expect_error(with({"--device", "replay:nothing.csv"}), 1, {"nothing.csv"});
  expect_error(with({"--out", "/proc/nowhere"}), 1, {"/proc/nowhere", "--out"});
  expect_error({"play", "bucket", "--no-render", "--spacing", "0.05"}, 1, {"bucket", "50 mm"});
}

TEST(Errors, AReplayWithANaNNamesItsLine) {
  std::filesystem::create_directories(test::test_folder());
  std::ofstream(test::test_folder() / "bad.csv")
      << "time_s,device,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,0,1,0,0,0\n0.1,0,nan,0,0,1,0,0,0\n";
  expect_error({"play", "probe", "--no-render", "--seconds", "0.1", "--spacing", "0.012", "--device",
                "replay:bad.csv"},
               1, {"bad.csv: line 3", "x_m", "nan"});
}

TEST(Errors, FilesThatAreNoScenesAreRefused) {
  std::filesystem::create_directories(test::test_folder());
  std::ofstream(test::test_folder() / "text.gltf") << "not json";
  std::ofstream(test::test_folder() / "empty.glb") << "";
  std::ofstream(test::test_folder() / "bare.gltf") << "{\"asset\":{\"version\":\"2.0\"}}";
  expect_error({"check", "text.gltf"}, 1, {"text.gltf"});
  expect_error({"check", "empty.glb"}, 1, {"empty.glb"});
  expect_error({"check", "bare.gltf"}, 1, {"bare.gltf"});
  expect_error({"play", "text.gltf", "--headless"}, 1, {"text.gltf"});
}

TEST(Errors, CheckSaysEverythingAtOnceAndErrorsApartFromWarnings) {
  std::filesystem::create_directories(test::test_folder());
  nlohmann::json bucket = nlohmann::json::parse(test::read_text(find_scene("bucket").value()));
  bucket.erase("cameras");
  for (nlohmann::json& node : bucket["nodes"]) {
    node.erase("camera");
    if (node["name"] == "water") node["extras"]["density_kg_m3"] = -1;
    if (node["name"] == "table") node["extras"]["friction"] = "rough";
  }
  std::ofstream(test::test_folder() / "two.gltf") << bucket.dump();
  expect_error({"check", "two.gltf"}, 1,
               {"node 'water'", "density_kg_m3", "node 'table'", "friction", "2 errors"});
  EXPECT_TRUE(contains(test::slosh({"check", "two.gltf"}).out, "1 warning"));
  const Outcome outcome = test::slosh({"check", "two.gltf", "--json"});
  EXPECT_EQ(outcome.code, 1);
  const nlohmann::json said = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(said["ok"], false);
  ASSERT_EQ(said["errors"].size(), 2u);
  EXPECT_EQ(said["errors"][0]["object"], "water");
  ASSERT_EQ(said["warnings"].size(), 1u);
  EXPECT_EQ(said["warnings"][0]["kind"], "no-camera");
}

/// What falls out of a domain that is far too large would need endless steps: check says so, and what to do.
TEST(Errors, ADomainWithoutAFloorIsSaidByCheck) {
  std::filesystem::create_directories(test::test_folder());
  nlohmann::json bucket = nlohmann::json::parse(test::read_text(find_scene("bucket").value()));
  bucket["scenes"][0]["extras"]["domain_min_m"] = {-1e9, -1e9, -1e9};
  std::ofstream(test::test_folder() / "deep.gltf") << bucket.dump();
  expect_error({"check", "deep.gltf"}, 1,
               {"time step", "falls to the floor of its domain, 1e+09 m below", "domain_min_m"});
}

/// Kilogrammes and particles lost are of the same: of the run, without what settling lost.
TEST(Verbs, PlayTellsApartWhatSettlingLost) {
  std::filesystem::create_directories(test::test_folder());
  nlohmann::json bucket = nlohmann::json::parse(test::read_text(find_scene("bucket").value()));
  bucket["scenes"][0]["extras"]["gravity_m_s2"] = {0.0, 9.81, 0.0};
  std::ofstream(test::test_folder() / "up.gltf") << bucket.dump();
  const Outcome outcome =
      test::slosh({"play", "up.gltf", "--no-render", "--unpaced", "--seconds", "0.1", "--spacing", "0.012",
                   "--threads", "1", "--out", "out", "--overwrite"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json summary =
      nlohmann::json::parse(test::read_text(test::test_folder() / "out" / "summary.json"));
  const double all = summary["particles"]["fluid"], settling = summary["particles"]["retired_settling"];
  EXPECT_GT(settling, 0.0);
  EXPECT_NEAR(summary["fluid_mass_kg"]["start"].get<double>(), (all - settling) * 1000.0 * std::pow(0.012, 3),
              1e-6);
  EXPECT_TRUE(contains(outcome.out, "spilled over the edge of the domain, while the world settled"))
      << outcome.out;
}

TEST(Verbs, ScenesListsEveryShippedScene) {
  const Outcome outcome = test::slosh({"scenes"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* name : {"bucket", "spoon", "pour", "spin", "pool", "probe", "crepe", "mixer", "vessel"}) {
    EXPECT_TRUE(contains(outcome.out, name)) << name;
  }
}

TEST(Verbs, EveryShippedSceneChecksAndPlans) {
  for (const char* name : {"bucket", "spoon", "pour", "spin", "pool", "probe", "crepe", "mixer", "vessel"}) {
    const Outcome check = test::slosh({"check", name});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_EQ(check.out.rfind("ok", 0), 0u) << check.out;
    EXPECT_TRUE(contains(check.out, "litres"));
    const Outcome plan = test::slosh({"plan", name});
    EXPECT_EQ(plan.code, 0) << plan.err;
    EXPECT_TRUE(contains(plan.out, "density")) << plan.out;
    for (const char* number :
         {"settles 1 s before the run", "m of fluid", "compresses the fluid by", "sound number",
          "viscous number", "of fluid and", "MB", "a step          about", " ms on C", "carried out     "})
      EXPECT_TRUE(contains(plan.out, number)) << number << " in " << plan.out;
  }
}

TEST(Verbs, HelpExplainsWithExamples) {
  const Outcome all = test::slosh({"--help"});
  EXPECT_EQ(all.code, 0);
  for (const char* verb : {"play", "scenes", "check", "plan"}) {
    EXPECT_TRUE(contains(all.out, verb));
    const Outcome one = test::slosh({verb, "--help"});
    EXPECT_EQ(one.code, 0);
    EXPECT_TRUE(contains(one.out, "Example")) << verb;
  }
  // No line runs on: what options are for is wrapped, the rest written so.
  std::istringstream verbs(all.out);
  for (std::string line; std::getline(verbs, line);) EXPECT_LE(line.size(), 120u) << line;
  for (const char* verb : {"play", "host", "join", "watch", "replay", "links", "devices", "scenes", "check",
                           "plan", "sweep", "report", "settings"}) {
    std::istringstream lines(test::slosh({verb, "--help"}).out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << verb << ": " << line;
  }
  EXPECT_TRUE(contains(test::slosh({"play", "--help"}).out, "wrench on the hand"));
  EXPECT_TRUE(contains(test::slosh({"--version"}).out, "slosh "));
}

}  // namespace
}  // namespace slosh
