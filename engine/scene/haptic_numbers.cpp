#include "engine/scene/haptic_numbers.h"

#include <algorithm>
#include <array>

namespace touchstone {

namespace {

constexpr float kLargest = kLargestHapticNumber;
/// A power of two: no text of a file falls below it by its conversion to float.
constexpr float kSmallest = 0x1p-100f;

constexpr std::string_view kDerived = "derived from the roughness where the file states one, else none";

constexpr std::array kNumbers{
    HapticNumber{{"stiffness", "stiffness", "N/m", kSmallest, kLargest, 20.0f, 3000.0f, true,
                  "the device's recommendation",
                  "force per depth; above the device's limit it is cut to that"},
                 &HapticStatement::stiffness,
                 &HapticMaterial::stiffness},
    HapticNumber{{"damping", "damping", "N·s/m", 0.0f, kLargest, 0.0f, 10.0f, false, "0",
                  "force per velocity along the normal while pressed in"},
                 &HapticStatement::damping,
                 &HapticMaterial::damping},
    HapticNumber{{"retardationTime", "retardation time", "s", 0.0f, kLargest, 0.0f, 0.01f, false, "0",
                  "stated damping is used before it; else damping is the stated stiffness times this time"},
                 &HapticStatement::retardationTime,
                 &HapticMaterial::retardationTime},
    HapticNumber{{"staticFriction", "static friction", "", 0.0f, kLargest, 0.0f, 1.5f, false, kDerived,
                  "coefficient that holds a resting contact"},
                 &HapticStatement::staticFriction,
                 &HapticMaterial::staticFriction},
    HapticNumber{{"dynamicFriction", "dynamic friction", "", 0.0f, kLargest, 0.0f, 1.5f, false, kDerived,
                  "coefficient while sliding; above the static one it is cut to it"},
                 &HapticStatement::dynamicFriction,
                 &HapticMaterial::dynamicFriction},
    HapticNumber{{"viscousFriction", "viscous friction", "N·s/m", 0.0f, kLargest, 0.0f, 10.0f, false, "0",
                  "force per velocity along the surface"},
                 &HapticStatement::viscousFriction,
                 &HapticMaterial::viscousFriction},
    HapticNumber{{"normalTextureInfluence", "felt normal map", "", 0.0f, 1.0f, 0.0f, 1.0f, false, "1",
                  "share of the normal map that is felt; 0 leaves it to the eye"},
                 &HapticStatement::normalTextureInfluence,
                 &HapticMaterial::normalTextureInfluence},
    HapticNumber{{"deformationRadius", "dent radius", "m", 0.0f, kLargest, 0.0f, 0.05f, false, "0",
                  "reach of the dent that a contact makes, model metres; 0: the surface does not give way"},
                 &HapticStatement::deformationRadius,
                 &HapticMaterial::deformationRadius},
    HapticNumber{{"deformationStiffness", "dent stiffness", "N/m", kSmallest, kLargest, 20.0f, 3000.0f, true,
                  "the contact's", "of the ground under the surface: force per depth of the dent"},
                 &HapticStatement::deformationStiffness,
                 &HapticMaterial::deformationStiffness},
    HapticNumber{{"deformationLinear", "dent, linear", "", -16.0f, 16.0f, -3.0f, 0.0f, false, "0",
                  "a in the dent's shape 1 + a s + b s^2 - (1 + a + b) s^3, s = distance / radius"},
                 &HapticStatement::deformationLinear,
                 &HapticMaterial::deformationLinear},
    HapticNumber{{"deformationQuadratic", "dent, quadratic", "", -16.0f, 16.0f, -3.0f, 3.0f, false, "-3",
                  "b in the dent's shape"},
                 &HapticStatement::deformationQuadratic,
                 &HapticMaterial::deformationQuadratic},
    HapticNumber{{"relaxationTime", "relaxation time", "s", 0.0f, kLargest, 0.0f, 1.0f, false, "0",
                  "in which a dent that nothing presses falls to 1/e"},
                 &HapticStatement::relaxationTime,
                 &HapticMaterial::relaxationTime},
    HapticNumber{
        {"voxelSize", "voxel size", "m", kSmallest, kLargest, 0.0001f, 0.1f, true, "none",
         "of the distance field, model metres; none: as the field error asks, or a 128th of the object's "
         "longest side"},
        &HapticStatement::voxelSize,
        nullptr},
    HapticNumber{
        {"fieldError", "field error", "m", kSmallest, kLargest, 0.00001f, 0.01f, true, "none",
         "how far the distance field's surface may be from the triangles, model metres: the voxel is chosen "
         "for it"},
        &HapticStatement::fieldError,
        nullptr},
    HapticNumber{{"noiseAmplitude", "noise", "m", 0.0f, kLargest, 0.0f, 0.002f, false, "0",
                  "standard deviation of the Gaussian noise on the distance field, model metres"},
                 &HapticStatement::noiseAmplitude,
                 nullptr},
    HapticNumber{{"noiseWavelength", "noise wavelength", "m", 0.0f, kLargest, 0.0f, 0.02f, false, "0",
                  "distance between the values of the noise, model metres; 0: each node of the grid has its "
                  "own"},
                 &HapticStatement::noiseWavelength,
                 nullptr},
    HapticNumber{{"noiseSeed", "noise seed", "", 0.0f, 16777216.0f, 0.0f, 100.0f, false, "0",
                  "chooses one of the noises of this amplitude and wavelength"},
                 &HapticStatement::noiseSeed,
                 nullptr},
    HapticNumber{{"latticeAmplitude", "lattice", "m", 0.0f, kLargest, 0.0f, 0.002f, false, "0",
                  "height of the lattice on the distance field, model metres"},
                 &HapticStatement::latticeAmplitude,
                 nullptr},
    HapticNumber{{"latticeWavelength", "lattice wavelength", "m", kSmallest, kLargest, 0.0005f, 0.05f, true,
                  "none", "period of the lattice along each axis of the mesh, model metres"},
                 &HapticStatement::latticeWavelength,
                 nullptr}};

} // namespace

std::span<const HapticNumber> hapticNumbers() {
    return kNumbers;
}

const HapticNumber* findHapticNumber(std::string_view name) {
    const auto found = std::ranges::find(kNumbers, name, &HapticNumber::name);
    return found == kNumbers.end() ? nullptr : &*found;
}

} // namespace touchstone
