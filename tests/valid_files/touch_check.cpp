#include "tests/valid_files/touch_check.h"

#include "devices/stroke/stroke_path.h"
#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "haptics/body/body_world.h"
#include "haptics/comparison/comparison_solver.h"
#include "haptics/scene/built_for.h"
#include "haptics/texture/persistent_textures.h"
#include "haptics/tick/stepped_hand.h"
#include "tests/support/scene_promises.h"
#include "tests/valid_files/draw.h"
#include "workbench/figures/inspection.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace touchstone::test {
namespace {

constexpr double kTick = 1e-3; // s
constexpr int kStrokeTicks = 400, kWildTicks = 150;
/// The costs of effects are figures, which are of no use here: with 2 s for each file they took most of the
/// time.
constexpr int64_t kCostNs = 20'000'000;

class KeptFloatMode {
  public:
    KeptFloatMode() : mode_(_mm_getcsr()) { enterFloatMode(); }
    ~KeptFloatMode() { _mm_setcsr(mode_); }
    KeptFloatMode(const KeptFloatMode&) = delete;
    KeptFloatMode& operator=(const KeptFloatMode&) = delete;

  private:
    unsigned mode_;
};

HapticSettings anySettings(Draw& draw) {
    HapticSettings settings;
    const auto set = [&](const char* name, const std::vector<std::string>& values) {
        const std::string wrong = setSetting(settings, name, draw.pick(values));
        if (!wrong.empty())
            throw std::logic_error(wrong);
    };
    set("contact", {"sweep", "sweep", "neighbourhood", "rays", "virtualPoint", "potential"});
    set("precision", {"double", "single"});
    set("forceShading", {"material", "off", "twoPass", "projected", "direction", "bezier", "singleRound"});
    set("texture", {"law", "off", "blinn", "minsky", "blinnMagnitude"});
    set("textureFilter", {"mip", "nearest", "bilinear", "bicubic"});
    set("textureGradient", {"central", "precomputed", "analytic"});
    set("friction", {"zilles", "ho", "elastoplastic", "velocityThreshold", "kim", "off"});
    set("passivity", {"observe", "control", "off"});
    set("programs", {"dual", "dual", "central", "noGradient", "off"});
    set("deformation", {"on", "on", "off"});
    set("integrator", {"semiImplicit", "implicit", "explicit"});
    set("grasp", {"off", "off", "touch"});
    settings.proxyRadius = draw.pick(std::vector{0.0, 0.0005, 0.005});
    settings.stiffness = draw.pick(std::vector{0.0, 0.0, 300.0, 3000.0});
    settings.damping = draw.pick(std::vector{-1.0, 0.0, 2.0});
    settings.staticFriction = draw.pick(std::vector{-1.0, 0.0, 0.8});
    settings.dynamicFriction = draw.pick(std::vector{-1.0, 0.0, 0.5});
    settings.frictionDepth = draw.pick(std::vector{0.0, 100.0, 1000.0});
    settings.forceThreshold = draw.pick(std::vector{0.0, 0.5, 3.0});
    settings.textureStrength = draw.pick(std::vector{0.0, 0.5, 1.0});
    settings.iterationBudget = draw.pick(std::vector{1, 4, 64});
    return settings;
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// One touch of the model with one set of settings: a device's state, and what it must never show.
class Touch {
  public:
    Touch(const Model& model, const HapticSettings& settings, TouchReport& report)
        : model_(model), settings_(settings), report_(report), hand_(*model.haptic, model.scene) {
        buildFor(*model.haptic, settings);
    }

    void step(const glm::dvec3& hip, bool valid = true) {
        DeviceSample sample = sampleAt(hip);
        sample.valid = valid;
        (void)hand_.tick(settings_, sample, kTick * static_cast<double>(tick_), kTick);
        check(valid && finite(hip));
        checkWorld();
        last_ = output().command.force();
        ++tick_;
    }

    [[nodiscard]] const HapticOutput& output() const { return hand_.output; }

  private:
    void require(bool holds, const char* what) {
        if (holds || told_)
            return;
        told_ = true; // the first of a touch; the rest mostly follows from it
        std::string with;
        for (const auto& info : settingFields())
            with += " " + std::string(info.name) + "=" + settingValue(settings_, info.name);
        report_.findings.push_back(std::string(what) + " in tick " + std::to_string(tick_) + " with" + with);
    }

    void check(bool usable) {
        const HapticOutput& o = output();
        require(finite(o.force), "a force that is not finite");
        require(finite(o.proxy) && finite(o.hip) && finite(o.hipVelocity), "a place that is not finite");
        require(std::isfinite(o.penetration) && std::isfinite(o.height), "a length that is not finite");
        require(std::isfinite(o.energyBalance), "an energy that is not finite");
        require(finite(o.normal) &&
                    (o.normal == glm::dvec3(0.0) || std::abs(glm::length(o.normal) - 1.0) < 1e-6),
                "a normal that is not unit");
        const glm::dvec3 command = o.command.force();
        const DeviceLimits limits;
        require(finite(command) && glm::length(command) <= limits.maxForce * (1.0 + 1e-9),
                "a command beyond maxForce");
        require(glm::length(command - last_) <= limits.maxForceRate * kTick * (1.0 + 1e-9),
                "a command beyond maxForceRate");
        require(!has(o.flags, TickFlag::ForceFault), "a fault of the force");
        const bool held = settings_.grasp != GraspMode::Off && o.object >= 0 && o.triangle == -1;
        if (usable && !held) // a hand that holds an object touches by no method
            require(has(o.flags, TickFlag::NeighbourhoodMissing) ==
                        !refusalOf(hand_.world.touched(*model_.haptic), settings_).empty(),
                    "a contact method that is ready and was not used");
        require(has(o.flags, TickFlag::InputInvalid) == !usable, "a wrong InputInvalid");
        if (o.object >= 0) {
            const bool known = static_cast<size_t>(o.object) < model_.haptic->objects.size();
            require(known, "a touched object that is not there");
            const auto& object = known ? model_.haptic->objects[static_cast<size_t>(o.object)] : nullptr;
            require(object == nullptr || object->shape != nullptr || held ||
                        (o.triangle >= 0 && static_cast<size_t>(o.triangle) < object->triangleCount()),
                    "a touched triangle that is not there");
        }
        report_.contactTicks += o.contacts > 0 ? 1 : 0;
    }

    /// What touch moves and changes.
    void checkWorld() {
        if (const auto& bodies = hand_.world.bodies(); bodies != nullptr)
            for (const body::BodyState& state : bodies->states()) {
                require(finite(state.pose.position) && finite(state.velocity) && finite(state.spin),
                        "a body whose state is not finite");
                require(std::abs(glm::length(state.pose.rotation) - 1.0) < 1e-6, "a body with no rotation");
            }
        // Each texel of each texture: now and then.
        if (const auto& textures = hand_.world.textures(); textures != nullptr && tick_ % 50 == 0)
            for (size_t object = 0; object < textures->objects(); ++object)
                if (const PersistentTexture* texture = textures->at(static_cast<int>(object)))
                    for (const float value : texture->values())
                        require(value >= texture->size().minimum && value <= texture->size().maximum,
                                "a texel beyond its range");
    }

    const Model& model_;
    HapticSettings settings_;
    TouchReport& report_;
    SteppedHand hand_;
    glm::dvec3 last_{0.0};
    uint64_t tick_ = 0;
    bool told_ = false;
};

/// A stroke as `run` does it, then a hand out of control: anywhere in the bounds and beyond, fast and slow,
/// now and then without a usable sample.
void touch(const Model& model, const StrokePath& stroke, const HapticSettings& settings, Draw& draw,
           TouchReport& report) {
    Touch touch(model, settings, report);
    for (int i = 0; i < kStrokeTicks; ++i)
        touch.step(stroke.position(kTick * i));
    glm::dvec3 hip = stroke.position(kTick * kStrokeTicks);
    for (int i = 0; i < kWildTicks; ++i) {
        const double reach = draw.pick(std::vector{1e-5, 1e-4, 2e-3, 0.1});
        hip += glm::dvec3(draw.real(-reach, reach), draw.real(-reach, reach), draw.real(-reach, reach));
        hip = glm::clamp(hip, glm::dvec3(-0.15), glm::dvec3(0.15));
        if (draw.chance(0.02))
            touch.step({hip.x, std::numeric_limits<double>::quiet_NaN(), hip.z});
        else
            touch.step(hip, !draw.chance(0.02));
    }
}

/// strokeOver refuses models that offer no place to press; then the hand wanders about the origin alone.
StrokePath strokeFor(const Model& model) {
    try {
        return strokeOver(*model.scene, model.workspaceFromScene, {.speed = 0.2, .clearance = 0.004});
    } catch (const Error&) {
        const std::vector<glm::dvec3> nowhere(4, glm::dvec3(0.0));
        return StrokePath::around(nowhere, 0.1);
    }
}

/// Programs are compiled anew where nobody holds them any more, 0.1 s each: those of these files are few.
void keepPrograms(const Scene& scene) {
    static std::vector<std::shared_ptr<const SurfaceProgram>> kept;
    for (const Material& material : scene.materials)
        if (const auto& program = material.haptic.program.compiled;
            program != nullptr && std::ranges::find(kept, program) == kept.end() && kept.size() < 16)
            kept.push_back(program);
}

void touchAll(const Model& model, uint64_t seed, TouchReport& report) {
    const StrokePath stroke = strokeFor(model);
    Draw draw(seed);
    touch(model, stroke, HapticSettings{}, draw, report);
    for (int i = 0; i < 3; ++i)
        touch(model, stroke, anySettings(draw), draw, report);
}

/// What has no number in it that is none: those are null in JSON.
void checkInspection(const nlohmann::ordered_json& inspection, TouchReport& report) {
    const auto require = [&](bool holds, const char* what) {
        if (!holds)
            report.findings.push_back(std::string("the inspection has ") + what);
    };
    require(inspection["triangles"] == report.triangles, "another number of triangles");
    const auto dumped = nlohmann::json::parse(
        inspection.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    require(!dumped["workspace_from_scene_scale"].is_null(), "no scale");
    if (report.touchable)
        for (const char* end : {"low", "high"})
            for (const auto& number : dumped["bounds_m"][end])
                require(number.is_number(), "bounds that are not finite");
    for (const auto& object : dumped["objects"])
        require(object["memory_bytes"] > 0, "an object without memory");
}

} // namespace

TouchReport openAndTouch(const std::vector<uint8_t>& file, uint64_t seed) {
    TouchReport report;
    try {
        Model model;
        model.scene = loadSceneFromMemory(file, "/nonexistent");
        keepPrograms(*model.scene);
        if (const auto broken = brokenPromise(*model.scene))
            report.findings.push_back("the scene breaks its promise: " + *broken);
        report.triangles = model.scene->triangleCount();
        report.touchable = model.scene->touchable();
        model.workspaceFromScene = workspaceFromScene(*model.scene, Fit::Workspace);
        model.haptic = compileHapticScene(*model.scene, model.workspaceFromScene);
        for (const auto* list : {&model.scene->warnings, &model.haptic->warnings})
            for (const Warning& warning : *list)
                report.warnings.push_back(warning.place + ": " + warning.message);
        const KeptFloatMode kept;
        checkInspection(inspectionOf(model, kCostNs), report);
        if (report.touchable)
            touchAll(model, seed, report);
    } catch (const Error& refused) {
        report.findings.push_back(std::string("refused: ") + refused.what());
    }
    return report;
}

} // namespace touchstone::test
