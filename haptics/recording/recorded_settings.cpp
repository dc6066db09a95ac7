#include "haptics/recording/recorded_settings.h"

#include "engine/core/field_rows.h"
#include "engine/core/member_count.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>

namespace touchstone {

namespace {

/// A limit as a recording names it. Its range is the device's own to check.
template <auto Member>
constexpr StructField<DeviceLimits> limit(std::string_view name) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    return numberField<Member>(name, "", -kAny, kAny, "");
}

constexpr std::array kLimits{
    limit<&DeviceLimits::maxForce>("maxForce"),
    limit<&DeviceLimits::maxForceRate>("maxForceRate"),
    limit<&DeviceLimits::maxTorque>("maxTorque"),
    limit<&DeviceLimits::maxTorqueRate>("maxTorqueRate"),
    limit<&DeviceLimits::recommendedStiffness>("recommendedStiffness"),
    limit<&DeviceLimits::maxStiffness>("maxStiffness"),
    limit<&DeviceLimits::staleAge>("staleAge"),
    limit<&DeviceLimits::positionResolution>("positionResolution"),
    limit<&DeviceLimits::apparentMass>("apparentMass"),
    limit<&DeviceLimits::coulombFriction>("coulombFriction"),
    switchField<&DeviceLimits::commandDelay>("commandDelay", ""),
    limit<&DeviceLimits::press>("press"),
};
static_assert(kLimits.size() == memberCount<DeviceLimits>(), "a limit is not recorded");

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

/// Moves a number into its field and out of the list.
template <class S>
void takeNumber(NamedNumbers& numbers, const StructField<S>& field, S& to) {
    const auto found = numbers.find(field.name);
    if (found == numbers.end())
        return;
    const double value = found->second;
    constexpr double kLargestInt = 2e9;
    if (field.whole && !(std::abs(value) < kLargestInt && value == std::floor(value)))
        throw Error("", std::string(field.name), "is no whole number", "");
    if (!field.words.empty() && !(value >= 0.0 && value < static_cast<double>(field.words.size())))
        throw Error("", std::string(field.name), "is a choice that this version does not have",
                    "use the version that recorded it");
    field.set(to, value);
    numbers.erase(found);
}

template <class S>
void putFields(ByteWriter& bytes, std::span<const StructField<S>> fields, const S& values) {
    NamedNumbers numbers;
    for (const StructField<S>& field : fields)
        numbers.emplace(field.name, field.get(values));
    putNumbers(bytes, numbers);
}

template <class S, class Check>
S fieldsOf(NamedNumbers numbers, std::span<const StructField<S>> fields, const Check& check) {
    S values;
    for (const StructField<S>& field : fields) {
        takeNumber(numbers, field, values);
        check(field, values);
    }
    if (!numbers.empty())
        throw Error("", numbers.begin()->first, "is not known to this version",
                    "use the version that recorded it");
    return values;
}

} // namespace

void putSettings(ByteWriter& bytes, const HapticSettings& settings) {
    putFields(bytes, settingFields(), settings);
}

void putLimits(ByteWriter& bytes, const std::optional<DeviceLimits>& limits) {
    if (limits)
        putFields<DeviceLimits>(bytes, kLimits, *limits);
    else
        putNumbers(bytes, {});
}

HapticSettings getSettings(ByteReader& bytes) {
    return fieldsOf(getNumbers(bytes), settingFields(),
                    [](const auto& field, const HapticSettings& settings) {
                        const std::string written = writtenValue(field, field.get(settings));
                        double value = 0.0;
                        if (!readValue(field, written, value))
                            throw Error("", std::string(field.name), refusedValue(field, written), "");
                    });
}

std::optional<DeviceLimits> getLimits(ByteReader& bytes) {
    NamedNumbers numbers = getNumbers(bytes);
    if (numbers.empty())
        return std::nullopt;
    return fieldsOf<DeviceLimits>(std::move(numbers), kLimits, [](const auto&, const DeviceLimits&) {});
}

} // namespace touchstone
