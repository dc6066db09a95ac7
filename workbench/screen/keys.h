#pragma once
// Keys by the character on the user's keyboard layout. Main thread, within an ImGui frame.

#include <initializer_list>

namespace touchstone {

/// The GLFW key that types this lower-case letter, digit or sign on the user's keyboard: Ctrl+Z is where Z
/// is. Where the layout is unknown or lacks it, its position on the US layout.
[[nodiscard]] int keyOf(char sign);

/// Pressed in this frame, without Ctrl, Alt and Super; Shift is ignored. While a text field has the focus, F1
/// to F25 only.
[[nodiscard]] bool keyPressed(int key);
[[nodiscard]] bool keyPressed(std::initializer_list<int> keys);
/// The same with Ctrl, without Alt and Super; `repeat`: also key repeats. While a text field has the focus,
/// not its editing keys: A, C, V, X, Y, Z, Enter, arrows and the like.
[[nodiscard]] bool ctrlPressed(int key, bool repeat = false);
/// The same with Alt, without Ctrl and Super.
[[nodiscard]] bool altPressed(int key);
/// -1, 0 or 1 from two groups of held keys.
[[nodiscard]] double keyAxis(std::initializer_list<int> less, std::initializer_list<int> more);

} // namespace touchstone
