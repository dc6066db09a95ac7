#pragma once
// What the panels show in tests: figures that stand still.

#include "devices/mouse/mouse_device.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"
#include "workbench/dialog/file_dialog.h"
#include "workbench/editor/material_controller.h"
#include "workbench/model/model.h"
#include "workbench/timeline/timeline_controller.h"
#include "workbench/window/layout.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace touchstone::test {

/// Eight seconds that touch now and then; at 3 s friction is switched off, at 5 s half a second is missing.
inline std::vector<RecordedItem> recordedTouches() {
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

class PanelFigures {
  protected:
    PanelFigures() {
        model_ = loadModel(TOUCHSTONE_ASSETS "/doughnut.glb", Fit::Workspace);
        controller_.open(model_, false);
        touchForTenSeconds();
        describe();
    }

    /// A recording is open, with a loop; it is written to `file`.
    void lookAt(const std::filesystem::path& file) {
        writeItems(file, recordedTouches());
        timeline_.open(file);
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
    }

    /// The list of recordings is read: one of a person and one that a fault left.
    void listRecordings() {
        writeItems(recordings_ / "20261125-043020.tsrec", recordedTouches());
        writeTextFile(recordings_ / "2026-11-23_06.14.18_fault.tsrec", "this is no recording");
        while (timeline_.list().recordings().size() < 2)
            timeline_.update({.now = now_ += 3.0, .live = &forces_, .listed = true});
    }

    Model model_;
    MaterialController controller_;
    ServoView servo_;
    ForceHistory forces_{10000};
    MouseDevice hand_;
    PlaybackDevice again_{hand_};
    ScratchFolder recordings_; ///< listed
    TimelineController timeline_{again_, {recordings_.path()}};
    FileDialog dialog_;
    PanelInput input_;
    PanelState state_;
    std::map<std::string, WidgetRect> rects_;

  private:
    double now_ = 0.0; ///< s
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
        input_.dialog = &dialog_;
        input_.tick = &servo_.last;
        input_.forces = &forces_;
        input_.framesPerSecond = 30.0;
        input_.sceneSize = {704, 392};
        input_.gpuName = "a device";
        state_.introduced = true;
    }
};

} // namespace touchstone::test
