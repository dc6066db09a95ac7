// The slider of a volume's surface, moved by a pointer.
#include "engine/scene/scene.h"
#include "tests/unit/volume/made_volume.h"
#include "tests/unit/workbench/gui_context.h"
#include "workbench/panels/panels.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <optional>
#include <utility>

namespace touchstone::volume_panel_test {
namespace {

/// A volume with values from `low` to `high`.
std::shared_ptr<const Volume> volumeBetween(float low, float high) {
    std::vector<float> values;
    for (int i = 0; i < 64; ++i)
        values.push_back(low + (high - low) * static_cast<float>(i) / 63.0f);
    return test::volumeOf(glm::ivec3(4), values);
}

class VolumePanel : public testing::Test {
  protected:
    VolumePanel() { show(volumeBetween(0.0f, 1000.0f), 100.0); }

    void show(std::shared_ptr<const Volume> volume, double iso) {
        scene_.volume = std::move(volume);
        scene_.iso = iso;
        input_.scene = &scene_;
    }
    /// What one frame asks for.
    std::optional<double> frame() {
        ImGui::GetIO().DeltaTime = 1.0f / 60.0f;
        ImGui::NewFrame();
        ImGui::SetNextWindowPos(ImVec2(0, 0));
        ImGui::SetNextWindowSize(ImVec2(300, 300));
        ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
        Widgets widgets(1.0f);
        drawVolume(input_, state_, widgets);
        slider_ = widgets.take()["iso"];
        ImGui::End();
        ImGui::Render();
        return std::exchange(state_.iso, std::nullopt);
    }
    /// The pointer at a share of the slider, for two frames: what they ask for.
    std::optional<double> drag(float share) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = ImVec2(slider_.x + 3.0f + share * (slider_.width - 6.0f), slider_.y + 5.0f);
        std::optional<double> asked;
        for (int i = 0; i < 2; ++i) {
            if (const auto now = frame())
                asked = now;
            io.MouseDown[0] = true;
        }
        if (const auto now = frame())
            asked = now;
        return asked;
    }
    std::optional<double> release() {
        ImGui::GetIO().MouseDown[0] = false;
        return frame();
    }

    test::GuiContext context_{ImVec2(400, 400)};
    Scene scene_;
    PanelInput input_;
    PanelState state_;
    WidgetRect slider_;
};

TEST_F(VolumePanel, GoingBackToTheShownValueTakesBackWhatLoads) {
    frame();
    const std::optional<double> shown = drag(0.1f);
    ASSERT_TRUE(shown);
    release();
    scene_.iso = *shown;
    frame();
    const std::optional<double> other = drag(0.5f);
    ASSERT_TRUE(other);
    EXPECT_NEAR(*other, 500.0, 10.0);
    input_.loading = true;
    EXPECT_FALSE(drag(0.1f)) << "one at a time";
    EXPECT_EQ(release(), shown);
    EXPECT_FALSE(frame());
}

TEST_F(VolumePanel, AValueIsBuiltWhileTheSliderRests) {
    frame();
    ASSERT_TRUE(drag(0.3f));
    input_.loading = true;
    EXPECT_FALSE(drag(0.6f));
    scene_.iso = 300.0;
    input_.loading = false;
    const std::optional<double> next = frame(); // nothing moves
    ASSERT_TRUE(next);
    EXPECT_NEAR(*next, 600.0, 10.0);
    input_.loading = true;
    EXPECT_FALSE(frame());
    input_.loading = false;
    EXPECT_FALSE(frame()) << "it failed, or has arrived: the same is not asked for again";
    EXPECT_FALSE(release());
}

TEST_F(VolumePanel, TheEndsAreValuesThatHaveASurface) {
    show(volumeBetween(0.0f, 65535.0f), 1000.0);
    frame();
    drag(0.5f);
    const std::optional<double> most = drag(1.2f);
    ASSERT_TRUE(most);
    EXPECT_EQ(*most, 65535.0);
    const std::optional<double> least = drag(-0.2f);
    ASSERT_TRUE(least);
    EXPECT_GT(*least, 0.0);
    EXPECT_LT(*least, 100.0);
}

TEST_F(VolumePanel, ValuesFarFromZeroAreNotRoundedToOneAnother) {
    show(volumeBetween(30000.0f, 30040.0f), 30010.0);
    frame();
    const std::optional<double> value = drag(0.62f);
    ASSERT_TRUE(value);
    EXPECT_NEAR(*value, 30024.8, 0.4);
}

} // namespace
} // namespace touchstone::volume_panel_test
