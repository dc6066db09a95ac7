#pragma once
// Parameters of a simulated device and of the hand that holds it.

#include "engine/core/field_table.h"

#include <span>
#include <string>
#include <string_view>

namespace touchstone {

/// SI units, at the tip and isotropic. The defaults are a Phantom Premium 1.5 in a light grip.
///
/// Sources of the device: the maker's data sheet (SensAble, Phantom Premium 1.5): apparent mass at the tip
/// below 75 g, back-drive friction 0.04 N, nominal resolution 0.03 mm (860 dpi), 8.5 N at most. It states no
/// viscous friction; a small value is assumed, which is the harder case: such devices dissipate mainly by
/// Coulomb friction (Diolaiti, Niemeyer, Barbagli and Salisbury 2006, IEEE T-RO 22(2)). Not modelled:
/// compliance, a mass that depends on direction (Tahmasebi, Taati, Mobasser and Hashtrudi-Zaad 2005 identify
/// it), and motor dynamics. The hand is of the order found at finger tips (Hajian and Howe 1997) and in
/// stylus grips on this device (Fu and Cavusoglu 2012); hands differ by a factor of ten, so tests sweep the
/// parameters.
struct PlantParameters {
    double mass = 0.075;            ///< kg
    double viscousFriction = 0.005; ///< N·s/m
    double coulombFriction = 0.04;  ///< N
    double resolution = 3e-5;       ///< m of the position sensor on each axis; 0: exact
    int delay = 0;                  ///< ticks between a command and its force: 0 or 1
    double maxForce = 8.5;          ///< N, where the motors saturate
    double handMass = 0.02;         ///< kg that moves with the device
    double handDamping = 3.0;       ///< N·s/m towards the intended point
    double handStiffness = 300.0;   ///< N/m

    bool operator==(const PlantParameters&) const = default;
};

/// Every parameter: for `--plant`, `--help` and figures. Does not compile while a member is missing.
[[nodiscard]] std::span<const StructField<PlantParameters>> plantFields();

/// Sets NAME to VALUE. Returns an empty string, or the problem with the allowed values; then `parameters` is
/// unchanged.
[[nodiscard]] std::string setPlantParameter(PlantParameters& parameters, std::string_view name,
                                            std::string_view value);
/// The value of NAME; NaN if there is no such parameter.
[[nodiscard]] double plantParameter(const PlantParameters& parameters, std::string_view name);

/// Throws Error with the first parameter outside its range.
void checkPlant(const PlantParameters& parameters);

} // namespace touchstone
