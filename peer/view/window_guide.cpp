#include "peer/view/window_guide.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <initializer_list>

namespace slosh {
namespace {

constexpr double kSaidSeconds = 5.0;
constexpr float kGuideMargin = 8.0f;
constexpr float kHintHeight = 0.25f;  // of the picture, at most
constexpr float kRing = 20.0f;        // px, as far as a press reaches (mouse_grab.cpp)
constexpr ImGuiWindowFlags kPanel = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoInputs;

/// A text's panel: its letters are smaller where it would not fit into `room`.
struct TextPanel {
  TextPanel(const std::string& what, const glm::vec2& room) : text(what) {
    const ImVec2 wide = ImGui::CalcTextSize(text.c_str());
    const ImVec2 padding = ImGui::GetStyle().WindowPadding;
    const glm::vec2 around(2.0f * padding.x, 2.0f * padding.y);
    letters = letters_that_fit({wide.x, wide.y}, room - around);
    size = glm::ceil(letters * glm::vec2(wide.x, wide.y)) + around;
  }
  void draw(const char* name, const glm::vec2& at, float opacity) const {
    ImGui::SetNextWindowPos(ImVec2(at.x, at.y));
    ImGui::SetNextWindowSize(ImVec2(size.x, size.y));
    ImGui::SetNextWindowBgAlpha(opacity);
    if (ImGui::Begin(name, nullptr, kPanel)) {
      ImGui::SetWindowFontScale(letters);
      ImGui::TextUnformatted(text.c_str());
    }
    ImGui::End();
  }

  const std::string& text;
  float letters = 1.0f;
  glm::vec2 size{0.0f};
};

/// Where a line of `size` lies: at the bottom in the middle, else in a corner there, else above what is
/// there.
glm::vec2 hint_place(const glm::vec2& size, const glm::vec2& picture, std::span<const Rect> taken,
                     const glm::vec2& now) {
  const glm::vec2 low(0.5f * (picture.x - size.x), picture.y - size.y - kGuideMargin);
  float above = low.y;
  for (const Rect& rect : taken)
    if (rect.high.y > low.y) above = std::min(above, rect.low.y - size.y - kGuideMargin);
  const std::array places{low, glm::vec2(picture.x - size.x - kGuideMargin, low.y),
                          glm::vec2(kGuideMargin, low.y), glm::vec2(low.x, std::max(above, kGuideMargin))};
  return place_panel(size, places, taken, now);
}

}  // namespace

std::string WindowGuide::all_keys(const GuideFacts& facts, const KeyBindings& keys) {
  using Action = WindowAction;
  std::string text;
  const auto row = [&text](const std::string& what, const std::string& does) {
    text += what + std::string(what.size() < 19 ? 19 - what.size() : 1, ' ') + does + "\n";
  };
  // What a key does stands with its name in the settings (key_bindings.cpp); several in one row.
  const auto bound = [&](std::initializer_list<Action> actions, const char* does = nullptr) {
    std::string names;
    for (const Action action : actions) {
      if (keys.keys_of(action).empty()) continue;
      names += (names.empty() ? "" : ", ") + keys.shown(action);
    }
    if (!names.empty())
      row(names, does ? does : window_actions()[static_cast<std::size_t>(*actions.begin())].text);
  };
  if (facts.can_grab) {
    row("drag a handle", "move it; the other hands of that thing give way");
    row("drag the thing", "move it with all its hands");
    row("  wheel", "tilt it: pour to the side");
    row("  Ctrl + drag", "tilt it any way");
    row("  Shift + drag", "over the table instead of up and down");
    row("  Shift + wheel", "away and nearer");
    bound({Action::kGiveBack});
    text += "\n";
  }
  if (facts.mouse_is_hand) {
    row("move", "the handle in the picture's plane");
    row("wheel", "the handle nearer and farther");
    row("right drag", "turn the handle");
    row("left drag", "turn the camera");
  } else {
    row(facts.can_grab ? "drag elsewhere" : "left drag", "turn the camera");
    row("right drag", "shift the camera");
    row("wheel", "nearer and farther");
  }
  bound({Action::kCameraBack});
  bound({Action::kView1, Action::kView2, Action::kView3, Action::kView4},
        "the camera as kept there; with Shift keep it");
  text += "\n";
  bound({Action::kParticles});
  bound({Action::kAxes});
  if (facts.hands > 0) bound({Action::kForces});
  text += "\n";
  if (facts.shared) bound({Action::kGrip});
  if (facts.may_change) bound({Action::kPause});
  if (facts.may_pace) {
    bound({Action::kStep});
    bound({Action::kSlower, Action::kFaster}, "slower, faster");
  }
  if (facts.may_change) bound({Action::kAgain});
  if (facts.may_change || facts.shared) bound({Action::kSliders});
  bound({Action::kPicture});
  bound({Action::kHelp}, "these keys");
  bound({Action::kEnd});
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

std::string WindowGuide::hint(const GuideFacts& facts) const {
  const auto done = [this](Used used) { return used_[static_cast<std::size_t>(used)]; };
  const std::string all =
      keys_.keys_of(WindowAction::kHelp).empty() ? "" : keys_.shown(WindowAction::kHelp) + ": all keys";
  const std::string help = done(Used::kKeys) || all.empty() ? "" : "\n" + all;
  if (facts.holding) {
    if (done(Used::kTilt)) return {};
    return "wheel: tilt and pour\nCtrl:  tilt any way\nShift: over the table";
  }
  if (facts.taken && !done(Used::kGiveBack))
    return keys_.shown(WindowAction::kGiveBack) + ": the script takes the hands again" + help;
  if (facts.can_grab && !done(Used::kGrab)) {
    const std::string what =
        facts.over.empty() ? "Drag the thing or one of its handles: it is yours" : facts.over;
    return what + help;
  }
  return done(Used::kKeys) ? std::string() : all;
}

void WindowGuide::say(std::string text, double wall_seconds) {
  said_ = std::move(text);
  until_ = wall_seconds + kSaidSeconds;
}

void WindowGuide::draw(const GuideFacts& facts, double wall_seconds, std::span<const Rect> taken) {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::vec2 picture(io.DisplaySize.x, io.DisplaySize.y);
  if (facts.mark) {
    const ImVec2 at(facts.mark->x / io.DisplayFramebufferScale.x,
                    facts.mark->y / io.DisplayFramebufferScale.y);
    const ImU32 color = facts.holding ? IM_COL32(255, 220, 120, 255) : IM_COL32(255, 255, 255, 190);
    ImGui::GetBackgroundDrawList()->AddCircle(at, kRing, color, 0, facts.holding ? 3.0f : 2.0f);
  }
  if (show_all) {
    const std::string keys = all_keys(facts, keys_);
    const TextPanel panel(keys, picture - 2.0f * kGuideMargin);
    panel.draw("keys", 0.5f * (picture - panel.size), 0.92f);
  }
  std::string line = hint(facts);
  if (facts.may_pace && facts.pace < 0.999) {
    char text[48];
    std::snprintf(text, sizeof text, "slow motion \xC3\x97 %.2f", facts.pace);
    line = line.empty() ? text : std::string(text) + "\n" + line;
  }
  if (wall_seconds < until_) line = line.empty() ? said_ : said_ + "\n" + line;
  if (line.empty() || show_all) return;
  const TextPanel panel(line, {picture.x - 2.0f * kGuideMargin, kHintHeight * picture.y});
  hint_at_ = hint_place(panel.size, picture, taken, hint_at_);
  panel.draw("hint", hint_at_, 0.7f);
}

}  // namespace slosh
