#include "peer/view/window_guide.h"

#include <imgui.h>

#include <cstdio>

namespace slosh {
namespace {

constexpr double kSaidSeconds = 5.0;
constexpr float kMargin = 8.0f;
constexpr float kRing = 20.0f;  // px, as far as a press reaches (mouse_grab.cpp)
constexpr ImGuiWindowFlags kPanel = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_AlwaysAutoResize;

void panel(const char* name, const std::string& text, ImVec2 at, ImVec2 pivot) {
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
  ImGui::SetNextWindowBgAlpha(0.7f);
  if (ImGui::Begin(name, nullptr, kPanel)) ImGui::TextUnformatted(text.c_str());
  ImGui::End();
}

}  // namespace

std::string WindowGuide::all_keys(const GuideFacts& facts) {
  std::string text;
  if (facts.can_grab) {
    text +=
        "drag a handle      move it; the other hands of that thing give way\n"
        "drag the thing     move it with all its hands\n"
        "  wheel            tilt it: pour to the side\n"
        "  Ctrl + drag      tilt it any way\n"
        "  Shift + drag     over the table instead of up and down\n"
        "  Shift + wheel    away and nearer\n"
        "B                  give the hands back to the script\n\n";
  }
  if (facts.mouse_is_hand) {
    text +=
        "move               the handle in the picture's plane\n"
        "wheel              the handle nearer and farther\n"
        "right drag         turn the handle\n"
        "left drag          turn the camera\n";
  } else {
    text += facts.can_grab ? "drag elsewhere     turn the camera\n" : "left drag          turn the camera\n";
    text +=
        "right drag         shift the camera\n"
        "wheel              nearer and farther\n";
  }
  text += "C                  the camera back to where it was\n\n";
  if (facts.shared) text += "G                  take a free grip, let go\n";
  if (facts.may_change) text += "Space              pause, go on\n";
  if (facts.may_pace) {
    text +=
        "N, Shift + N       one step, ten steps (the world then stands)\n"
        "Down, Up           slower, faster\n";
  }
  if (facts.may_change) {
    text +=
        "R                  start again\n"
        "Tab                sliders: viscosity, gravity, pace\n";
  }
  text +=
      "P                  keep the picture as a file\n"
      "H                  these keys\n"
      "Esc, Q             end";
  return text;
}

std::string WindowGuide::hint(const GuideFacts& facts) const {
  const auto done = [this](Used used) { return used_[static_cast<std::size_t>(used)]; };
  const std::string help = done(Used::kKeys) ? "" : "\nH: all keys";
  if (facts.holding) {
    if (done(Used::kTilt)) return {};
    return "wheel: tilt and pour\nCtrl:  tilt any way\nShift: over the table";
  }
  if (facts.taken && !done(Used::kGiveBack)) return "B: the script takes the hands again" + help;
  if (facts.can_grab && !done(Used::kGrab)) {
    const std::string what =
        facts.over.empty() ? "Drag the thing or one of its handles: it is yours" : facts.over;
    return what + help;
  }
  return done(Used::kKeys) ? std::string() : "H: all keys";
}

void WindowGuide::say(std::string text, double wall_seconds) {
  said_ = std::move(text);
  until_ = wall_seconds + kSaidSeconds;
}

void WindowGuide::draw(const GuideFacts& facts, double wall_seconds) const {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 size = io.DisplaySize;
  if (facts.mark) {
    const ImVec2 at(facts.mark->x / io.DisplayFramebufferScale.x,
                    facts.mark->y / io.DisplayFramebufferScale.y);
    const ImU32 color = facts.holding ? IM_COL32(255, 220, 120, 255) : IM_COL32(255, 255, 255, 190);
    ImGui::GetBackgroundDrawList()->AddCircle(at, kRing, color, 0, facts.holding ? 3.0f : 2.0f);
  }
  if (show_all) panel("keys", all_keys(facts), ImVec2(0.5f * size.x, 0.5f * size.y), ImVec2(0.5f, 0.5f));
  std::string line = hint(facts);
  if (facts.may_pace && facts.pace < 0.999) {
    char text[48];
    std::snprintf(text, sizeof text, "slow motion \xC3\x97 %.2f", facts.pace);
    line = line.empty() ? text : std::string(text) + "\n" + line;
  }
  if (wall_seconds < until_) line = line.empty() ? said_ : said_ + "\n" + line;
  if (!line.empty() && !show_all)
    panel("hint", line, ImVec2(0.5f * size.x, size.y - kMargin), ImVec2(0.5f, 1.0f));
}

}  // namespace slosh
