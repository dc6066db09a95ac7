#pragma once
// A material's program, ready for the servo.

#include "engine/program/surface_program.h"
#include "engine/scene/kept_json.h"
#include "haptics/program/register_program.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace touchstone::program {

/// Persistent textures that the model's file has values of.
struct StartTextures {
    KeptJson stated; ///< as in the file
    PersistentTextureSize size;
    /// By instance of the scene (Scene::instances).
    std::map<int, std::shared_ptr<const std::vector<float>>> values;
    /// Null: none.
    [[nodiscard]] std::shared_ptr<const std::vector<float>> of(int instance) const {
        const auto found = values.find(instance);
        return found != values.end() ? found->second : nullptr;
    }
};

/// Immutable.
struct FeltProgram {
    RegisterProgram code; ///< with the material's values
    std::string name;     ///< of its source
    /// It may write another position than that which it gets: a displacement has a gradient.
    bool displaces = true;
    bool usesCoordinates = false;  ///< it reads uv, tangent or binormal, or has a persistent texture
    PersistentTextureSize texture; ///< of the material; 0 texels where the program does not name it
    std::shared_ptr<const StartTextures> start; ///< null: every texture begins even
    uint64_t identity = 0;                      ///< hash of its SPIR-V and its values
    /// Translated from it; null in programs that no material brought.
    std::shared_ptr<const SurfaceProgram> compiled;

    [[nodiscard]] uint64_t memoryBytes() const {
        return code.instructions.size() * sizeof(Instruction) +
               (code.cost.size() + code.constants.size()) * sizeof(uint32_t);
    }
};

/// Translates it, with its values. Throws Error where the executor does not accept it: the program's name,
/// the line, a remedy. Any thread but the servo.
/// `before`: of the same material before an edit; where only values differ its translation is copied.
[[nodiscard]] FeltProgram feltProgram(const MaterialProgram& material, const FeltProgram* before = nullptr);

} // namespace touchstone::program
