#include "tests/property/device_storm.h"

#include "engine/load/scene_loader.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/tick/haptic_step.h"
#include "haptics/world/world_state.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace touchstone::test {

namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const HapticOutput& output) {
    bool all = finite(output.hip) && finite(output.hipVelocity) && finite(output.proxy) &&
               finite(output.normal) && finite(output.force) && finite(output.command.force()) &&
               finite(output.command.torque()) && finite(output.commandInWorkspace) &&
               finite(output.stictionPoint) && std::isfinite(output.penetration) &&
               std::isfinite(output.height);
    for (uint32_t i = 0; i < output.planeCount; ++i)
        all = all && finite(output.planes[i]);
    return all;
}

HapticSettings someSettings(StormyDevice& device) {
    HapticSettings settings;
    settings.contact = device.chance(0.3) ? ContactMethod::Neighbourhood : ContactMethod::Sweep;
    settings.forceShading = static_cast<ShadingMode>(device.integer() % 5);
    settings.texture = static_cast<TextureMode>(device.integer() % 4);
    settings.friction = static_cast<FrictionMode>(device.integer() % 4);
    settings.proxyRadius = device.chance(0.5) ? 0.0 : 2e-3 * std::abs(device.number());
    settings.stiffness = device.chance(0.5) ? 0.0 : std::pow(10.0, 1.0 + 3.0 * std::abs(device.number()));
    settings.damping = device.chance(0.5) ? -1.0 : 20.0 * std::abs(device.number());
    settings.staticFriction = device.chance(0.5) ? -1.0 : 2.0 * std::abs(device.number());
    settings.dynamicFriction = device.chance(0.5) ? -1.0 : 2.0 * std::abs(device.number());
    settings.iterationBudget = device.chance(0.2) ? 1 : 64;
    return settings;
}

Similarity someClutch(StormyDevice& device) {
    Similarity workspaceFromDevice;
    workspaceFromDevice.scale = std::pow(10.0, device.number());
    const glm::dvec3 axis(device.number(), device.number(), 1.5);
    workspaceFromDevice.rotation = glm::angleAxis(3.0 * device.number(), glm::normalize(axis));
    workspaceFromDevice.translation = 0.02 * glm::dvec3(device.number(), device.number(), device.number());
    return workspaceFromDevice;
}

} // namespace

double StormyDevice::strange() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    switch (integer() % 8) {
    case 0:
        return std::numeric_limits<double>::quiet_NaN();
    case 1:
        return std::copysign(kInfinity, number());
    case 2:
        return std::copysign(std::numeric_limits<double>::denorm_min(), number());
    case 3:
        return std::copysign(std::numeric_limits<double>::max(), number());
    case 4:
        return number() * std::numeric_limits<double>::min(); // denormal
    default:
        return number() *
               std::pow(10.0, 12.0 * number()); // from a picometre to a thousand kilometres and more
    }
}

DeviceSample StormyDevice::next() {
    velocity_ += 0.2 * vector() - 0.05 * velocity_;
    place_ += 1e-3 * velocity_;
    if (std::abs(place_.x) > size_ || std::abs(place_.y) > size_ || std::abs(place_.z) > size_)
        velocity_ = -place_ / size_;
    if (chance(0.02))
        place_ = size_ * vector(); // a jump across the workspace
    DeviceSample sample;
    sample.position = place_;
    if (chance(0.03))
        sample.position[static_cast<int>(integer() % 3)] = strange();
    if (chance(0.005))
        sample.position = {strange(), strange(), strange()};
    sample.orientation = chance(0.01) ? glm::dquat(strange(), strange(), strange(), strange())
                                      : glm::dquat(1.0, 0.0, 0.0, 0.0);
    sample.buttons = static_cast<uint32_t>(integer());
    sample.age = chance(0.02)   ? strange()
                 : chance(0.05) ? 0.1 * std::abs(number())
                                : 1e-3 * std::abs(number());
    sample.valid = !chance(0.02);
    return sample;
}

double StormyDevice::nextDt() {
    return chance(0.02) ? std::pow(10.0, -4.0 + 5.0 * number()) : 1e-3 * (1.0 + 0.1 * number());
}

StormFigures storm(const std::string& sceneFile, uint64_t seed, uint64_t ticks) {
    const ScenePtr source = loadScene(std::string(TOUCHSTONE_ASSETS "/") + sceneFile);
    DeviceLimits limits;
    limits.maxForceRate = 2000.0; // a fifth of what is usual, so that the limit is felt
    const auto scene = compileHapticScene(*source, workspaceFromScene(*source, Fit::Workspace));
    scene->buildNeighbourhoods();
    StormyDevice device(seed, 0.1);
    HapticSettings settings;
    WorldState world(source, *scene);
    DeviceState state;
    NoStopwatch none;
    DeviceMapping mapping;
    StormFigures figures;
    glm::dvec3 previous(0.0);
    double time = 0.0;
    for (; figures.ticks < ticks; ++figures.ticks) {
        if (device.chance(0.001)) {
            settings = someSettings(device);
            settings.forceEnabled = !device.chance(0.1);
        }
        if (device.chance(0.0005))
            mapping.workspaceFromDevice = device.chance(0.5) ? Similarity{} : someClutch(device);
        if (device.chance(0.01))
            mapping.coupling = device.number();
        if (device.chance(0.0005)) { // as at a scene swap
            state.forgetTouch();
            ForceLimiter::restartRamp(state.limiter);
        }
        DeviceSample sample = device.next();
        sample.mapping = mapping;
        sample.limits = limits;
        TickInput input;
        input.tick = figures.ticks;
        input.dt = device.nextDt();
        input.time = time += input.dt;
        input.late = device.chance(0.1);
        input.hands = {&sample, 1};
        world.advance(input.time);
        HapticOutput output;
        hapticStep(*scene, settings, input, world, {&state, 1}, {&output, 1}, none);

        const glm::dvec3 force = output.command.force();
        const bool fault = has(output.flags, TickFlag::ForceFault);
        constexpr double kRounding = 1.0 + 1e-12;
        EXPECT_TRUE(finite(output)) << sceneFile << " seed " << seed << " tick " << figures.ticks;
        EXPECT_LE(glm::length(force), limits.maxForce) << "tick " << figures.ticks;
        EXPECT_EQ(output.command.torque(), glm::dvec3(0.0));
        if (fault)
            EXPECT_EQ(force, glm::dvec3(0.0));
        else
            EXPECT_LE(glm::length(force - previous), limits.maxForceRate * input.dt * kRounding + 1e-15)
                << sceneFile << " seed " << seed << " tick " << figures.ticks;
        previous = force;
        figures.contacts += output.contacts > 0 ? 1 : 0;
        figures.invalid += has(output.flags, TickFlag::InputInvalid) ? 1 : 0;
        figures.limited += has(output.flags, TickFlag::ForceLimited) ? 1 : 0;
        figures.forces += glm::length(force) > 0.0 ? 1 : 0;
        figures.faults += fault ? 1 : 0;
        if (testing::Test::HasFailure())
            break;
        if (has(output.flags, TickFlag::SafetyLatched) && device.chance(0.01)) // the key that clears a latch
            settings.forceEnabled = false;
        else if (!settings.forceEnabled && device.chance(0.01))
            settings.forceEnabled = true;
    }
    return figures;
}

} // namespace touchstone::test
