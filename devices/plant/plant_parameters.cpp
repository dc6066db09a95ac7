#include "devices/plant/plant_parameters.h"

#include "engine/core/error.h"
#include "engine/core/member_count.h"

#include <array>
#include <limits>
#include <type_traits>

namespace touchstone {

namespace {

using P = PlantParameters;

template <auto Member>
constexpr StructField<P> number(std::string_view name, std::string_view unit, double low, double high,
                                std::string_view meaning) {
    return fieldOf<Member, P>({.name = name,
                               .unit = unit,
                               .words = {},
                               .low = low,
                               .high = high,
                               .whole = std::is_integral_v<std::remove_cvref_t<decltype(P{}.*Member)>>,
                               .meaning = meaning});
}

// A gram and up: a lighter device or a stiffer hand moves faster than any servo can answer.
constexpr std::array kFields{
    number<&P::mass>("mass", "kg", 0.001, 10.0, "effective mass of the device at its tip"),
    number<&P::viscousFriction>("viscousFriction", "N s/m", 0.0, 1000.0, "of the device"),
    number<&P::coulombFriction>("coulombFriction", "N", 0.0, 10.0, "of the device"),
    number<&P::resolution>("resolution", "m", 0.0, 0.01, "of the position sensor on each axis; 0: exact"),
    number<&P::delay>("delay", "ticks", 0.0, 1.0, "between a command and its force: 0 or 1"),
    number<&P::maxForce>("maxForce", "N", 0.0, 1000.0, "where the motors saturate"),
    number<&P::handMass>("handMass", "kg", 0.0, 10.0, "what of the hand moves with the device"),
    number<&P::handDamping>("handDamping", "N s/m", 0.0, 1000.0, "of the hand towards its path"),
    number<&P::handStiffness>("handStiffness", "N/m", 0.0, 1e7, "of the hand towards its path"),
};
static_assert(kFields.size() == memberCount<P>(), "a parameter is missing from the table");

} // namespace

std::span<const StructField<PlantParameters>> plantFields() {
    return kFields;
}

std::string setPlantParameter(PlantParameters& parameters, std::string_view name, std::string_view value) {
    const StructField<P>* field = findField(plantFields(), name);
    if (field == nullptr)
        return "the plant has no '" + std::string(name) + "'; known: " + fieldNames(plantFields());
    double number = 0.0;
    if (!readValue(*field, value, number))
        return refusedValue(*field, value);
    field->set(parameters, number);
    return {};
}

double plantParameter(const PlantParameters& parameters, std::string_view name) {
    const StructField<P>* field = findField(plantFields(), name);
    return field != nullptr ? field->get(parameters) : std::numeric_limits<double>::quiet_NaN();
}

void checkPlant(const PlantParameters& parameters) {
    for (const StructField<P>& field : kFields) {
        const double value = field.get(parameters);
        if (!(value >= field.low && value <= field.high))
            throw Error("simulated device", std::string(field.name), "is outside its range",
                        "give " + allowedValues(field) + " " + std::string(field.unit));
    }
}

} // namespace touchstone
