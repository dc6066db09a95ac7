#include "haptics/recording/recorded_settings.h"

#include <cmath>
#include <map>

namespace touchstone {

namespace {

/// Third argument: the number of a choice's values; 0: a number.
template <class Settings, class Visit>
void eachSetting(Settings& s, const Visit& visit) {
    visit("contact", s.contact, 3);
    visit("precision", s.precision, 2);
    visit("forceShading", s.forceShading, 5);
    visit("texture", s.texture, 4);
    visit("friction", s.friction, 4);
    visit("proxyRadius", s.proxyRadius, 0);
    visit("stiffness", s.stiffness, 0);
    visit("damping", s.damping, 0);
    visit("staticFriction", s.staticFriction, 0);
    visit("dynamicFriction", s.dynamicFriction, 0);
    visit("shadingTiltLimit", s.shadingTiltLimit, 0);
    visit("textureTiltLimit", s.textureTiltLimit, 0);
    visit("textureStrength", s.textureStrength, 0);
    visit("textureFilter", s.textureFilter, 4);
    visit("textureGradient", s.textureGradient, 3);
    visit("iterationBudget", s.iterationBudget, 0);
    visit("passivity", s.passivity, 3);
    visit("forceEnabled", s.forceEnabled, 2);
}

template <class Limits, class Visit>
void eachLimit(Limits& l, const Visit& visit) {
    visit("maxForce", l.maxForce, 0);
    visit("maxForceRate", l.maxForceRate, 0);
    visit("maxTorque", l.maxTorque, 0);
    visit("maxTorqueRate", l.maxTorqueRate, 0);
    visit("recommendedStiffness", l.recommendedStiffness, 0);
    visit("maxStiffness", l.maxStiffness, 0);
    visit("staleAge", l.staleAge, 0);
    visit("positionResolution", l.positionResolution, 0);
    visit("apparentMass", l.apparentMass, 0);
    visit("coulombFriction", l.coulombFriction, 0);
    visit("commandDelay", l.commandDelay, 2);
}

using NamedNumbers = std::map<std::string, double, std::less<>>;

void putNumbers(ByteWriter& bytes, const NamedNumbers& numbers) {
    bytes.put(static_cast<uint16_t>(numbers.size()));
    for (const auto& [name, value] : numbers) {
        bytes.put(name);
        bytes.put(value);
    }
}

NamedNumbers getNumbers(ByteReader& bytes) {
    uint16_t count = 0;
    bytes.get(count);
    NamedNumbers numbers;
    for (int i = 0; i < count; ++i) {
        std::string name;
        double value = 0.0;
        bytes.get(name);
        bytes.get(value);
        numbers[name] = value;
    }
    return numbers;
}

/// Moves a number from the list into its field.
template <class Field>
void takeNumber(NamedNumbers& numbers, std::string_view name, Field& field, int choices) {
    const auto found = numbers.find(name);
    if (found == numbers.end())
        return;
    const double value = found->second;
    constexpr double kLargestInt = 2e9;
    if (!std::is_same_v<Field, double> && !(std::abs(value) < kLargestInt && value == std::floor(value)))
        throw Error("", std::string(name), "is no whole number", "");
    if (choices > 0 && !(value >= 0.0 && value < choices))
        throw Error("", std::string(name), "is a choice that this version does not have",
                    "use the version that recorded it");
    if constexpr (std::is_same_v<Field, bool>)
        field = value != 0.0;
    else
        field = static_cast<Field>(value);
    numbers.erase(found);
}

void refuseStrangers(const NamedNumbers& numbers) {
    if (!numbers.empty())
        throw Error("", numbers.begin()->first, "is not known to this version",
                    "use the version that recorded it");
}

} // namespace

void putSettings(ByteWriter& bytes, const HapticSettings& settings) {
    NamedNumbers numbers;
    eachSetting(settings,
                [&](const char* name, auto value, int) { numbers[name] = static_cast<double>(value); });
    putNumbers(bytes, numbers);
}

void putLimits(ByteWriter& bytes, const DeviceLimits& limits) {
    NamedNumbers numbers;
    eachLimit(limits, [&](const char* name, auto value, int) { numbers[name] = static_cast<double>(value); });
    putNumbers(bytes, numbers);
}

HapticSettings getSettings(ByteReader& bytes) {
    NamedNumbers numbers = getNumbers(bytes);
    HapticSettings settings;
    eachSetting(settings, [&](const char* name, auto& field, int choices) {
        takeNumber(numbers, name, field, choices);
        HapticSettings allowed;
        const std::string problem = setSetting(allowed, name, settingValue(settings, name));
        if (!problem.empty())
            throw Error("", name, problem, "");
    });
    refuseStrangers(numbers);
    return settings;
}

DeviceLimits getLimits(ByteReader& bytes) {
    NamedNumbers numbers = getNumbers(bytes);
    DeviceLimits limits;
    eachLimit(limits,
              [&](const char* name, auto& field, int choices) { takeNumber(numbers, name, field, choices); });
    refuseStrangers(numbers);
    return limits;
}

} // namespace touchstone
