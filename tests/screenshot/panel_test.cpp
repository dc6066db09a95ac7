// Bar, panels and cards of the window against golden pictures, drawn out of figures that stand still.

#include "tests/screenshot/golden.h"
#include "tests/screenshot/panel_window.h"
#include "tests/support/program.h"
#include "workbench/panels/material_window.h"
#include "workbench/screen/picture_controller.h"

#include <vector>

namespace touchstone::test {
namespace {

/// Of a panel's pixels: text and lamps are few of them, and one device repeats itself.
constexpr double kPanelShare = 0.0008;

class PanelGolden : public PanelWindow {
  protected:
    static constexpr int kBar = 42;

    enum class Part : uint8_t { Bar, Strip, Left, Right, Bottom, Picture, All };
    PixelData part(Part which, const std::function<void(Widgets&)>& more = {}) {
        const PixelData all = window(more);
        const WidgetRect p = rects_.at("picture");
        const auto at = [](float v) { return static_cast<int>(v); };
        const int right = at(p.x + p.width), below = at(p.y + p.height);
        switch (which) {
        case Part::Bar:
            return crop(all, 0, 0, size_.x, kBar);
        case Part::Strip:
            return crop(all, 0, kBar, size_.x, at(p.y));
        case Part::Left:
            return crop(all, 0, at(p.y), at(p.x), size_.y);
        case Part::Right:
            return crop(all, right, at(p.y), size_.x, size_.y);
        case Part::Bottom:
            return crop(all, at(p.x), below, right, size_.y);
        case Part::All:
            return all;
        case Part::Picture:
            break;
        }
        return crop(all, at(p.x), at(p.y), right, below);
    }
    static PixelData crop(const PixelData& all, int left, int top, int right, int bottom) {
        PixelData part = all;
        part.width = right - left;
        part.height = bottom - top;
        const auto channels = static_cast<size_t>(all.channels);
        part.bytes.clear();
        for (int y = top; y < bottom; ++y) {
            const size_t begin = (static_cast<size_t>(y) * all.width + left) * channels;
            part.bytes.insert(part.bytes.end(), all.bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                              all.bytes.begin() + static_cast<std::ptrdiff_t>(begin + part.width * channels));
        }
        return part;
    }

    /// Against the golden picture `panel_NAME`, which must tell it from what `mistake` makes of it.
    void expectPanel(const std::string& name, Part which, const std::function<void()>& mistake,
                     const std::function<void(Widgets&)>& more = {}) {
        expectMatchesGolden("panel_" + name, part(which, more), kPanelShare);
        mistake();
        expectMutationIsSeen("panel_" + name, "another state", part(which, more), kPanelShare);
    }
};

TEST_F(PanelGolden, Bar) {
    expectPanel("bar", Part::Bar, [&] { state_.settings.friction = FrictionMode::Off; });
}

TEST_F(PanelGolden, BarOfAFaultWhileRecording) {
    input_.recording = true;
    input_.recordedSeconds = 12.0;
    servo_.last.output.flags = static_cast<uint32_t>(TickFlag::SafetyLatched);
    servo_.ticksPerSecond = 800.0;
    expectPanel("bar_fault", Part::Bar, [&] { servo_.last.output.flags = {}; });
}

TEST_F(PanelGolden, SceneAndWhatIsUnderTheProbe) {
    input_.warnings = {"mesh 'glaze': two triangles have no area: left out"};
    expectPanel("left", Part::Left, [&] { input_.warnings.clear(); });
}

TEST_F(PanelGolden, WhatIsFelt) {
    expectPanel("right", Part::Right, [&] { state_.settings.forceEnabled = false; });
}

TEST_F(PanelGolden, Charts) {
    expectPanel("charts", Part::Bottom, [&] {
        TickRecord tick;
        for (int i = 0; i < 2000; ++i)
            forces_.add(tick, false);
    });
}

TEST_F(PanelGolden, ARecordingThatIsLookedAt) {
    const ScratchFolder scratch;
    lookAt(scratch / "r.tsrec");
    expectPanel("recording", Part::Bottom, [&] { timeline_.playback().seek(7.0); });
    expectPanel("recording_card", Part::Picture, [&] { timeline_.leave(); });
}

/// Of one frame both desks want a part, and the device goes before either has it.
TEST_F(PanelGolden, APictureComesThoughItsFrameIsLostOrAnotherControllerTakesIt) {
    const ScratchFolder scratch;
    PictureController model(scratch / "model"), charts(scratch / "charts");
    model.request(*target_, {.width = 40, .height = 30}, "a");
    charts.request(*target_, {.width = 20, .height = 10}, "b");
    frame({});
    target_->leaveDevice(); // with the copy of that frame
    gpu_.reset();
    gpu_ = createGpuForWindow(window_, {});
    target_->takeDevice(*gpu_);
    bool modelCame = false, chartsCame = false;
    for (int i = 0; i < 1000 && !(modelCame && chartsCame); ++i) {
        modelCame |= model.update(*target_);
        chartsCame |= charts.update(*target_);
        frame({});
    }
    EXPECT_EQ(model.note().text(), "saved " + (scratch / "model/a-1.png").string());
    EXPECT_EQ(charts.note().text(), "saved " + (scratch / "charts/b-1.png").string());
}

TEST_F(PanelGolden, FirstRun) {
    state_.introduced = false;
    expectPanel("first_run", Part::Strip, [&] { state_.simulatedHand = true; });
}

TEST_F(PanelGolden, LoadingAndWhatWentWrong) {
    input_.loading = true;
    input_.loadName = "car.glb";
    input_.loadFraction = 0.4;
    input_.loadActivity = "decoding images";
    expectPanel("loading", Part::Picture, [&] { input_.loadFraction = 0.6; });
    input_.loading = false;
    input_.problem = "car.glb: accessor 3 reaches beyond its buffer\n  remedy: export the model again";
    expectPanel("problem", Part::Picture, [&] { input_.problem = "car.glb: is no glTF"; });
}

TEST_F(PanelGolden, UnsavedMaterials) {
    state_.leaving.emplace();
    expectPanel("unsaved", Part::Picture, [&] { input_.canSaveMaterials = false; });
}

TEST_F(PanelGolden, Help) {
    state_.help = true;
    expectPanel("help", Part::All, [&] { state_.help = false; });
}

TEST_F(PanelGolden, MaterialEditor) {
    MaterialPanelInput input;
    input.scene = model_.scene.get();
    input.probed = 0;
    MaterialPanelState state;
    bool open = true;
    const auto editor = [&](Widgets& widgets) {
        drawMaterialWindow(input, rects_.at("picture"), open, controller_, state, widgets);
    };
    expectPanel(
        "editor", Part::Picture, [&] { input.deviceStiffness = 900.0; }, editor);
}

} // namespace
} // namespace touchstone::test
