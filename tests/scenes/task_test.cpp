// A guided task as a scene file has it, and what is wrong with one.
#include "scenes/task.h"

#include <cmath>

#include "support.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::expect_edit_error;

/// A scene with these steps, and a region "in cup" and a gauge "level" on its cup.
auto with_task(json steps) {
  return [steps = std::move(steps)](json& j) {
    const int mesh = test::node_named(j, "water")["mesh"].get<int>();
    j["nodes"].push_back({{"name", "in cup"}, {"extras", {{"slosh", "region"}}}, {"mesh", mesh}});
    j["nodes"].push_back({{"name", "level"}, {"extras", {{"slosh", "gauge"}}}});
    const int count = static_cast<int>(j["nodes"].size());
    for (const int node : {count - 2, count - 1}) j["scenes"][0]["nodes"].push_back(node);
    j["scenes"][0]["extras"]["task"] = steps;
  };
}

json pour(json more = json::object()) {
  json step = {{"say", "Pour."}, {"until", {{"mass_kg", "in cup"}, {"at_least", 0.1}}}};
  step.update(more);
  return step;
}

json until(json goal) {
  return json::array({{{"say", "Pour."}, {"until", std::move(goal)}}});
}

TEST(TaskOfAScene, IsReadWithItsGoals) {
  const json steps = {pour({{"hold_s", 1.5}, {"within_s", 30.0}, {"hint", "Slowly."}, {"hint_after_s", 4.0}}),
                      {{"say", "Set it down."},
                       {"until",
                        {{"all",
                          {{{"tilt_deg", "cup"}, {"at_most", 10}},
                           {{"not", {{"speed_m_s", "cup"}, {"at_least", 0.2}}}},
                           {{"any",
                             {{{"force_n", "handle"}, {"at_least", 2}, {"at_most", 5}},
                              {{"level_m", "level"}, {"at_least", 0.1}}}}}}}}}}};
  for (const json& given : {steps, json(steps.dump())}) {
    const auto scene = test::load_edited(with_task(given));
    ASSERT_TRUE(scene) << scene.error().text();
    const std::vector<TaskStep>& task = scene.value().task;
    ASSERT_EQ(task.size(), 2u);
    EXPECT_EQ(task[0].say, "Pour.");
    EXPECT_EQ(task[0].hint, "Slowly.");
    EXPECT_EQ(task[0].hold, 1.5);
    EXPECT_EQ(task[0].within, 30.0);
    EXPECT_EQ(task[0].hint_after, 4.0);
    EXPECT_EQ(task[0].until.kind, GoalKind::kMass);
    EXPECT_EQ(task[0].until.thing, 0);
    EXPECT_EQ(task[0].until.other, -1) << "of any fluid";
    EXPECT_EQ(task[0].until.at_least, 0.1);
    EXPECT_TRUE(std::isinf(task[0].until.at_most));
    ASSERT_EQ(task[1].until.parts.size(), 3u);
    EXPECT_EQ(in_words(task[1].until, scene.value()),
              "tilt of cup: at most 10 \xC2\xB0, and not (speed of cup: at least 0.2 m/s), and force on "
              "handle: 2 to 5 "
              "N, or level at level: at least 0.1 m");
  }
}

TEST(TaskOfAScene, ASceneNeedsNone) {
  const auto scene = test::load_edited([](json&) {});
  ASSERT_TRUE(scene);
  EXPECT_TRUE(scene.value().task.empty());
}

TEST(TaskOfAScene, ErrorsNameStepAndField) {
  expect_edit_error(with_task("pour, then stop"), {"extras.task", "no JSON"});
  expect_edit_error(with_task(json::object()), {"extras.task", "no list of steps", "TASKS.md"});
  expect_edit_error(with_task(json::array({3})), {"extras.task[0]", "no step"});
  expect_edit_error(with_task({pour(), {{"say", "Stop."}}}),
                    {"extras.task[1]: extras.until", "missing", "mass_kg"});
  expect_edit_error(with_task({pour({{"say", ""}})}), {"task[0]: extras.say", "missing"});
  expect_edit_error(with_task({pour({{"hold_s", -1}})}), {"task[0]: extras.hold_s", "-1"});
  expect_edit_error(with_task({pour({{"hint_aftr_s", 1}})}), {"hint_aftr_s", "Did you mean hint_after_s"});
}

TEST(TaskOfAScene, ARegionIsAskedForMoreThanItsMass) {
  const char* const kinds[][2] = {{"spread_m2", "spread of water in in cup: at least 0.5 m²"},
                                  {"evenness", "evenness of water in in cup: at least 0.5"},
                                  {"mixing", "mixing of water in in cup: at least 0.5"},
                                  {"temperature_c", "temperature of water in in cup: at least 0.5 °C"},
                                  {"set", "set share of water in in cup: at least 0.5"}};
  for (const auto& [kind, words] : kinds) {
    const auto scene =
        test::load_edited(with_task(until({{kind, "in cup"}, {"fluid", "water"}, {"at_least", 0.5}})));
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(in_words(scene.value().task[0].until, scene.value()), words);
  }
  expect_edit_error(with_task(until({{"mixing", "in cup"}, {"at_least", 0.5}})), {"fluid", "missing"});
  expect_edit_error(with_task(until({{"set", "nowhere"}, {"at_least", 0.5}})),
                    {"region 'nowhere'", "in cup"});
}

TEST(TaskOfAScene, ErrorsOfGoalsSayWhatIsMeant) {
  expect_edit_error(with_task(until({{"mass_kg", "in cub"}, {"at_least", 1}})),
                    {"task[0]: extras.until: extras.mass_kg", "region 'in cub'", "Did you mean in cup?"});
  expect_edit_error(with_task(until({{"force_n", "left"}, {"at_least", 1}})),
                    {"grip 'left'", "Name one of: handle"});
  expect_edit_error(with_task(until({{"mass_kg", "in cup"}})), {"at_least", "missing", "kg"});
  expect_edit_error(with_task(until({{"mass_kg", "in cup"}, {"at_least", 2}, {"at_most", 1}})),
                    {"at_least", "above at_most"});
  expect_edit_error(with_task(until({{"mass_kg", "in cup"}, {"at_least", "much"}})),
                    {"at_least", "not a number"});
  expect_edit_error(with_task(until({{"mass_kg", "in cup"}, {"at_least", 1}, {"fluid", "oil"}})),
                    {"fluid 'oil'", "none"});
  expect_edit_error(with_task(until({{"mass_kg", "in cup"}, {"tilt_deg", "cup"}, {"at_least", 1}})),
                    {"more than one thing"});
  expect_edit_error(with_task(until({{"at_least", 1}})), {"nothing that can be measured", "all, any, not"});
  expect_edit_error(with_task(until({{"mass_kg", "in cup"}, {"at_last", 1}, {"at_most", 3}})),
                    {"at_last", "Did you mean"});
  expect_edit_error(with_task(until({{"mass_kg", "in cup"}, {"color", 1}, {"at_most", 3}})),
                    {"color", "does not know"});
  expect_edit_error(with_task(until({{"distance_m", "cup"}, {"at_most", 3}})), {"extras.to", "body ''"});
  expect_edit_error(with_task(until({{"all", json::array()}})), {"extras.all", "no list of goals"});
  expect_edit_error(with_task(until({{"any", {{{"mass_kg", "nowhere"}, {"at_least", 1}}}}})),
                    {"extras.any[0]: extras.mass_kg"});
  json deep = {{"mass_kg", "in cup"}, {"at_least", 1}};
  for (int i = 0; i < 20; ++i) deep = {{"not", deep}};
  expect_edit_error(with_task(until(deep)), {"within more than 8"});
}

TEST(TaskOfAScene, SaysWhatComesAndGoesWhenAStepIsDone) {
  const json acts = {{{"appears", "water"}},
                     {{"takes_away", "water"}, {"in", "in cup"}},
                     {{"takes_away", "cup"}},
                     {{"hand", "handle"}, {"takes", "handle"}}};
  const auto scene = test::load_edited(with_task(json::array({pour({{"then", acts}})})));
  ASSERT_TRUE(scene) << scene.error().text();
  std::string words;
  for (const TaskAct& act : scene.value().task[0].then) words += in_words(act, scene.value()) + "; ";
  EXPECT_EQ(words,
            "water appears; water in in cup is taken away; cup is taken away; the hand at handle takes "
            "handle; ");
  const auto one = test::load_edited(with_task(json::array({pour({{"then", {{"appears", "cup"}}}})})));
  ASSERT_TRUE(one) << one.error().text();
  EXPECT_EQ(one.value().task[0].then.size(), 1u);
}

TEST(TaskOfAScene, WhatCannotComeOrGoIsSaidWithItsPlace) {
  const auto wrong = [](json act, std::initializer_list<const char*> words) {
    expect_edit_error(with_task(json::array({pour({{"then", json::array({std::move(act)})}})})), words);
  };
  wrong({{"appears", "cup"}, {"takes_away", "cup"}}, {"extras.task[0]: extras.then[0]"});
  wrong({{"appears", "watr"}}, {"extras.appears", "body or fluid 'watr'", "Did you mean water?"});
  wrong({{"takes_away", "water"}, {"in", "in cub"}}, {"extras.in", "region 'in cub'"});
  wrong({{"takes_away", "cup"}, {"in", "in cup"}}, {"extras.in", "goes as a whole"});
  wrong({{"hand", "left"}, {"takes", "handle"}}, {"extras.hand", "grip 'left'"});
  wrong({{"hand", "handle"}}, {"extras.takes", "grip ''"});
  wrong({{"appears", "cup"}, {"takes_away", "cup"}}, {"is nothing that can happen", "appears"});
  wrong("cup", {"is nothing that can happen"});
  wrong({{"apears", "cup"}}, {"extras.apears", "does not know"});
}

}  // namespace
}  // namespace slosh
