#pragma once
// Keys by what is written on them. Main thread, within an ImGui frame.

#include <initializer_list>

namespace touchstone {

/// The GLFW key that writes this lower-case letter, digit or sign on the user's keyboard: Ctrl+Z is where Z
/// is. Where the keyboard does not say, or has none, the place on an American one.
[[nodiscard]] int keyOf(char sign);

/// Pressed in this frame, with none of Ctrl, Alt and Super; Shift does not matter. While a text is typed only
/// F1 to F25.
[[nodiscard]] bool keyPressed(int key);
[[nodiscard]] bool keyPressed(std::initializer_list<int> keys);
/// The same with Ctrl, without Alt and Super; `repeat`: again and again while it is held. While a text is
/// typed not with what edits it: A, C, V, X, Y, Z, Enter, arrows and the like.
[[nodiscard]] bool ctrlPressed(int key, bool repeat = false);
/// -1, 0 or 1 of two groups of keys that are held down.
[[nodiscard]] double keyAxis(std::initializer_list<int> less, std::initializer_list<int> more);

} // namespace touchstone
