#include "devices/plant/plant_parameters.h"

#include "engine/core/error.h"
#include "engine/core/field_rows.h"
#include "engine/core/member_count.h"

#include <array>
#include <limits>

namespace touchstone {

namespace {

using P = PlantParameters;

// A gram and up: a lighter device or a stiffer hand moves faster than any servo can answer.
constexpr std::array kFields{
    numberField<&P::mass>("mass", "kg", 0.001, 10.0, "effective mass of the device at its tip"),
    numberField<&P::viscousFriction>("viscousFriction", "N s/m", 0.0, 1000.0, "of the device"),
    numberField<&P::coulombFriction>("coulombFriction", "N", 0.0, 10.0, "of the device"),
    numberField<&P::resolution>("resolution", "m", 0.0, 0.01,
                                "of the position sensor on each axis; 0: exact"),
    numberField<&P::delay>("delay", "ticks", 0.0, 1.0, "between a command and its force: 0 or 1"),
    numberField<&P::maxForce>("maxForce", "N", 0.0, 1000.0, "where the motors saturate"),
    numberField<&P::handMass>("handMass", "kg", 0.0, 10.0, "what of the hand moves with the device"),
    numberField<&P::handDamping>("handDamping", "N s/m", 0.0, 1000.0, "of the hand towards its path"),
    numberField<&P::handStiffness>("handStiffness", "N/m", 0.0, 1e7, "of the hand towards its path"),
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
