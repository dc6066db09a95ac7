#pragma once
// Opens, inspects and touches a valid file as the program does, and compares what happens with what is
// promised.

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone::test {

struct TouchReport {
    std::vector<std::string> findings; ///< broken promises; empty: none
    std::vector<std::string> warnings; ///< "place: message" of the loader and of the compiler
    uint64_t triangles = 0;
    int contactTicks = 0; ///< of the strokes that touch
    bool touchable = false;
};

/// Loads the file from memory, checks scene.h's promises, makes the inspection, then strokes and pokes the
/// model with several settings drawn from `seed`, a few hundred ticks each: the defaults first. A valid file
/// is never refused; every output is finite, every command within the limits of force and slew, and no tick
/// faults. Calling thread, whose float mode it keeps.
[[nodiscard]] TouchReport openAndTouch(const std::vector<uint8_t>& file, uint64_t seed);

} // namespace touchstone::test
