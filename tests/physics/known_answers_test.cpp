// The cases of `slosh report error` at one spacing each, with what is reached and a little more as the bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

#include "tests/lab/report/error_case.h"
#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

struct Known {
  const char* case_id;
  double spacing;  // m
  const char* quantity;
  double bound;  // of |error|, as the case counts it
  ParticleModel model = ParticleModel::kCorrected;
  double support_ratio = 2.0;
};
void PrintTo(const Known& known, std::ostream* out) {
  *out << known.case_id << ", " << known.quantity;
}

std::string spacing_text(double spacing) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g mm", 1e3 * spacing);
  return text;
}

// A tank at rest at one spacing: the weight is right for any method; the level, what the pressure is inside
// and how the weight jitters are not.
std::vector<Known> still_tank(double spacing, double level, double deep, double gained) {
  return {{"still_tank", spacing, "level", level},
          {"still_tank", spacing, "weight on the walls", 3e-4},
          {"still_tank", spacing, "noise of the weight, rms", 2e-3},
          {"still_tank", spacing, "pressure at 70 mm", deep},
          {"still_tank", spacing, "pressure gained from 30 to 70 mm", gained}};
}

class KnownAnswer : public ::testing::TestWithParam<std::vector<Known>> {};

// Readings of one run. Errors repeat bitwise on one processor; another rounds otherwise, and what is
// chaotic (slow_ball, column) is then another flow: its bounds are wider.
TEST_P(KnownAnswer, is_met) {
  const Known& first = GetParam().front();
  const report::ErrorCase* which = report::find_error_case(first.case_id);
  ASSERT_NE(which, nullptr) << first.case_id;
  report::Setting setting;
  setting.spacing = first.spacing;
  setting.model = first.model;
  setting.support_ratio = first.support_ratio;
  setting.threads = 1;
  report::Cost cost;
  const std::vector<report::Reading> readings = which->run(setting, cost);
  for (const report::Reading& reading : readings) {
    const std::string name =
        std::string(first.case_id) + ", " + spacing_text(first.spacing) + ", " + reading.quantity;
    char text[160];
    std::snprintf(text, sizeof text, "measured %.5g %s, expected %.5g, error %+.2f %%", reading.measured,
                  reading.unit.c_str(), reading.expected, 100.0 * reading.error());
    std::printf("  %s: %s\n", name.c_str(), text);
    RecordProperty(name, text);
  }
  for (const Known& known : GetParam()) {
    const auto reading = std::find_if(readings.begin(), readings.end(),
                                      [&](const report::Reading& r) { return r.quantity == known.quantity; });
    ASSERT_NE(reading, readings.end()) << known.quantity;
    EXPECT_LT(std::abs(reading->error()), known.bound) << known.quantity;
  }
  EXPECT_EQ(cost.retired, 0u);
}

std::string named(const ::testing::TestParamInfo<std::vector<Known>>& p) {
  return std::string(p.param.front().case_id) + "_" +
         std::to_string(std::lround(1e4 * p.param.front().spacing));
}

INSTANTIATE_TEST_SUITE_P(
    error, KnownAnswer,
    ::testing::Values(
        // Without passes/rest_density/rest_density.h the level is 9, 5, 4.5 and 4.3 % too low.
        still_tank(0.02, 0.045, 0.06, 0.155), still_tank(0.0125, 0.016, 0.02, 0.06),
        still_tank(0.01, 0.012, 0.022, 0.035), still_tank(0.008, 0.014, 0.017, 0.015),
        // 0.10 held while artificial viscosity turned the fluid by 4 % faster than its glass
        // (viscosity/neighbour_flow.h); fluid of 2 Pa·s, which has none of it, lacks 12 to 14 %, too: it
        // stands low where its surface meets the wall steeply, by 6 % at 4 mm and 2 % at 2 mm.
        std::vector<Known>{{"paraboloid", 0.0075, "rise over r²", 0.15}},
        // Walls of 1.4 and 1.75 spacings. While what is behind them crowded theirs, and where there is no
        // room for it they counted as thick ones, the plate was lifted by +60 to +70 % at 10 mm and -14 at 8,
        // and the level was -1 and -6 % (tests/notebook/2026-11-26-thin-walls.md).
        std::vector<Known>{{"thin_walls", 0.01, "level in a glass", 0.016},
                           {"thin_walls", 0.01, "lift of a plate", 0.025}},
        std::vector<Known>{{"thin_walls", 0.008, "level in a glass", 0.017},
                           {"thin_walls", 0.008, "lift of a plate", 0.015}},
        // Five slabs: as one solid they lose nothing; each for itself 46 particles, its floor +30 %. While
        // rounding decided whose the particles in an edge are, and boundary layers bent round the ends of
        // hidden faces, the floor had +2 to +6 %, walls -6 to +2 and the centre -1 to +6, by the spacing.
        std::vector<Known>{{"tank_faces", 0.02, "floor", 0.018},
                           {"tank_faces", 0.02, "side walls, mean", 0.005},
                           {"tank_faces", 0.02, "centre of pressure above the floor", 0.03}},
        std::vector<Known>{{"tank_faces", 0.01, "floor", 0.004},
                           {"tank_faces", 0.01, "side walls, mean", 0.024},
                           {"tank_faces", 0.01, "centre of pressure above the floor", 0.01}},
        std::vector<Known>{{"slope", 0.0125, "slope", 0.04}, {"slope", 0.0125, "force along the tank", 1e-3}},
        // -1.9 %; of sums in another order, and from 9.8 to 10.1 mm, -1.1 to -2.8.
        std::vector<Known>{{"slope", 0.01, "slope", 0.03}, {"slope", 0.01, "force along the tank", 1e-3}},
        std::vector<Known>{{"slope_gentle", 0.01, "slope", 0.03},  // close spacings -12 to -1 %
                           {"slope_gentle", 0.01, "force along the tank", 1e-3}},
        // +9.1 % at 16 mm, and -6 to +7 of close spacings, before walls/convex_edges.h.
        std::vector<Known>{{"buoyancy_box", 0.016, "buoyancy", 0.015}},
        std::vector<Known>{{"buoyancy_box", 0.01, "buoyancy", 0.01}},
        std::vector<Known>{{"buoyancy_box", 0.008, "buoyancy", 0.01}},
        // A ball of 2.5 spacings was −3.7 % while its boundary layer lay as deep as a flat one's.
        std::vector<Known>{{"buoyancy_sphere", 0.01, "buoyancy", 0.01}},
        std::vector<Known>{{"buoyancy_sphere", 0.00714, "buoyancy", 0.015}},
        std::vector<Known>{
            {"draft", 0.013, "draft", 0.03}},  // close ones -2.6 ± 0.6, another order of sums 2.3
        std::vector<Known>{{"draft", 0.01, "draft", 0.03}},  // -5.0 %, close ones -1.0 ± 2.4 before them
        std::vector<Known>{{"slab", 0.008, "heat taken up after 250 ms", 0.03},
                           {"slab", 0.008, "heat taken up after 1000 ms", 0.03},
                           {"slab", 0.008, "warmth in the middle after 1000 ms", 0.025},
                           {"slab", 0.008, "heat that came from nowhere", 1e-5}},
        std::vector<Known>{{"touching", 0.008, "heat that went over", 0.05},
                           {"touching", 0.008, "heat lost", 1e-5}},
        std::vector<Known>{{"cantilever", 0.006, "sag of the end", 0.06}},
        std::vector<Known>{{"sloshing", 0.016, "period", 0.006},
                           {"sloshing", 0.016, "swing kept a period", 0.105}},
        std::vector<Known>{{"sloshing", 0.01, "period", 0.003},
                           {"sloshing", 0.01, "swing kept a period", 0.03}},
        // Until walls gave the whole of their torque (Honey below loses none now) 0.04, 0.04 and 0.05 held: 5
        // % that was lost made up for as much that fluid at walls is too stiff by.
        std::vector<Known>{{"spin_up", 0.005, "torque at tau 0.02", 0.04},
                           {"spin_up", 0.005, "torque at tau 0.05", 0.045},
                           {"spin_up", 0.005, "torque at tau 0.10", 0.06},
                           {"spin_up", 0.005, "impulse", 0.025}},
        // Thin and slow fluid yields, and creeps by itself (tests/notebook/2026-11-25-slow-flow-yields.md),
        // and five spacings across the radius see that alone. The report's own 7.1 mm, where 5 Pa·s is within
        // a percent, take 17 s.
        std::vector<Known>{{"spin_up_all", 0.01, "torque, 2.0 Pa·s at 0.5 rad/s", 0.28},
                           {"spin_up_all", 0.01, "torque, 5.0 Pa·s at 0.5 rad/s", 0.11},
                           {"spin_up_all", 0.01, "torque, 2.0 Pa·s at 5.0 rad/s", 0.18},
                           {"spin_up_all", 0.01, "torque, 5.0 Pa·s at 5.0 rad/s", 0.097}},
        std::vector<Known>{{"couette", 0.00667, "torque", 0.06}},
        // Of close spacings +2.1 ± 2.0.
        std::vector<Known>{{"couette", 0.006, "torque", 0.03}},
        std::vector<Known>{{"couette_start", 0.005, "torque at 20 ms", 0.085},
                           {"couette_start", 0.005, "torque at 40 ms", 0.04},
                           {"couette_start", 0.005, "torque at 80 ms", 0.055}},
        std::vector<Known>{{"poiseuille", 0.005, "flow", 0.025},
                           {"poiseuille", 0.005, "flow at 40 ms", 0.025}},
        // While free-slip walls had no viscous force across them, and the bumps of a boundary layer at the
        // spacing, the second was 24 to 37 % too little, and of a slow turn 70 % were kept. Of close spacings
        // +5.4 ± 2.9, +1 ± 8.
        std::vector<Known>{{"taylor_green", 0.005, "rate of decay", 0.09},
                           {"taylor_green", 0.005, "left of 2 cm/s after a decay's time", 0.15}},
        std::vector<Known>{{"smooth_glass", 0.005, "kept, 10 cm/s at the rim", 0.02},
                           {"smooth_glass", 0.005, "kept, 2 cm/s at the rim", 0.08}},
        // A ball of 1.5 and 2 spacings. It meets particle by particle what drags it now, so a stroke's halves
        // differ more (0.03 held where it slid through).
        std::vector<Known>{{"stokes", 0.008, "drag", 0.05},  // -4.2 ± 0.9 of close spacings
                           {"stokes", 0.008, "drift over a stroke", 0.028}},
        std::vector<Known>{{"stokes", 0.006, "drag", 0.05}, {"stokes", 0.006, "drift over a stroke", 0.02}},
        // -4.7 % was of honey that had not settled yet: it still sagged around the ball.
        std::vector<Known>{{"stokes_honey", 0.008, "drag", 0.095},
                           {"stokes_honey", 0.008, "drift over a stroke", 0.135}},
        std::vector<Known>{{"stokes_honey", 0.006, "drag", 0.06}},
        // +3 to +6 %. Before thick fluid settled as thin fluid does, -4 % at 50 and -31 % at 1000 Pa·s.
        std::vector<Known>{{"turned_ball", 0.008, "torque, 5 Pa·s, 0.01 of the density", 0.075},
                           {"turned_ball", 0.008, "torque, 5 Pa·s, 20 of the density", 0.075},
                           {"turned_ball", 0.008, "torque, 50 Pa·s, 0.01 of the density", 0.055},
                           {"turned_ball", 0.008, "torque, 50 Pa·s, 20 of the density", 0.055},
                           {"turned_ball", 0.008, "torque, 1000 Pa·s, 0.01 of the density", 0.045},
                           {"turned_ball", 0.008, "torque, 1000 Pa·s, 20 of the density", 0.045}},
        // Of the ball's lift, 71 mN: 0.6 % are left; of close spacings 0.4 in the mean.
        std::vector<Known>{{"slow_ball", 0.006, "force, moving", 0.02},
                           {"slow_ball", 0.006, "force left 0.9 s after", 0.007}},
        // Films are behind potential flow by as much as they are behind these.
        std::vector<Known>{{"dam_break", 0.146 / 16, "front against potential flow, worst", 0.034},
                           {"dam_break", 0.146 / 16, "front, worst", 0.245}},
        std::vector<Known>{{"dam_break_long", 0.05715 / 10, "front against potential flow, worst", 0.045},
                           {"dam_break_long", 0.05715 / 10, "speed of the front", 0.05},
                           {"dam_break_long", 0.05715 / 10, "front, worst", 0.19}},
        std::vector<Known>{{"shear_wave", 0.01, "rate of decay", 0.014}},
        std::vector<Known>{{"shear_wave", 0.008, "rate of decay", 0.02}},
        std::vector<Known>{{"bounce", 0.015, "rebound", 1e-3}}),
    named);

// A wider kernel, which a scene may have. Its boundary layers lie deeper (walls/wall_inset.h): as deep as at
// a ratio of 2 a ball was lifted by 12 % too much, and a slab floated 15 % too high. The level is lower for
// it.
INSTANTIATE_TEST_SUITE_P(
    wide, KnownAnswer,
    ::testing::Values(
        std::vector<Known>{{"still_tank", 0.0125, "level", 0.025, ParticleModel::kCorrected, 2.5},
                           {"still_tank", 0.0125, "pressure at 70 mm", 0.03},
                           {"still_tank", 0.0125, "pressure gained from 30 to 70 mm", 0.03}},
        std::vector<Known>{{"buoyancy_sphere", 0.01, "buoyancy", 0.015, ParticleModel::kCorrected, 2.5}},
        std::vector<Known>{{"buoyancy_box", 0.01014, "buoyancy", 0.015, ParticleModel::kCorrected, 2.5},
                           {"buoyancy_box", 0.01014, "noise, rms", 0.003}},
        // One reading: a GPU's, rounded otherwise, is 3 % off a CPU's.
        std::vector<Known>{{"draft", 0.01, "draft", 0.05, ParticleModel::kCorrected, 2.5}},
        // A gap of three spacings is little for a kernel of 2.5: 0.04 held where walls dragged from 0.7
        // spacings behind. By g++ 0.107, by clang, which rounds otherwise, 0.129: the torque is no surer than
        // that.
        std::vector<Known>{{"couette", 0.00667, "torque", 0.14, ParticleModel::kCorrected, 2.5}},
        // 8.5 % by Eq 9 between pairs: its faces lack neighbours as deep as the kernel is wide.
        std::vector<Known>{{"shear_wave", 0.01, "rate of decay", 0.014, ParticleModel::kCorrected, 2.5}},
        std::vector<Known>{{"sloshing", 0.016, "swing kept a period", 0.08, ParticleModel::kCorrected, 2.5},
                           {"sloshing", 0.016, "period", 0.02}}),
    named);

// Pressure projection: closer than the default in fluid near rest. Its runs differ more from build to build.
constexpr ParticleModel kSolved = ParticleModel::kIncompressible;
INSTANTIATE_TEST_SUITE_P(
    incompressible, KnownAnswer,
    ::testing::Values(std::vector<Known>{{"still_tank", 0.0125, "level", 0.012, kSolved},
                                         {"still_tank", 0.0125, "weight on the walls", 3e-4},
                                         {"still_tank", 0.0125, "noise of the weight, rms", 2e-3},
                                         {"still_tank", 0.0125, "pressure at 70 mm", 0.02}},
                      std::vector<Known>{{"buoyancy_box", 0.016, "buoyancy", 0.02, kSolved}},
                      std::vector<Known>{{"buoyancy_sphere", 0.01, "buoyancy", 0.03, kSolved}},
                      std::vector<Known>{{"draft", 0.013, "draft", 0.04, kSolved}},
                      std::vector<Known>{{"sloshing", 0.016, "period", 0.01, kSolved},
                                         {"sloshing", 0.016, "swing kept a period", 0.10}}),
    named);

// The published model, where it keeps its fluid: how far off it is, and no further.
INSTANTIATE_TEST_SUITE_P(
    paper, KnownAnswer,
    ::testing::Values(std::vector<Known>{{"shear_wave", 0.01, "rate of decay", 0.09, ParticleModel::kPaper}},
                      std::vector<Known>{
                          {"spin_up", 0.01, "torque at tau 0.02", 0.38, ParticleModel::kPaper}},
                      std::vector<Known>{{"stokes", 0.008, "drag", 7.1, ParticleModel::kPaper}}),
    named);

TEST(ErrorCases, have_ids_and_spacings_from_coarse_to_fine) {
  for (const report::ErrorCase& each : report::error_cases()) {
    EXPECT_EQ(std::string(each.id).find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"),
              std::string::npos);
    ASSERT_FALSE(each.spacings.empty());
    EXPECT_LE(each.quick, each.spacings.size());
    for (std::size_t i = 1; i < each.spacings.size(); ++i)
      EXPECT_LT(each.spacings[i], each.spacings[i - 1]) << each.id;
    EXPECT_EQ(report::find_error_case(each.id), &each);
  }
}

}  // namespace
}  // namespace slosh::lab
