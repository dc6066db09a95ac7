#pragma once
// Programs out of GLSL, compiled by the process that the product uses.

#include "engine/core/error.h"
#include "engine/program/program_compiler.h"
#include "haptics/program/executor.h"
#include "haptics/program/load_program.h"
#include "haptics/program/translator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace touchstone::program {

inline std::vector<uint32_t> spirvOf(const std::string& text) {
    return compileProgram(readProgramSource("test.glsl", text), installedProgramCompiler(),
                          [] { return false; });
}

inline RegisterProgram programOf(const std::string& text) {
    Translation translation = translateSpirv(spirvOf(text));
    if (translation.problem)
        throw std::runtime_error(translation.problem->place.file + ":" +
                                 std::to_string(translation.problem->place.line) + ": " +
                                 translation.problem->what);
    return std::move(translation.program);
}

/// A module with another instruction in place of one.
inline std::vector<uint32_t> replaced(std::vector<uint32_t> words, uint32_t from, uint32_t to) {
    for (size_t i = 5; i < words.size(); i += std::max(words[i] >> 16, 1u))
        if ((words[i] & 0xffffu) == from)
            words[i] = (words[i] & 0xffff0000u) | to;
    return words;
}

/// The body of touch.
inline std::string touchBody(const std::string& body) {
    return "void touch(const in Touch before, inout Surface after) {\n" + body + "\n}\n";
}

using Inputs = std::array<PortValue, kMaxLocations>;
using DualInputs = std::array<DualPortValue, kMaxLocations>;

/// Locations of shaders/material/interface.glsl.
enum Location : size_t {
    kPosition = 0,
    kNormal = 1,
    kUv = 4,
    kToolDirection = 5,
    kToolVelocity = 6,
    kForce = 8,
    kMaterial = 9,
    kTick = 10
};
enum OutLocation : size_t { kOutPosition = 0, kOutNormal = 1, kOutForce = 2, kOutMaterial = 3 };

inline Inputs inputsAt(float x, float y, float z) {
    Inputs inputs{};
    inputs[kPosition] = {x, y, z, 0.0f};
    inputs[kNormal] = {0.0f, 0.0f, 1.0f, 0.0f};
    inputs[kForce] = {0.0f, 0.0f, 2.0f, 0.0f};
    inputs[kMaterial] = {0.4f, 0.3f, 600.0f, 1.0f};
    return inputs;
}

/// The position, with its derivatives by itself; everything else is constant.
inline DualInputs dualInputs(const Inputs& inputs) {
    DualInputs dual{};
    for (size_t i = 0; i < inputs.size(); ++i)
        dual[i].v = inputs[i];
    for (size_t k = 0; k < 3; ++k)
        dual[kPosition].d[k][k] = 1.0f;
    return dual;
}

inline void setParameter(RegisterProgram& program, const std::string& name, float value) {
    for (const ParameterSlot& slot : program.parameters)
        if (slot.name == name)
            program.constants[slot.first] = std::bit_cast<uint32_t>(value);
}

/// With the defaults of its parameters.
inline RegisterProgram paperProgram(const std::string& name) {
    std::ifstream file(std::string(TOUCHSTONE_ASSETS) + "/../programs/" + name);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    return loadProgram(readProgramSource(name, text), installedProgramCompiler(), [] { return false; });
}

inline void setInteger(RegisterProgram& program, const std::string& name, uint32_t value) {
    setParameter(program, name, std::bit_cast<float>(value));
}

/// Places that a stroke meets, float exactly.
inline std::array<float, 3> placeOf(int i) {
    return {static_cast<float>(i % 37) * 0.00131f - 0.02f, static_cast<float>(i % 53) * 0.00093f - 0.025f,
            static_cast<float>(i % 11) * 0.0021f - 0.01f};
}

inline PortValue outputAt(const RegisterProgram& program, const Inputs& in, size_t port) {
    Inputs out{};
    EXPECT_EQ(run(program, in, out).ending, Ending::Finished);
    return out[port];
}

inline long double exact(float x) {
    return static_cast<long double>(x);
}

} // namespace touchstone::program
