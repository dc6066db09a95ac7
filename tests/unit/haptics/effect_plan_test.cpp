// The effect plan: which effects a material calls for and why, and that what it says they hold is all that is
// held.

#include "haptics/scene/built_for.h"
#include "haptics/surface/surface_sample.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace touchstone::test::effect_plan_test {
namespace {

const PlannedEffect& planned(const HapticScene& scene, Effect effect, int material = 0) {
    for (const PlannedEffect& p : scene.plan.effects)
        if (p.effect == effect && p.material == material)
            return p;
    ADD_FAILURE() << effectName(effect) << " is not in the plan";
    return scene.plan.effects.front();
}

std::shared_ptr<const HapticScene> compiled(const Scene& scene) {
    return compileHapticScene(scene, Similarity{});
}

Scene plainPlane() {
    Scene scene;
    scene.materials.emplace_back();
    place(scene, quadMesh(0.05, 4), 0);
    return scene;
}

/// What is held besides the geometry, and what the plan says of it.
void expectAllMemoryTold(const HapticScene& scene) {
    uint64_t held = 0, told = 0;
    for (const auto& object : scene.objects)
        held += object->attributeBytes().all();
    for (const HapticMaterialData& material : scene.materials)
        held += material.memoryBytes();
    for (const PlannedEffect& effect : scene.plan.effects)
        told += effect.memoryBytes;
    EXPECT_EQ(told, held);
}

/// A map of everything, and every vertex attribute.
Scene richPlane() {
    Scene scene = plainPlane();
    Material& material = scene.materials[0];
    scene.images.push_back(image("wave", 16, 8, 3, [](double u, double v) {
        return glm::vec4(static_cast<float>(0.5 + 0.2 * std::sin(6.0 * u)), static_cast<float>(v), 1.0f,
                         1.0f);
    }));
    FactorMap factor;
    factor.texture = texture(0);
    factor.min = 0.5f;
    HeightMap heights;
    heights.texture = texture(0);
    heights.scale = 2e-4f;
    const auto stated = [](double value) -> HapticMaterial::Field<float> {
        return {static_cast<float>(value), HapticSource::Touchstone};
    };
    material.normalTexture = texture(0);
    HapticMaterial& haptic = material.haptic;
    haptic.height = {heights, HapticSource::Touchstone};
    haptic.friction = haptic.stiffnessMap = haptic.dampingMap = {factor, HapticSource::Touchstone};
    haptic.staticFriction = stated(0.5);
    haptic.dynamicFriction = stated(0.3);
    haptic.viscousFriction = stated(0.5);
    haptic.damping = stated(1.0);
    haptic.deformationRadius = stated(0.01);
    Mesh& mesh = scene.meshes[0];
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const float x = mesh.positions[v].x;
        mesh.friction.push_back(0.5f + x);
        mesh.damping.push_back(1.0f + x);
        mesh.stiffness.push_back(500.0f + 100.0f * x);
        mesh.heights.push_back(1e-3f * x);
        mesh.normals[v] = glm::normalize(glm::vec3(0.1f * x, 0.1f, 1.0f));
    }
    return scene;
}

constexpr Effect kAll[] = {Effect::ForceShading,     Effect::NormalMap,       Effect::HeightMap,
                           Effect::Friction,         Effect::ViscousFriction, Effect::Damping,
                           Effect::VaryingStiffness, Effect::Program,         Effect::LocalDeformation};

TEST(EffectPlan, APlainSceneHasNoneAndHoldsNothing) {
    const auto scene = compiled(plainPlane());
    for (const Effect effect : kAll) {
        EXPECT_FALSE(planned(*scene, effect).on) << effectName(effect);
        EXPECT_EQ(planned(*scene, effect).memoryBytes, 0u) << effectName(effect);
        EXPECT_FALSE(planned(*scene, effect).reason.empty());
    }
    EXPECT_TRUE(scene->plan.plainSample);
    EXPECT_EQ(scene->objects[0]->attributeBytes().all(), 0u)
        << "coordinates, tangents and normals that nothing reads";
}

TEST(EffectPlan, VertexAttributesAloneTurnTheirEffectOn) {
    struct Case {
        Effect effect;
        std::vector<float> Mesh::*attribute;
        const char* name;
        float value;
    };
    for (const Case& c : {Case{Effect::Friction, &Mesh::friction, "_FRICTION", 0.4f},
                          Case{Effect::Damping, &Mesh::damping, "_DAMPING", 2.0f},
                          Case{Effect::VaryingStiffness, &Mesh::stiffness, "_STIFFNESS", 300.0f},
                          Case{Effect::HeightMap, &Mesh::heights, "_HEIGHT", 1e-3f}}) {
        Scene source = plainPlane();
        std::vector<float>& values = source.meshes[0].*c.attribute;
        values.assign(source.meshes[0].positions.size(), c.value);
        const auto scene = compiled(source);
        const PlannedEffect& effect = planned(*scene, c.effect);
        EXPECT_TRUE(effect.on) << c.name;
        EXPECT_NE(effect.reason.find(c.name), std::string::npos) << effect.reason;
        EXPECT_GE(effect.memoryBytes, sizeof(float) * values.size()) << c.name;
        for (const Effect other : kAll)
            EXPECT_EQ(planned(*scene, other).on, other == c.effect) << c.name;
        expectAllMemoryTold(*scene);
    }
    Scene none = plainPlane(); // coefficients of nothing do nothing
    none.meshes[0].friction.assign(none.meshes[0].positions.size(), 0.0f);
    EXPECT_FALSE(planned(*compiled(none), Effect::Friction).on);
}

TEST(EffectPlan, TellsAllThatIsHeldAndNothingTwice) {
    const auto scene = compiled(richPlane());
    for (const Effect effect : kAll) {
        if (effect == Effect::Program) // ProgramEffect.* has it
            continue;
        EXPECT_TRUE(planned(*scene, effect).on) << effectName(effect);
        EXPECT_EQ(planned(*scene, effect).memoryBytes > 0,
                  effect != Effect::ViscousFriction && effect != Effect::LocalDeformation);
    }
    const size_t vertices = scene->objects[0]->normals.size();
    EXPECT_EQ(planned(*scene, Effect::ForceShading).memoryBytes,
              sizeof(glm::vec3) * vertices + scene->objects[0]->triangleCount());
    expectAllMemoryTold(*scene);
}

TEST(EffectPlan, SaysWhyAMapIsNotFelt) {
    Scene source = richPlane();
    HapticMaterial& haptic = source.materials[0].haptic;
    haptic.staticFriction = haptic.dynamicFriction = haptic.damping = {};
    Mesh& mesh = source.meshes[0];
    mesh.friction.clear();
    mesh.damping.clear();
    mesh.heights.clear();
    haptic.height.value->texture.texCoord = 1; // which the mesh has not
    source.materials[0].normalScale = 0.0f;
    const auto scene = compiled(source);
    const auto expectOff = [&](Effect effect, const char* why) {
        EXPECT_FALSE(planned(*scene, effect).on) << effectName(effect);
        EXPECT_NE(planned(*scene, effect).reason.find(why), std::string::npos)
            << planned(*scene, effect).reason;
    };
    expectOff(Effect::Friction, "no coefficient for it to multiply");
    expectOff(Effect::Damping, "no damping for it to multiply");
    expectOff(Effect::HeightMap, "no coordinates");
    expectOff(Effect::NormalMap, "felt share is 0");
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_EQ(scene->warnings[0].place, "materials[0].heightTexture");
    expectAllMemoryTold(*scene);

    source.materials.emplace_back(); // nobody's
    source.materials[1].haptic.staticFriction = {0.5f, HapticSource::Touchstone};
    EXPECT_EQ(planned(*compiled(source), Effect::Friction, 1).reason,
              "no touchable triangle has this material");
    source.materials[0].haptic.forceShading = ShadingChoice::Off;
    const auto flat = compiled(source);
    EXPECT_EQ(planned(*flat, Effect::ForceShading).reason, "the material turns it off");
    EXPECT_EQ(planned(*flat, Effect::ForceShading).memoryBytes, 0u);
}

TEST(EffectPlan, WhatIsOffLeavesThePlainTick) {
    // Maps of 1/2 all over, of coefficients that only a session states.
    Scene source = plainPlane();
    source.images.push_back(
        image("black", 4, 4, 3, [](double, double) { return glm::vec4(0.0f, 0.0f, 0.0f, 1.0f); }));
    FactorMap factor;
    factor.texture = texture(0);
    factor.min = 0.5f;
    HapticMaterial& haptic = source.materials[0].haptic;
    haptic.friction = haptic.dampingMap = {factor, HapticSource::Touchstone};
    source.meshes[0].friction.assign(source.meshes[0].positions.size(), 0.0f);
    source.meshes[0].damping = source.meshes[0].friction;
    const auto plain = [](const Scene& scene) { return compiled(scene)->plan.plainSample; };
    EXPECT_TRUE(plain(source));
    EXPECT_FALSE(planned(*compiled(source), Effect::Friction).on);
    EXPECT_FALSE(planned(*compiled(source), Effect::Damping).on);

    const auto stroke = [](const Scene& scene, const char* name, const char* value) {
        TouchBench bench(scene);
        bench.settings.textureStrength = 0.0;
        EXPECT_EQ(setSetting(bench.settings, name, value), "");
        bench.step({0.011, -0.007, 0.002});
        std::vector<glm::dvec3> forces;
        for (int i = 0; i < 300; ++i) {
            bench.step({0.011 + 2e-5 * i, -0.007, 0.002 - 1.2e-5 * i});
            forces.push_back(bench.output.force);
        }
        return forces;
    };
    const auto apart = [](const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
        double most = 0.0;
        for (size_t i = 0; i < a.size(); ++i)
            most = std::max(most, glm::distance(a[i], b[i]));
        return most;
    };
    const Scene bare = plainPlane();
    EXPECT_EQ(apart(stroke(source, "damping", "0"), stroke(bare, "damping", "0")), 0.0);
    EXPECT_LT(apart(stroke(source, "damping", "4"), stroke(bare, "damping", "2")), 1e-9);
    EXPECT_GT(apart(stroke(source, "damping", "4"), stroke(bare, "damping", "4")), 0.01);
    EXPECT_LT(apart(stroke(source, "staticFriction", "0.8"), stroke(bare, "staticFriction", "0.4")), 1e-9);
    EXPECT_GT(apart(stroke(source, "staticFriction", "0.8"), stroke(bare, "staticFriction", "0")), 0.01);

    // Vertices that say 0 take the material's own damping away: that is read.
    Scene undamped = source;
    undamped.materials[0].haptic.damping = {4.0f, HapticSource::Touchstone};
    EXPECT_FALSE(plain(undamped));
    EXPECT_EQ(apart(stroke(undamped, "stiffness", "0"), stroke(bare, "damping", "0")), 0.0);
    Scene damped = source;
    damped.meshes[0].damping.back() = 1.0f;
    EXPECT_FALSE(plain(damped));
    Scene rough = source;
    rough.meshes[0].friction.back() = 1.0f;
    EXPECT_FALSE(plain(rough));
}

TEST(EffectPlan, AnEffectThatIsTakenOffIsNotFelt) {
    // What `inspect` compares an effect with to tell its cost: the scene as if nobody had asked for it.
    const auto scene = compiled(richPlane());
    for (const Effect effect : kAll) {
        if (effect == Effect::Program) // ProgramEffect.* has it
            continue;
        const std::shared_ptr<HapticScene> without = copyOf(*scene);
        removeEffect(*without, 0, effect);
        TouchBench all(richPlane()), one(richPlane());
        one.scene = without;
        double apart = 0.0;
        for (TouchBench* bench : {&all, &one})
            bench->step({0.011, -0.007, 0.005});
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 hip(0.011 + 2e-5 * i, -0.007, 0.002 - 1.2e-5 * std::min(i, 250));
            all.step(hip);
            one.step(hip);
            apart = std::max(apart, glm::distance(all.output.force, one.output.force));
        }
        EXPECT_GT(apart, 1e-3) << effectName(effect);
        EXPECT_EQ(scene->objects[0]->heights.size(), scene->objects[0]->friction.size()) << "the copy alone";
    }
}

TEST(EffectPlan, CoefficientsOfTheMaterialAloneTurnTheirEffectOn) {
    const auto stated = [](double value) -> HapticMaterial::Field<float> {
        return {static_cast<float>(value), HapticSource::Touchstone};
    };
    struct Case {
        Effect effect;
        std::function<void(HapticMaterial&)> state;
        const char* reason;
    };
    for (const Case& c :
         {Case{Effect::Friction,
               [&](HapticMaterial& m) {
                   m.staticFriction = stated(0.5);
                   m.dynamicFriction = stated(0.25);
               },
               "static 0.5, dynamic 0.25"},
          Case{Effect::Damping, [&](HapticMaterial& m) { m.damping = stated(2.5); }, "2.5 N s/m"},
          Case{Effect::Damping,
               [&](HapticMaterial& m) {
                   m.stiffness = stated(500.0);
                   m.retardationTime = stated(0.004);
               },
               "2 N s/m"},
          Case{Effect::Damping,
               [&](HapticMaterial& m) {
                   m.stiffness = stated(500.0);
                   m.damping = stated(3.0);
                   m.retardationTime = stated(0.004);
               },
               "3 N s/m"},
          Case{Effect::ViscousFriction, [&](HapticMaterial& m) { m.viscousFriction = stated(1.5); },
               "1.5 N s/m"}}) {
        Scene source = plainPlane();
        c.state(source.materials[0].haptic);
        const auto scene = compiled(source);
        EXPECT_EQ(planned(*scene, c.effect).reason, c.reason);
        for (const Effect other : kAll)
            EXPECT_EQ(planned(*scene, other).on, other == c.effect) << effectName(other);
        EXPECT_EQ(scene->plan.plainSample, c.effect == Effect::Damping)
            << "damping is a constant of a plain tick";
    }
}

TEST(EffectPlan, ARetardationTimeWithoutStiffnessIsAWarningAndNoDamping) {
    Scene source = plainPlane();
    source.materials[0].haptic.retardationTime = {0.004f, HapticSource::Touchstone};
    const auto scene = compiled(source);
    EXPECT_FALSE(planned(*scene, Effect::Damping).on);
    ASSERT_EQ(scene->warnings.size(), 1u);
    EXPECT_EQ(scene->warnings[0].place, "materials[0]");
}

TEST(EffectPlan, NamesEverythingThatAnEffectReads) {
    const auto scene = compiled(richPlane());
    EXPECT_EQ(planned(*scene, Effect::NormalMap).reason, "normal map, felt share 100 %");
    EXPECT_EQ(planned(*scene, Effect::HeightMap).reason,
              "height map, 0.2 mm black to white, vertex heights (_HEIGHT)");
    EXPECT_EQ(planned(*scene, Effect::Friction).reason,
              "static 0.5, dynamic 0.3, vertex friction (_FRICTION), friction map, factor 0.5 to 1");
    EXPECT_EQ(planned(*scene, Effect::Damping).reason,
              "1 N s/m, vertex damping (_DAMPING), damping map, factor 0.5 to 1");
    EXPECT_EQ(planned(*scene, Effect::VaryingStiffness).reason,
              "vertex stiffness (_STIFFNESS), stiffness map, factor 0.5 to 1");
}

TEST(EffectPlan, TheSecondSetOfCoordinatesIsHeldAndToldLikeTheFirst) {
    Scene source = richPlane();
    source.meshes[0].uv1 = source.meshes[0].uv0;
    HapticMaterial& haptic = source.materials[0].haptic;
    haptic.height.value->texture.texCoord = 1;
    haptic.friction.value->texture.texCoord = 1;
    const auto scene = compiled(source);
    const size_t vertices = scene->objects[0]->normals.size();
    EXPECT_EQ(scene->objects[0]->uv[0].size(), vertices);
    EXPECT_EQ(scene->objects[0]->uv[1].size(), vertices);
    EXPECT_TRUE(scene->objects[0]->uvGradients[0].empty()) << "no height is read there";
    EXPECT_EQ(scene->objects[0]->uvGradients[1].size(), vertices);
    for (const glm::vec4& tangent : scene->objects[0]->tangents)
        EXPECT_NEAR(glm::length(glm::vec3(tangent)), 1.0f, 1e-6f);
    expectAllMemoryTold(*scene);
    EXPECT_EQ(planned(*scene, Effect::NormalMap).memoryBytes,
              scene->materials[0].normal.memoryBytes() + sizeof(glm::vec2) * vertices +
                  sizeof(scene->objects[0]->tangents[0]) * scene->objects[0]->tangents.size())
        << "the first map that reads a set is told to hold it";
    EXPECT_EQ(planned(*scene, Effect::Friction).memoryBytes,
              scene->materials[0].friction.map.memoryBytes() + sizeof(float) * vertices);
}

/// Any finite tangent of the file is a direction, whatever the scale; one of no length stays none.
TEST(EffectPlan, TangentsAreUnitAtEveryScale) {
    for (const double scale : {1e-3, 0.5, 1.0, 20.0}) {
        Scene source = richPlane();
        source.instances[0].sceneFromMesh = glm::scale(glm::dmat4(1.0), glm::dvec3(scale));
        source.meshes[0].tangents[0] = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
        const auto scene = compiled(source);
        const std::vector<glm::vec4>& tangents = scene->objects[0]->tangents;
        ASSERT_GT(tangents.size(), 1u);
        EXPECT_EQ(glm::length(glm::vec3(tangents[0])), 0.0f);
        for (size_t v = 1; v < tangents.size(); ++v)
            EXPECT_NEAR(glm::length(glm::vec3(tangents[v])), 1.0f, 1e-6f) << scale;
    }
}

TEST(EffectPlan, AnObjectTellsAllThatItHolds) {
    for (const Scene& source : {plainPlane(), richPlane()}) {
        const auto scene = compiled(source);
        const HapticObject& object = *scene->objects[0];
        EXPECT_EQ(object.memoryBytes(), sizeof(glm::vec3) * object.vertices.size() +
                                            sizeof(uint32_t) * object.indices.size() +
                                            sizeof(uint32_t) * object.sourceIndices.size() +
                                            (object.anySmooth ? 0 : object.smooth.size()) +
                                            object.attributeBytes().all() + object.tree.memoryBytes());
    }
    const auto scene = compiled(richPlane());
    // 16 x 8 texels and all coarser levels, as floats.
    EXPECT_GE(scene->materials[0].height.memoryBytes(), (128u + 32u + 8u + 2u + 1u) * sizeof(float));
    EXPECT_GE(scene->materials[0].normal.memoryBytes(), 3u * 128u * sizeof(float));
}

TEST(EffectPlan, ASettingOfZeroOverrulesMaterialVertexAndMap) {
    const auto scene = compiled(richPlane());
    const HapticObject& object = *scene->objects[0];
    Contact contact;
    contact.object = 0;
    contact.feature = 0;
    contact.normal = {0.0, 0.0, 1.0};
    for (size_t k = 0; k < 3; ++k)
        contact.point += glm::dvec3(object.vertices[object.indices[k]]) / 3.0;
    const auto feel = [&](const HapticSettings& settings) {
        return readSurface(*scene, scene->restMotions, settings, DeviceLimits{}, 0, contact, contact.normal,
                           1e-3, 0.0, 1e-3);
    };
    HapticSettings settings;
    SurfaceSample stated = feel(settings);
    EXPECT_GT(stated.damping, 0.4);
    EXPECT_GT(stated.staticFriction, 0.2);
    EXPECT_NEAR(stated.dynamicFriction, 0.6 * stated.staticFriction, 1e-6) << "as the material's ratio";
    EXPECT_EQ(stated.viscousFriction, 0.5);
    EXPECT_TRUE(stated.coulomb);
    settings.damping = 0.0;
    settings.dynamicFriction = 0.0;
    stated = feel(settings);
    EXPECT_EQ(stated.damping, 0.0);
    EXPECT_GT(stated.staticFriction, 0.2);
    EXPECT_EQ(stated.dynamicFriction, 0.0);
    settings.staticFriction = 0.0;
    stated = feel(settings);
    EXPECT_EQ(stated.staticFriction, 0.0);
    EXPECT_FALSE(stated.coulomb);
    settings.dynamicFriction = 5.0;
    settings.staticFriction = 0.5;
    stated = feel(settings);
    EXPECT_EQ(stated.dynamicFriction, stated.staticFriction) << "never above";
    settings.friction = FrictionMode::Off;
    stated = feel(settings);
    EXPECT_EQ(stated.staticFriction + stated.dynamicFriction + stated.viscousFriction, 0.0);
}

TEST(EffectPlan, WhatSettingsNeedIsBuiltWhenItIsAskedFor) {
    CompileOptions withoutRays;
    withoutRays.rays = false;
    const auto scene = compileHapticScene(richPlane(), Similarity{}, withoutRays);
    HapticSettings settings;
    EXPECT_TRUE(isBuiltFor(*scene, settings));
    settings.contact = ContactMethod::Rays;
    EXPECT_FALSE(isBuiltFor(*scene, settings));
    buildFor(*scene, settings);
    EXPECT_TRUE(scene->hasRays());
    EXPECT_TRUE(isBuiltFor(*scene, settings));
    settings.contact = ContactMethod::Neighbourhood;
    EXPECT_FALSE(isBuiltFor(*scene, settings));
    buildFor(*scene, settings);
    EXPECT_TRUE(isBuiltFor(*scene, settings));
    settings.textureGradient = TextureGradient::Precomputed;
    EXPECT_FALSE(isBuiltFor(*scene, settings));
    buildFor(*scene, settings);
    EXPECT_NE(scene->slopes(), nullptr);
    EXPECT_TRUE(isBuiltFor(*scene, settings));
}

} // namespace
} // namespace touchstone::test::effect_plan_test
