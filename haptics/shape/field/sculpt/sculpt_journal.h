#pragma once
// A journal of sculpting: strokes in the order in which they are made (docs/sculpting.md).

#include "haptics/shape/field/sculpt/sculpt_tool.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

enum class SculptAction : uint8_t { Stroke, Undo, Redo };

/// Lengths in metres, scene frame.
struct SculptStep {
    SculptAction action = SculptAction::Stroke;
    SculptTool tool = SculptTool::Carve;
    double radius = 0.0;
    double strength = 1.0, falloff = 0.0;
    std::vector<glm::dvec3> points; ///< the tool's way: at least one
    std::string object;             ///< that is sculpted; empty: the first that is felt as a field
    std::string stamp;              ///< object of Stamp and Imprint
    glm::vec3 color{1.0f};          ///< of Paint: linear RGB, 0..1
    std::optional<double> time;     ///< s: before the first tick at or after it; none: before touch begins
    bool operator==(const SculptStep&) const = default;
};

/// Reads a journal. Throws Error, naming `shownAs` and the step: not JSON, unknown members and tools, numbers
/// that are missing, not finite or out of range, times that decrease.
[[nodiscard]] std::vector<SculptStep> sculptJournalOf(std::string_view json, const std::string& shownAs);
[[nodiscard]] std::vector<SculptStep> readSculptJournal(const std::filesystem::path& file);
/// The text that sculptJournalOf reads back as the same steps.
[[nodiscard]] std::string sculptJournalText(const std::vector<SculptStep>& steps);

inline constexpr uint64_t kMostJournalBytes = uint64_t{64} << 20;

} // namespace touchstone
