// The pointer as a hand: which presses of its button press on the model.
#include "tests/unit/workbench/gui_context.h"
#include "workbench/screen/view_control.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <cfloat>
#include <optional>

namespace touchstone::view_control_test {
namespace {

class ViewControlTest : public testing::Test {
  protected:
    ViewControlTest() { open(); }

    void open() {
        Bounds bounds;
        bounds.include(glm::dvec3(-0.05));
        bounds.include(glm::dvec3(0.05));
        control_.lookAt(bounds, 1.0);
    }
    /// Whether the hand presses at the end of a frame, of a tenth of a second. Everywhere in the window is a
    /// wall.
    bool pressesAfter(bool overPicture, bool down) {
        ImGuiIO& io = ImGui::GetIO();
        io.DeltaTime = 0.1f;
        io.MousePos = overPicture ? ImVec2(200, 200) : ImVec2(-FLT_MAX, -FLT_MAX);
        io.MouseDown[0] = down;
        ImGui::NewFrame();
        ViewControl::Situation now;
        now.area = glm::dvec2(400.0);
        now.seconds = 0.1;
        now.covered = true; // by what has the keyboard
        now.look = [](const Ray&) {
            return std::optional(PointedSurface{.point = {0.0, 0.0, 0.05}, .normal = {0.0, 0.0, 1.0}});
        };
        control_.update(now, options_);
        ImGui::Render();
        const std::optional<MouseGoal> goal = control_.handGoal();
        return goal && goal->press > 0.0;
    }

    test::GuiContext context_{ImVec2(400, 400)};
    ViewControl control_;
    ViewOptions options_;
};

/// A frame may take a tenth of a second: the pointer comes from elsewhere and presses within one.
TEST_F(ViewControlTest, APressInTheFirstFrameOverTheModelPresses) {
    EXPECT_FALSE(pressesAfter(false, false));
    EXPECT_FALSE(pressesAfter(false, false));
    EXPECT_TRUE(pressesAfter(true, true) || pressesAfter(true, true)) << "a hand is put down for a frame";
    EXPECT_FALSE(pressesAfter(true, false));
}

TEST_F(ViewControlTest, AButtonThatWasHeldWhileAModelWasOpenedDoesNotPress) {
    EXPECT_FALSE(pressesAfter(true, false));
    EXPECT_TRUE(pressesAfter(true, true) || pressesAfter(true, true));
    open();
    for (int frame = 0; frame < 5; ++frame)
        EXPECT_FALSE(pressesAfter(true, true)) << frame;
    EXPECT_FALSE(pressesAfter(true, false));
    EXPECT_TRUE(pressesAfter(true, true));
}

} // namespace
} // namespace touchstone::view_control_test
