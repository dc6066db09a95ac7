// Bar, panels and cards of the window against golden pictures, drawn out of figures that stand still.

#define GLFW_INCLUDE_NONE
#include "devices/mouse/mouse_device.h"
#include "renderer/window_target.h"
#include "tests/screenshot/golden.h"
#include "tests/support/lavapipe.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"
#include "tests/support/virtual_display.h"
#include "workbench/model/model.h"
#include "workbench/panels/material_window.h"
#include "workbench/screen/picture_controller.h"
#include "workbench/screen/style.h"
#include "workbench/timeline/timeline_controller.h"
#include "workbench/window/layout.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace touchstone::test {
namespace {

constexpr int kWidth = 1100, kHeight = 720;
/// Of a panel's pixels: text and lamps are few of them, and one device repeats itself.
constexpr double kPanelShare = 0.0008;

class PanelGolden : public ::testing::Test {
  protected:
    void SetUp() override {
        useLavapipe();
        display_ = std::make_unique<VirtualDisplay>("1280x800x24");
        ASSERT_TRUE(glfwInit());
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        window_ = glfwCreateWindow(kWidth, kHeight, "panels", nullptr, nullptr);
        ASSERT_NE(window_, nullptr);
        glfwSetCursorPos(window_, 550.0, 300.0); // over the picture: nothing is hovered
        gpu_ = createGpuForWindow(window_, {});
        target_ = std::make_unique<WindowTarget>(*gpu_, window_, [] { applyStyle(1.0f); });
        target_->keepPanels(true, 0.0); // all in every frame
        model_ = loadModel(TOUCHSTONE_ASSETS "/doughnut.glb", Fit::Workspace);
        controller_.open(model_, false);
        touchForTenSeconds();
        describe();
    }
    void TearDown() override {
        target_.reset();
        gpu_.reset();
        if (window_ != nullptr)
            glfwDestroyWindow(window_);
        glfwTerminate();
    }

    /// A touch that comes and goes, for the charts.
    void touchForTenSeconds() {
        TickRecord tick;
        for (int i = 0; i < 10000; ++i) {
            tick.time = 0.001 * i;
            const double wave = std::sin(1.3 * tick.time), depth = std::max(0.0, 0.001 * wave);
            tick.output.contacts = wave > 0.0 ? 1 : 0;
            tick.output.normal = {0.0, 0.0, 1.0};
            tick.output.penetration = depth;
            tick.output.force = {wave > 0.0 ? 100.0 * depth : 0.0, 0.0, 600.0 * depth};
            tick.output.energyBalance = -0.2 * depth;
            tick.stepNs = 3000 + 500 * (i % 3);
            forces_.add(tick, i > 6000);
        }
        tick.output.object = 0;
        tick.output.contacts = 1;
        tick.output.penetration = 0.001;
        tick.output.force = {0.1, 0.0, 0.6};
        servo_.last = tick;
    }

    void describe() {
        servo_.counters.ticks = 123456;
        servo_.counters.missed = 3;
        servo_.scheduling = "SCHED_FIFO 80";
        servo_.rateHz = servo_.ticksPerSecond = 1000.0;
        servo_.stepP50Us = servo_.contactP50Us = 3.0;
        servo_.stepP99Us = servo_.contactP99Us = 11.0;
        servo_.wakeP50Us = 21.0;
        servo_.wakeP99Us = 47.0;
        for (size_t i = 0; i < kStageCount; ++i) {
            servo_.stageP50Us[i] = 0.2 * static_cast<double>(i + 1);
            servo_.stageP99Us[i] = 0.5 * static_cast<double>(i + 1);
        }
        servo_.error.force = {2e-5, 2.3e-4};
        servo_.error.forceShare = {1e-5, 4e-4};
        servo_.error.direction = {2e-4, 1.6e-3};
        servo_.error.inContact = 2000;
        servo_.error.comparedShare = 1.0;
        input_.scene = model_.scene.get();
        input_.haptic = model_.haptic.get();
        input_.modelName = "doughnut.glb";
        input_.modelFacts = "64800 triangles";
        input_.canSimulate = true;
        input_.canSaveMaterials = true;
        input_.servo = &servo_;
        input_.timeline = &timeline_;
        input_.tick = &servo_.last;
        input_.forces = &forces_;
        input_.framesPerSecond = 30.0;
        input_.sceneSize = {704, 392};
        input_.gpuName = "a device";
        state_.introduced = true;
    }

    /// The window after some frames, with which ImGui's sizes have come to rest.
    PixelData window(const std::function<void(Widgets&)>& more = {}) {
        constexpr int kFrames = 4;
        for (int i = 0; i < kFrames; ++i)
            frame(more);
        target_->requestCapture();
        for (int i = 0; i < 100; ++i) {
            frame(more);
            if (std::optional<PixelData> pixels = target_->takeCapture())
                return *std::move(pixels);
        }
        return {};
    }
    void frame(const std::function<void(Widgets&)>& more) {
        glfwPollEvents();
        if (!target_->beginFrame())
            return;
        rects_ = drawPanels(input_, state_);
        Widgets widgets(1.0f);
        if (more)
            more(widgets);
        target_->endFrame(nullptr, {});
    }

    enum class Part : uint8_t { Bar, Left, Right, Bottom, Picture, All };
    PixelData part(Part which, const std::function<void(Widgets&)>& more = {}) {
        const PixelData all = window(more);
        const WidgetRect p = rects_.at("picture");
        const auto at = [](float v) { return static_cast<int>(v); };
        const int right = at(p.x + p.width), below = at(p.y + p.height);
        switch (which) {
        case Part::Bar:
            return crop(all, 0, 0, kWidth, at(p.y));
        case Part::Left:
            return crop(all, 0, at(p.y), at(p.x), kHeight);
        case Part::Right:
            return crop(all, right, at(p.y), kWidth, kHeight);
        case Part::Bottom:
            return crop(all, at(p.x), below, right, kHeight);
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

    std::unique_ptr<VirtualDisplay> display_;
    GLFWwindow* window_ = nullptr;
    std::unique_ptr<Gpu> gpu_;
    std::unique_ptr<WindowTarget> target_;
    Model model_;
    MaterialController controller_;
    ServoView servo_;
    ForceHistory forces_{10000};
    MouseDevice hand_;
    PlaybackDevice again_{hand_};
    TimelineController timeline_{again_, {}};
    PanelInput input_;
    PanelState state_;
    std::map<std::string, WidgetRect> rects_;
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

/// Eight seconds that touch now and then; at 3 s friction is switched off, at 5 s half a second is missing.
std::vector<RecordedItem> recorded() {
    HapticSettings smooth;
    smooth.friction = FrictionMode::Off;
    RecordedScene scene{1, {}};
    scene.identity.path = scene.identity.absolutePath = "/nowhere/cup.glb";
    std::vector<RecordedItem> items{recordingOrigin("window", 1000.0), scene, RecordedSettings{1, {}},
                                    RecordedSettings{2, smooth}};
    RecordedTicks block;
    for (uint64_t i = 0; i < 8000; ++i) {
        if (i == 5000) {
            items.emplace_back(std::exchange(block, {}));
            items.emplace_back(RecordedLoss{500});
            i = 5500;
        }
        RecordedTick tick;
        tick.tick = i;
        tick.time = 1e-3 * static_cast<double>(i);
        tick.dt = 1e-3;
        tick.settings = i < 3000 ? 1 : 2;
        tick.scene = 1;
        tick.sample.valid = true;
        const double newton = std::max(0.0, std::sin(2.3 * tick.time)) * (i < 3000 ? 1.0 : 0.7);
        tick.force = {0.0, newton, 0.0};
        tick.contacts = newton > 0.0 ? 1 : 0;
        block.ticks.push_back(tick);
        if (block.ticks.size() == 1000)
            items.emplace_back(std::exchange(block, {}));
    }
    items.emplace_back(block);
    items.emplace_back(RecordedEnd{7500});
    return items;
}

TEST_F(PanelGolden, ARecordingThatIsLookedAt) {
    const ScratchFolder scratch;
    writeItems(scratch / "r.tsrec", recorded());
    timeline_.open(scratch / "r.tsrec");
    const auto turn = [&] { timeline_.update({.live = &forces_}); };
    while (!timeline_.looking())
        turn();
    timeline_.playback().seek(2.0);
    timeline_.playback().markBegin();
    timeline_.playback().seek(4.0);
    timeline_.playback().markEnd();
    timeline_.playback().seek(2.6);
    while (timeline_.tick().tick != timeline_.playback().cursor())
        turn();
    input_.tick = &timeline_.tick();
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
    EXPECT_EQ(model.message(), "saved " + (scratch / "model/a-1.png").string());
    EXPECT_EQ(charts.message(), "saved " + (scratch / "charts/b-1.png").string());
}

TEST_F(PanelGolden, FirstRun) {
    state_.introduced = false;
    expectPanel("first_run", Part::Picture, [&] { state_.simulatedHand = true; });
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
