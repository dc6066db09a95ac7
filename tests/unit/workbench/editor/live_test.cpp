// What is edited feels as it will when it is saved and opened again, and shares what it may.
#include "haptics/recording/scene_identity.h"
#include "tests/support/gltf_maker.h"
#include "tests/support/shared_files.h"
#include "tests/support/sweep.h"
#include "workbench/editor/haptic_fields.h"
#include "workbench/editor/material_controller.h"
#include "workbench/editor/presets.h"
#include "workbench/window/unsaved_changes_prompt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

namespace touchstone::live_test {
namespace {

Model modelOf(const std::filesystem::path& path, const LoadOptions& options = {}) {
    Model model;
    model.scene = loadScene(path, options);
    model.workspaceFromScene = workspaceFromScene(*model.scene, Fit::Workspace);
    model.haptic = compileHapticScene(*model.scene, model.workspaceFromScene);
    return model;
}

MaterialJob jobFor(const Model& model, const MaterialEdits& edits) {
    MaterialJob job;
    job.model = model;
    job.statements = edits.all();
    job.edits = textOf(edits.patches());
    job.path = model.scene->path;
    job.stamp = model.scene->file;
    return job;
}

void expectSamePlan(const EffectPlan& a, const EffectPlan& b, const std::string& name) {
    ASSERT_EQ(a.effects.size(), b.effects.size()) << name;
    for (size_t i = 0; i < a.effects.size(); ++i) {
        EXPECT_EQ(a.effects[i].on, b.effects[i].on) << name << " " << i;
        EXPECT_EQ(a.effects[i].reason, b.effects[i].reason) << name << " " << i;
        EXPECT_EQ(a.effects[i].memoryBytes, b.effects[i].memoryBytes) << name << " " << i;
    }
    EXPECT_EQ(a.plainSample, b.plainSample) << name;
    EXPECT_EQ(a.anyShading, b.anyShading) << name;
    EXPECT_EQ(a.dampingMap, b.dampingMap) << name;
}

/// `change` for every material: touchable at once, and again from the saved file.
template <class Change>
MadeMaterials expectTheSameWhenOpenedAgain(const std::filesystem::path& path, const Model& model,
                                           const char* what, const Change& change) {
    MaterialEdits edits(*model.scene);
    for (size_t m = 0; m < edits.size(); ++m) {
        HapticStatement next = edits.now(m);
        change(next, m);
        edits.change(m, next, what);
    }
    const std::string name = path.filename().string() + ", " + what;
    MadeMaterials made = makeMaterials(jobFor(model, edits));

    LoadOptions options;
    options.edits = textOf(edits.patches());
    const Model again = modelOf(path, options);
    EXPECT_EQ(made.feltHash, feltHash(*again.haptic, *again.scene)) << name;
    expectSamePlan(made.haptic->plan, again.haptic->plan, name);
    EXPECT_EQ(made.haptic->warnings.size(), again.haptic->warnings.size()) << name;
    return made;
}

/// What is done to each material, and whether the hand goes on touching it.
struct Change {
    const char* what;
    void (*change)(HapticStatement& next);
    bool touchGoesOn = true;
};

void stateNothing(HapticStatement& next) {
    const HapticStatement was = next;
    next = HapticStatement{};
    // Another representation is another geometry, and so are other voxels and another texture.
    next.implicit = was.implicit;
    for (const HapticNumber& number : hapticNumbers())
        if (number.settled == nullptr)
            next.*number.stated = was.*number.stated;
    next.height = was.height;
    next.friction = was.friction;
    next.stiffnessMap = was.stiffnessMap;
    next.dampingMap = was.dampingMap;
}

void haveNoRelief(HapticStatement& next) {
    next.normalTextureInfluence = 0.0f;
    if (next.height)
        next.height->scale = 0.0f;
}

void turnSides(HapticStatement& next) {
    next.sides = next.sides == SideChoice::Front ? SideChoice::Both : SideChoice::Front;
}

const std::array kChanges{
    Change{"rubber",
           [](HapticStatement& next) { next = withPreset(std::move(next), *findPreset("rubber")); }},
    Change{"no shading", [](HapticStatement& next) { next.forceShading = ShadingChoice::Off; }},
    Change{"no relief", haveNoRelief},
    Change{"nothing stated", stateNothing},
    Change{"one side", turnSides, false},
};

void expectTheSameForNumbers(const std::filesystem::path& path, const Model& model) {
    const MadeMaterials made =
        expectTheSameWhenOpenedAgain(path, model, "numbers", [](HapticStatement& next, size_t) {
            next.stiffness = 321.0f;
            next.damping = 0.5f;
            next.staticFriction = 0.6f;
            next.viscousFriction = 0.25f;
        });
    EXPECT_TRUE(made.touchGoesOn);
    EXPECT_FALSE(made.read);
    for (size_t i = 0; i < model.haptic->objects.size(); ++i)
        EXPECT_EQ(made.haptic->objects[i].get(), model.haptic->objects[i].get()) << "geometry is shared";
}

void expectTheSameForMaps(const std::filesystem::path& path, const Model& model) {
    const MadeMaterials made =
        expectTheSameWhenOpenedAgain(path, model, "other maps", [&](HapticStatement& next, size_t m) {
            const size_t t = m % model.scene->textures.size();
            (void)setHapticField(next, *model.scene, "heightTexture", std::to_string(t));
            (void)setHapticField(next, *model.scene, "stiffnessTexture", std::to_string(t));
            (void)setHapticField(next, *model.scene, "stiffnessTexture.min", "0.5");
        });
    EXPECT_FALSE(made.read && made.touchGoesOn);
}

/// Numbers on every file, and other maps where it has textures. Of the other changes two, which the file's
/// place in the list chooses; as a sweep all.
void expectTheSameForChanges(const std::vector<std::filesystem::path>& files) {
    const auto count = static_cast<size_t>(test::repetitions(2, static_cast<int>(kChanges.size())));
    for (size_t file = 0; file < files.size(); ++file) {
        const std::filesystem::path& path = files[file];
        const Model model = modelOf(path);
        expectTheSameForNumbers(path, model);
        if (!model.scene->textures.empty())
            expectTheSameForMaps(path, model);
        const bool editable = std::ranges::any_of(
            model.scene->materials, [](const Material& material) { return material.fileIndex >= 0; });
        for (size_t i = 0; i < count; ++i) {
            const Change& change = kChanges[(file * count + i) % kChanges.size()];
            const MadeMaterials made = expectTheSameWhenOpenedAgain(
                path, model, change.what, [&](HapticStatement& next, size_t) { change.change(next); });
            EXPECT_EQ(made.touchGoesOn, change.touchGoesOn || !editable) << path << ", " << change.what;
        }
    }
}

TEST(LiveMaterials, OurScenesFeelAsTheyWillWhenOpenedAgain) {
    const auto files = test::gltfFilesIn(TOUCHSTONE_ASSETS);
    EXPECT_GT(files.size(), 5u);
    expectTheSameForChanges(files);
}

TEST(LiveMaterials, RealModelsFeelAsTheyWillWhenOpenedAgain) {
    const auto models = test::modelsFolder();
    if (!models)
        GTEST_SKIP() << test::kNoModels;
    const auto files = test::gltfFilesIn(*models);
    EXPECT_FALSE(files.empty());
    expectTheSameForChanges(files);
}

TEST(LiveMaterials, ChangesOnTopOfChangesShareWhatTheyMay) {
    const Model model = modelOf(TOUCHSTONE_ASSETS "/swatches.glb");
    MaterialEdits edits(*model.scene);
    Model now = model;
    std::vector<Material> from = model.scene->materials;
    for (int step = 0; step < 6; ++step) {
        for (size_t m = 0; m < edits.size(); ++m) {
            HapticStatement next = edits.now(m);
            next.normalTextureInfluence = step % 2 == 0 ? 0.0f : 0.7f;
            next.staticFriction = 0.1f * static_cast<float>(step + 1);
            next.forceShading = step % 3 == 0 ? ShadingChoice::Off : ShadingChoice::Auto;
            edits.change(m, next, "step");
        }
        MaterialJob job = jobFor(now, edits);
        job.compiledFrom = from;
        job.model.scene = model.scene;
        job.forTheEye = step == 3;
        const MadeMaterials made = makeMaterials(job);
        ASSERT_FALSE(made.read);
        EXPECT_EQ(made.scene != nullptr, step == 3);
        LoadOptions options;
        options.edits = job.edits;
        const Model again = modelOf(TOUCHSTONE_ASSETS "/swatches.glb", options);
        EXPECT_EQ(made.feltHash, feltHash(*again.haptic, *again.scene)) << step;
        expectSamePlan(made.haptic->plan, again.haptic->plan, "swatches");
        now.haptic = made.haptic;
        from = made.materials;
    }
}

/// The desk as the window uses it.
class Controller : public testing::Test {
  protected:
    Controller() {
        std::filesystem::copy_file(TOUCHSTONE_ASSETS "/doughnut.glb", path_);
        model_ = modelOf(path_);
        controller_.open(model_, true);
    }
    /// Until nothing is left to do.
    void settle() {
        for (int i = 0; i < 20'000; ++i) {
            if (auto made = controller_.update(model_)) {
                model_.haptic = made->haptic;
                if (made->scene != nullptr)
                    model_.scene = made->scene;
                ++made_;
                last_ = std::move(made);
            } else if (!controller_.working() && !controller_.saving()) {
                return;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        FAIL() << "the desk does not come to rest";
    }
    void setFriction(float value) {
        HapticStatement next = controller_.edits().now(0);
        next.staticFriction = value;
        controller_.edits().change(0, next, "static friction");
    }

    test::TemporaryFolder folder_;
    std::filesystem::path path_ = folder_.path() / "doughnut.glb";
    Model model_;
    MaterialController controller_;
    std::optional<MadeMaterials> last_;
    int made_ = 0;
};

TEST_F(Controller, AChangeIsTouchableAndSaved) {
    settle();
    EXPECT_EQ(made_, 0);
    setFriction(0.77f);
    settle();
    EXPECT_EQ(model_.haptic->materials[0].staticFriction, static_cast<double>(0.77f));
    EXPECT_TRUE(last_->touchGoesOn);
    controller_.edits().endGesture();
    settle();
    EXPECT_EQ(model_.scene->materials[0].haptic.staticFriction.value, 0.77f) << "the eye has it too";
    controller_.save();
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    EXPECT_FALSE(controller_.edits().edited());
    ASSERT_TRUE(controller_.takeSaved());
    EXPECT_EQ(loadScene(path_)->materials[0].haptic.staticFriction.value, 0.77f);

    controller_.edits().undo();
    settle();
    EXPECT_TRUE(controller_.edits().edited());
    controller_.save();
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    const auto bytesOf = [](const std::filesystem::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    };
    const ScenePtr original = loadScene(TOUCHSTONE_ASSETS "/doughnut.glb"), now = loadScene(path_);
    EXPECT_EQ(now->materials[0].says.ours, original->materials[0].says.ours);
    EXPECT_EQ(bytesOf(path_).size(), bytesOf(TOUCHSTONE_ASSETS "/doughnut.glb").size());
}

TEST_F(Controller, SavedUnderAnotherNameItGoesOnThere) {
    setFriction(0.5f);
    const auto other = folder_.path() / "other.glb";
    controller_.saveAs(other);
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    EXPECT_EQ(controller_.path(), other);
    EXPECT_EQ(loadScene(other)->materials[0].haptic.staticFriction.value, 0.5f);
    EXPECT_NE(loadScene(path_)->materials[0].haptic.staticFriction.value, 0.5f);
    // Another map makes it read the file anew: the one that was saved.
    HapticStatement next = controller_.edits().now(0);
    ASSERT_EQ(setHapticField(next, *model_.scene, "dampingTexture", "0"), "");
    controller_.edits().change(0, next, "damping map");
    settle();
    EXPECT_FALSE(controller_.failed()) << controller_.notice();
    EXPECT_TRUE(last_->read);
    EXPECT_EQ(model_.haptic->materials[0].staticFriction, static_cast<double>(0.5f));
    EXPECT_FALSE(model_.haptic->materials[0].dampingMap.map.empty());
}

TEST_F(Controller, AFileThatSomebodyElseChangedIsNotWrittenOver) {
    std::ofstream(path_, std::ios::app) << "x";
    setFriction(0.5f);
    controller_.save();
    settle();
    EXPECT_TRUE(controller_.failed());
    EXPECT_NE(controller_.notice().find("has changed since"), std::string::npos) << controller_.notice();
    EXPECT_TRUE(controller_.edits().edited());
}

/// The question before unsaved materials are lost.
class LeavingTest : public Controller {
  protected:
    std::optional<UnsavedChangesPrompt::Answer> answer(PanelState::Leave what) {
        state_.leave = what;
        const std::optional<UnsavedChangesPrompt::Answer> at_once =
            unsavedChanges_.update(controller_, state_, problem_);
        if (at_once)
            return at_once;
        settle();
        return unsavedChanges_.update(controller_, state_, problem_);
    }

    const std::filesystem::path next_ = "another.glb";
    UnsavedChangesPrompt unsavedChanges_;
    PanelState state_;
    std::string problem_;
};

TEST_F(LeavingTest, WhatIsDiscardedMayGoAndWhatIsChangedLaterIsAskedForAnew) {
    EXPECT_TRUE(unsavedChanges_.mayLeave(next_, controller_, state_)) << "nothing is changed";
    setFriction(0.5f);
    state_.gallery = state_.help = true;
    EXPECT_FALSE(unsavedChanges_.mayLeave(next_, controller_, state_));
    EXPECT_FALSE(state_.gallery || state_.help) << "the question is seen";
    EXPECT_FALSE(unsavedChanges_.update(controller_, state_, problem_)) << "nobody has answered";
    const auto stays = answer(PanelState::Leave::Stay);
    ASSERT_TRUE(stays);
    EXPECT_FALSE(stays->go);
    EXPECT_FALSE(unsavedChanges_.mayLeave(next_, controller_, state_));
    const auto goes = answer(PanelState::Leave::Discard);
    ASSERT_TRUE(goes);
    EXPECT_TRUE(goes->go);
    EXPECT_EQ(goes->target, next_);
    EXPECT_TRUE(unsavedChanges_.mayLeave(next_, controller_, state_)) << "while the other model is read";
    setFriction(0.6f);
    EXPECT_FALSE(unsavedChanges_.mayLeave(next_, controller_, state_)) << "nobody has given this away";
}

TEST_F(LeavingTest, ASaveTakesWhatWasChangedWhileAnotherOneRan) {
    setFriction(0.5f);
    settle();
    controller_.save();
    (void)controller_.update(model_); // it begins
    ASSERT_TRUE(controller_.saving());
    setFriction(0.9f);
    EXPECT_FALSE(unsavedChanges_.mayLeave(next_, controller_, state_));
    const auto goes = answer(PanelState::Leave::Save);
    ASSERT_TRUE(goes);
    EXPECT_TRUE(goes->go);
    EXPECT_EQ(loadScene(path_)->materials[0].haptic.staticFriction.value, 0.9f);
}

TEST_F(LeavingTest, StayHoldsAlsoWhileItIsSavedAndAFailedSaveStays) {
    setFriction(0.5f);
    EXPECT_FALSE(unsavedChanges_.mayLeave({}, controller_, state_));
    state_.leave = PanelState::Leave::Save;
    EXPECT_FALSE(unsavedChanges_.update(controller_, state_, problem_)) << "it is being saved";
    const auto stays = answer(PanelState::Leave::Stay);
    ASSERT_TRUE(stays);
    EXPECT_FALSE(stays->go);
    settle();
    EXPECT_FALSE(unsavedChanges_.update(controller_, state_, problem_)) << "and that holds when it is saved";
    std::ofstream(path_, std::ios::app) << "x";
    setFriction(0.7f);
    EXPECT_FALSE(unsavedChanges_.mayLeave({}, controller_, state_));
    const auto failed = answer(PanelState::Leave::Save);
    ASSERT_TRUE(failed);
    EXPECT_FALSE(failed->go);
    EXPECT_NE(problem_.find("has changed since"), std::string::npos) << problem_;
}

} // namespace
} // namespace touchstone::live_test
