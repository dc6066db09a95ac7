#include "devices/plant/plant_parameters.h"

#include "engine/core/error.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace touchstone {

namespace {

// A gram and up: a lighter device or a stiffer hand would move faster than any servo can follow.
constexpr std::array kInfos{
    PlantInfo{"mass", "kg", 0.001, 10.0, "effective mass of the device at its tip"},
    PlantInfo{"viscousFriction", "N s/m", 0.0, 1000.0, "of the device"},
    PlantInfo{"coulombFriction", "N", 0.0, 10.0, "of the device"},
    PlantInfo{"resolution", "m", 0.0, 0.01, "of the position sensor on each axis; 0: exact"},
    PlantInfo{"delay", "ticks", 0.0, 1.0, "between a command and its force: 0 or 1"},
    PlantInfo{"maxForce", "N", 0.0, 1000.0, "where the motors saturate"},
    PlantInfo{"handMass", "kg", 0.0, 10.0, "what of the hand moves with the device"},
    PlantInfo{"handDamping", "N s/m", 0.0, 1000.0, "of the hand towards its path"},
    PlantInfo{"handStiffness", "N/m", 0.0, 1e7, "of the hand towards its path"},
};

std::string text(double number) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
    return {buffer.data(), result.ptr};
}

bool allowed(const PlantInfo& info, double value) {
    return value >= info.least && value <= info.most && (info.name != "delay" || value == std::floor(value));
}

double* fieldOf(PlantParameters& p, std::string_view name) {
    if (name == "mass")
        return &p.mass;
    if (name == "viscousFriction")
        return &p.viscousFriction;
    if (name == "coulombFriction")
        return &p.coulombFriction;
    if (name == "resolution")
        return &p.resolution;
    if (name == "maxForce")
        return &p.maxForce;
    if (name == "handMass")
        return &p.handMass;
    if (name == "handDamping")
        return &p.handDamping;
    if (name == "handStiffness")
        return &p.handStiffness;
    return nullptr;
}

std::string range(const PlantInfo& info) {
    return text(info.least) + " .. " + text(info.most) + " " + std::string(info.unit);
}

} // namespace

std::span<const PlantInfo> plantInfos() {
    return kInfos;
}

std::string setPlantParameter(PlantParameters& parameters, std::string_view name, std::string_view value) {
    for (const PlantInfo& info : kInfos) {
        if (info.name != name)
            continue;
        double number = 0.0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
        if (error != std::errc{} || end != value.data() + value.size() || !allowed(info, number))
            return "'" + std::string(value) + "' is not a value of " + std::string(name) +
                   "; allowed: " + range(info);
        if (name == "delay")
            parameters.delay = static_cast<int>(number);
        else
            *fieldOf(parameters, name) = number;
        return {};
    }
    std::string known;
    for (const PlantInfo& info : kInfos)
        known += (known.empty() ? "" : ", ") + std::string(info.name);
    return "the plant has no '" + std::string(name) + "'; known: " + known;
}

double plantParameter(const PlantParameters& parameters, std::string_view name) {
    if (name == "delay")
        return parameters.delay;
    PlantParameters copy = parameters;
    const double* field = fieldOf(copy, name);
    return field != nullptr ? *field : std::numeric_limits<double>::quiet_NaN();
}

void checkPlant(const PlantParameters& parameters) {
    for (const PlantInfo& info : kInfos)
        if (!allowed(info, plantParameter(parameters, info.name)))
            throw Error("simulated device", std::string(info.name), "is outside its range",
                        "give " + range(info));
}

} // namespace touchstone
