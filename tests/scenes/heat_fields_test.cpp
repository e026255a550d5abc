// What warms, thickens and sets, as a scene file has it.
#include <cmath>

#include "support.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::expect_edit_error;
using test::node_named;

test::Edit warm(const json& fields) {
  return [fields](json& j) {
    json& extras = node_named(j, "water")["extras"];
    if (fields.contains("viscosity_at_c")) extras.erase("viscosity_pa_s");
    extras.update(fields);
  };
}

TEST(HeatFields, AreReadWithTheirDefaults) {
  const auto plain = test::load_edited([](json&) {});
  ASSERT_TRUE(plain) << plain.error().text();
  EXPECT_EQ(plain.value().fluids[0].heat, Heat{});
  EXPECT_FALSE(plain.value().bodies[0].temperature);
  const auto scene = test::load_edited([](json& j) {
    warm({{"temperature_c", 30},
          {"heat_capacity_j_kg_k", 3300},
          {"conductivity_w_m_k", 0.4},
          {"viscosity_at_c", {20, 4, 40, 1}},
          {"sets_above_c", 75},
          {"sets_in_s", 5},
          {"set_viscosity_pa_s", 200},
          {"set_modulus_pa", 2e4},
          {"tears_at", 0.3}})(j);
    node_named(j, "cup")["extras"]["temperature_c"] = 180;
  });
  ASSERT_TRUE(scene) << scene.error().text();
  const Fluid& fluid = scene.value().fluids[0];
  EXPECT_EQ(fluid.heat.temperature, 30.0);
  EXPECT_EQ(fluid.heat.capacity, 3300.0);
  EXPECT_EQ(fluid.heat.conductivity, 0.4);
  EXPECT_NEAR(fluid.dynamic_viscosity, 2.0, 1e-12) << "half the way between the logarithms of 4 and 1";
  ASSERT_EQ(fluid.heat.viscosity.size(), 2u);
  EXPECT_NEAR(fluid.heat.viscosity[0].times, 2.0, 1e-12);
  EXPECT_NEAR(fluid.heat.viscosity[1].times, 0.5, 1e-12);
  EXPECT_NEAR(fluid.heat.set_times, 100.0, 1e-9);
  EXPECT_EQ(fluid.heat.modulus, 2e4);
  EXPECT_EQ(fluid.heat.tears_at, 0.3);
  EXPECT_EQ(fluid.heat.sets_above, 75.0);
  EXPECT_TRUE(std::isinf(fluid.heat.melts_above));
  EXPECT_EQ(scene.value().bodies[0].temperature, 180.0);
}

TEST(HeatFields, ErrorsSayWhatIsMissingAndWhatDoesNotFit) {
  expect_edit_error(warm({{"temperature_c", -300}}), {"temperature_c", "-300"});
  expect_edit_error(warm({{"conductivity_w_m_k", "good"}}), {"conductivity_w_m_k", "not a number"});
  expect_edit_error(warm({{"viscosity_at_c", {20, 4, 10, 1}}}),
                    {"viscosity_at_c", "do not rise", "[20, 1.5"});
  expect_edit_error(warm({{"viscosity_at_c", {20, 4, 40}}}), {"viscosity_at_c", "pairs of numbers"});
  expect_edit_error(warm({{"viscosity_at_c", {20, 0}}}), {"viscosity_at_c", "0 Pa·s at 20 °C"});
  expect_edit_error(
      [](json& j) {
        node_named(j, "water")["extras"].update({{"viscosity_at_c", {20, 4}}, {"viscosity_pa_s", 1}});
      },
      {"viscosity_pa_s", "together with viscosity_at_c"});
  expect_edit_error(warm({{"sets_above_c", 75}, {"set_viscosity_pa_s", 9}}), {"sets_in_s", "missing beside"});
  expect_edit_error(warm({{"sets_in_s", 5}}), {"sets_in_s", "without sets_above_c or sets_below_c"});
  expect_edit_error(warm({{"sets_above_c", 75}, {"sets_in_s", 5}}), {"set_viscosity_pa_s", "missing"});
  expect_edit_error(warm({{"set_viscosity_pa_s", 5}}), {"set_viscosity_pa_s", "does not set"});
  expect_edit_error(warm({{"starts_set", true}}), {"starts_set", "never melts", "melts_above_c"});
  expect_edit_error(warm({{"tears_at", 0.5}}), {"tears_at", "set_modulus_pa"});
  expect_edit_error(warm({{"set_modulus_pa", 100}}), {"set_modulus_pa", "does not set"});
  expect_edit_error(warm({{"conductivity", 1}}), {"conductivity", "Did you mean conductivity_w_m_k?"});
}

}  // namespace
}  // namespace slosh
