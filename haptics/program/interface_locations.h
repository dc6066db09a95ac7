#pragma once
// Locations of shaders/material/interface.glsl.

#include <cstddef>

namespace touchstone::program {

enum InputLocation : size_t {
    kPosition,
    kNormal,
    kTangent,
    kBinormal,
    kUv,
    kToolDirection,
    kToolVelocity,
    kToolAcceleration,
    kForce,
    kMaterial,
    kTick,
    kLook,
    kPersistent
};
enum OutputLocation : size_t { kOutPosition, kOutNormal, kOutForce, kOutMaterial, kOutLook, kOutPersistent };

} // namespace touchstone::program
