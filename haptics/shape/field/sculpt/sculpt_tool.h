#pragma once
// What sculpts a field: a tool, and one application of it.

#include "haptics/shape/field/field_grid.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

namespace touchstone {

enum class SculptTool : uint8_t { Carve, Add, Smooth, Stamp, Imprint, Drag, Paint };
inline constexpr SculptTool kLastSculptTool = SculptTool::Paint;

struct SculptToolInfo {
    SculptTool tool;
    const char* name;    ///< in journals and on the command line
    const char* meaning; ///< one line, for help and tooltips
    SculptTool inverse;  ///< itself where there is none
};
/// One row for each tool, in the order of the enumeration.
[[nodiscard]] std::span<const SculptToolInfo> sculptTools();
[[nodiscard]] const SculptToolInfo& infoOf(SculptTool tool);
[[nodiscard]] std::optional<SculptTool> sculptToolNamed(std::string_view name);

/// One application of a tool to a field. Object frame, object units.
struct Dab {
    SculptTool tool = SculptTool::Carve;
    glm::dvec3 centre{0.0};
    /// Of the tool since the dab before: what Drag moves the field by.
    glm::dvec3 motion{0.0};
    double radius = 0.0;   ///< of the ball; of Stamp and Imprint half the longest side of the stamp's box
    double strength = 1.0; ///< in (0, 1]: the fraction of the whole change that one dab makes
    /// In 0..1: the outer part of the radius in which the strength falls to zero. 0: none; Drag and Smooth
    /// always fall to zero at the radius.
    double falloff = 0.0;
    std::shared_ptr<const FieldGrid> stamp{}; ///< of Stamp and Imprint: centred on `centre`, not turned
    glm::vec3 color{1.0f};                    ///< of Paint: FieldColors; white takes colour off
};

/// Throws Error: numbers that are not finite or out of range, a ball larger than the grid, no stamp.
void checkDab(const FieldGrid& grid, const Dab& dab);

/// 1 at the middle of a dab to 0 at its radius: rho = distance / radius.
[[nodiscard]] double dabWeight(const Dab& dab, double rho) noexcept;

} // namespace touchstone
