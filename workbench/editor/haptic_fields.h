#pragma once
// The fields of TOUCHSTONE_materials_haptic as data: for the panel, the command line and the documentation.

#include "engine/scene/scene.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// A number. `map.part` names a part of a map, which is there only where the map is.
struct NumberField {
    std::string_view name, label, unit;
    float least, most;      ///< that the extension allows
    float low, high;        ///< ends of a slider; a value beyond them may be typed
    bool logarithmic;       ///< slider
    std::string_view unset; ///< what holds when nobody says it
    std::string_view meaning;
    std::optional<float> (*get)(const HapticStatement&);
    /// False: there is no map that it could be a part of. Nothing: back to what holds when left out.
    bool (*set)(HapticStatement&, std::optional<float>);
};
[[nodiscard]] std::span<const NumberField> numberFields();

/// One of several words; `unset` is the index of the one that holds when left out.
struct ChoiceField {
    std::string_view name, label;
    std::span<const std::string_view> choices;
    size_t unset;
    std::string_view meaning;
    std::optional<size_t> (*get)(const HapticStatement&);
    void (*set)(HapticStatement&, std::optional<size_t>);
};
[[nodiscard]] std::span<const ChoiceField> choiceFields();

/// A map out of one of the file's textures.
struct MapField {
    std::string_view name, label, meaning;
    /// Null: there is none.
    const TextureRef* (*get)(const HapticStatement&);
    /// A reference without image removes the map. A new height map is kNewHeight from black to white.
    void (*set)(HapticStatement&, const TextureRef&);
};
[[nodiscard]] std::span<const MapField> mapFields();
inline constexpr float kNewHeight = 0.001f; ///< model metres

/// Sets a field by name: a number, a choice's word, a texture's index or name for a map, "none" to remove
/// one. Returns what is wrong and what to do about it; empty: nothing.
[[nodiscard]] std::string setHapticField(HapticStatement& statement, const Scene& scene,
                                         std::string_view name, std::string_view value);
/// Takes a field out. False: there is none of that name.
bool resetHapticField(HapticStatement& statement, std::string_view name);

/// What is wrong with the name of a field; empty: nothing.
[[nodiscard]] std::string hapticFieldProblem(std::string_view name);
/// Every name that setHapticField takes.
[[nodiscard]] std::vector<std::string_view> hapticFieldNames();
/// One line a field, for --help.
[[nodiscard]] std::string hapticFieldHelp();

} // namespace touchstone
