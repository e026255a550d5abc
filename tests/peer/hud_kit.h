// Dear ImGui without a GPU or a window: what the tests of panels draw with.
#pragma once

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <glm/glm.hpp>

namespace slosh::test {

class PanelTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(640, 480);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  }
  void TearDown() override { ImGui::DestroyContext(); }

  /// How far (px) what a command may not draw on some of its vertices lies below its box, at worst.
  static float cut_off_below() {
    return worst([](const ImVec2& at, const ImVec4& box) { return at.y - box.w; });
  }
  /// The same to the right.
  static float cut_off_right() {
    return worst([](const ImVec2& at, const ImVec4& box) { return at.x - box.z; });
  }
  /// How far (px) outside of the picture anything was drawn, at worst.
  static float outside() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return worst([size](const ImVec2& at, const ImVec4&) {
      return std::max({-at.x, -at.y, at.x - size.x, at.y - size.y});
    });
  }

 private:
  template <class By>
  static float worst(By&& by) {
    float most = 0.0f;
    const ImDrawData* data = ImGui::GetDrawData();
    for (int i = 0; i < data->CmdListsCount; ++i) {
      const ImDrawList* list = data->CmdLists[i];
      for (const ImDrawCmd& command : list->CmdBuffer) {
        for (unsigned k = 0; k < command.ElemCount; ++k) {
          const ImDrawIdx index = list->IdxBuffer[static_cast<int>(command.IdxOffset + k)];
          const ImDrawVert& vertex = list->VtxBuffer[static_cast<int>(command.VtxOffset + index)];
          most = std::max(most, by(vertex.pos, command.ClipRect));
        }
      }
    }
    return most;
  }
};

}  // namespace slosh::test
