// Steps forth and back, and what they come to in the file.
#include "engine/scene/haptic_layers.h"
#include "tests/support/gltf_maker.h"
#include "workbench/editor/material_edits.h"
#include "workbench/editor/presets.h"

#include <gtest/gtest.h>

namespace touchstone::edits_test {
namespace {

Scene twoMaterials() {
    Scene scene;
    scene.materials.resize(3);
    scene.materials[0].fileIndex = 0;
    scene.materials[0].says.ours.stiffness = 500.0f;
    scene.materials[1].fileIndex = 1;
    scene.materials[1].says.meanRoughness = 0.5f;
    return scene; // the third is glTF's default
}

HapticStatement withFriction(const MaterialEdits& edits, size_t material, float value) {
    HapticStatement next = edits.now(material);
    next.staticFriction = value;
    return next;
}

TEST(MaterialEdits, AreThoseOfTheFile) {
    const MaterialEdits edits(twoMaterials());
    EXPECT_EQ(edits.size(), 2u);
    EXPECT_EQ(edits.now(0).stiffness, 500.0f);
    EXPECT_FALSE(edits.edited());
    EXPECT_TRUE(edits.patches().empty());
}

TEST(MaterialEdits, GoBackAndForth) {
    MaterialEdits edits(twoMaterials());
    edits.change(0, withFriction(edits, 0, 0.2f), "static friction");
    edits.endGesture();
    edits.change(1, withFriction(edits, 1, 0.7f), "static friction");
    EXPECT_TRUE(edits.edited(0) && edits.edited(1));
    edits.undo();
    EXPECT_FALSE(edits.edited(1));
    EXPECT_EQ(edits.now(0).staticFriction, 0.2f);
    edits.undo();
    EXPECT_FALSE(edits.edited());
    EXPECT_EQ(edits.undoName(), "");
    edits.undo();
    EXPECT_EQ(edits.redoName(), "static friction");
    edits.redo();
    edits.redo();
    edits.redo();
    EXPECT_EQ(edits.now(1).staticFriction, 0.7f);
    EXPECT_EQ(edits.redoName(), "");
}

TEST(MaterialEdits, ADraggedSliderIsOneStep) {
    MaterialEdits edits(twoMaterials());
    const uint64_t before = edits.revision();
    for (int i = 1; i <= 10; ++i)
        edits.change(0, withFriction(edits, 0, 0.1f * static_cast<float>(i)), "static friction");
    EXPECT_EQ(edits.revision(), before + 10);
    EXPECT_TRUE(edits.inGesture());
    edits.endGesture();
    edits.change(0, withFriction(edits, 0, 0.05f), "static friction");
    edits.undo();
    EXPECT_EQ(edits.now(0).staticFriction, 1.0f);
    edits.undo();
    EXPECT_FALSE(edits.now(0).staticFriction);
}

TEST(MaterialEdits, WhatWasUndoneIsGoneAfterAnotherChange) {
    MaterialEdits edits(twoMaterials());
    edits.change(0, withFriction(edits, 0, 0.2f), "a");
    edits.undo();
    edits.change(0, withFriction(edits, 0, 0.3f), "b");
    edits.redo();
    EXPECT_EQ(edits.now(0).staticFriction, 0.3f);
    edits.undo();
    EXPECT_FALSE(edits.edited());
}

TEST(MaterialEdits, WhatIsSavedIsNoLongerEditedAndCanStillBeUndone) {
    MaterialEdits edits(twoMaterials());
    edits.change(0, withFriction(edits, 0, 0.2f), "a");
    edits.saved(edits.all());
    EXPECT_FALSE(edits.edited());
    edits.undo();
    EXPECT_TRUE(edits.edited());
    const MaterialPatches patches = edits.patches();
    EXPECT_EQ(textOf(patches), R"({"0":{"staticFriction":null}})");
    EXPECT_EQ(textOf(patchesFrom(textOf(patches))), textOf(patches));
}

TEST(MaterialEdits, APatchNamesWhatDiffersAndNothingElse) {
    HapticStatement from, to;
    from.stiffness = to.stiffness = 600.0f;
    from.damping = 1.0f;
    to.dynamicFriction = 0.35f;
    to.forceShading = ShadingChoice::Off;
    from.sides = SideChoice::Front;
    from.height = to.height = HeightMap{.texture = {.texture = 3, .image = 1}, .scale = 0.001f};
    to.height->scale = 0.002f;
    to.friction = FactorMap{.texture = {.texture = 2, .image = 0, .texCoord = 1}, .min = 0.5f, .max = 1.0f};
    EXPECT_EQ(patchBetween(from, to).dump(),
              R"({"damping":null,"dynamicFriction":0.35,"heightTexture":{"scale":0.002},)"
              R"("frictionTexture":{"index":2,"texCoord":1,"min":0.5,"max":null},)"
              R"("forceShading":"off","sides":null})");
    EXPECT_EQ(patchBetween(to, to).dump(), "{}");
}

TEST(MaterialEdits, AResetFieldIsDerivedAgain) {
    Scene scene = twoMaterials();
    for (Material& material : scene.materials)
        material.haptic = settledHaptics(material.says, scene.images);
    MaterialEdits edits(scene);
    edits.change(1, withFriction(edits, 1, 0.9f), "a");
    std::vector<Material> materials = editedMaterials(scene, edits.all());
    EXPECT_EQ(materials[1].haptic.staticFriction.value, 0.9f);
    EXPECT_EQ(materials[1].haptic.staticFriction.source, HapticSource::Touchstone);
    edits.change(1, HapticStatement{}, "b");
    materials = editedMaterials(scene, edits.all());
    EXPECT_NEAR(*materials[1].haptic.staticFriction.value, 0.15 + 0.6 * 0.5, 1e-6);
    EXPECT_EQ(materials[1].haptic.staticFriction.source, HapticSource::DerivedFromPbr);
}

TEST(Presets, AreToldApartAndKeepMaps) {
    HapticStatement statement;
    statement.height = HeightMap{.texture = {.texture = 0, .image = 0}, .scale = 0.001f};
    for (const MaterialPreset& preset : materialPresets()) {
        const HapticStatement with = withPreset(statement, preset);
        EXPECT_EQ(presetOf(with), &preset) << preset.name;
        EXPECT_EQ(findPreset(preset.name), &preset);
        EXPECT_EQ(with.height, statement.height);
        EXPECT_LE(preset.dynamicFriction, preset.staticFriction);
        EXPECT_FALSE(preset.reason.empty());
    }
    EXPECT_EQ(materialPresets().size(), 6u);
    EXPECT_EQ(presetOf(statement), nullptr);
    EXPECT_EQ(findPreset("cheese"), nullptr);
}

} // namespace
} // namespace touchstone::edits_test
