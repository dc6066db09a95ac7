#pragma once
// The fields of TOUCHSTONE_materials_haptic as data: for panel, command line and documentation.

#include "engine/scene/haptic_numbers.h"
#include "engine/scene/scene.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// A number: one of hapticNumbers(), or `map.part`, a part of a map, which exists only with the map.
struct NumberField : HapticNumberText {
    std::optional<float> HapticStatement::*stated; ///< null: a part of a map
    std::optional<float> (*getPart)(const HapticStatement&);
    bool (*setPart)(HapticStatement&, std::optional<float>);

    [[nodiscard]] std::optional<float> get(const HapticStatement& statement) const;
    /// False: the map that it belongs to is missing. Nullopt resets to the default.
    bool set(HapticStatement& statement, std::optional<float> value) const;
};
[[nodiscard]] std::span<const NumberField> numberFields();

/// One of several words; `unset` is the index of the default.
struct ChoiceField {
    std::string_view name, label;
    std::span<const std::string_view> choices;
    size_t unset;
    std::string_view meaning;
    std::optional<size_t> (*get)(const HapticStatement&);
    void (*set)(HapticStatement&, std::optional<size_t>);
};
[[nodiscard]] std::span<const ChoiceField> choiceFields();

/// A map: one of the file's textures.
struct MapField {
    std::string_view name, label, meaning;
    /// Null: no map.
    const TextureRef* (*get)(const HapticStatement&);
    /// A reference without image removes the map. A new height map spans kNewHeight from black to white.
    void (*set)(HapticStatement&, const TextureRef&);
};
[[nodiscard]] std::span<const MapField> mapFields();
inline constexpr float kNewHeight = 0.001f; ///< model metres

/// Sets a field by name: a number, a choice's word, a texture's index or name for a map, "none" to remove
/// one. Returns the problem with its remedy; empty: none.
[[nodiscard]] std::string setHapticField(HapticStatement& statement, const Scene& scene,
                                         std::string_view name, std::string_view value);
/// Removes a field. False: the statement does not contain it.
bool resetHapticField(HapticStatement& statement, std::string_view name);

/// The problem with a field name; empty: none.
[[nodiscard]] std::string hapticFieldProblem(std::string_view name);
/// The problem with a field's name, or with a value for it that no file could take: not a number, out of
/// range, no such word. Which maps there are depends on the file. Empty: none.
[[nodiscard]] std::string hapticValueProblem(std::string_view name, std::string_view value);
/// Every name accepted by setHapticField.
[[nodiscard]] std::vector<std::string_view> hapticFieldNames();
/// One line per field, for --help.
[[nodiscard]] std::string hapticFieldHelp();

} // namespace touchstone
