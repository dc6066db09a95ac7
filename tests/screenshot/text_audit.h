#pragma once
// Reads the text of a frame out of ImGui's draw lists: what is cut, covered or too small to read.

#include <string>
#include <vector>

namespace touchstone::test {

/// Complaints about the last rendered frame; empty: all text can be read. `smallest`: least height of type,
/// window coordinates. Cut is a character that a window's edge or its widget's edge cuts, but for the upper
/// and lower edge of a window that scrolls; content that is wider than its window, or higher where that does
/// not scroll; covered are two texts of one window that overlap. The text of a haptic program is left out.
[[nodiscard]] std::vector<std::string> auditText(float smallest);

} // namespace touchstone::test
