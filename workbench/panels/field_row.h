#pragma once
// A row of the material editor: the name of a field, its widget, and a button that resets it.

#include "workbench/panels/widgets.h"

#include <string_view>

namespace touchstone {

/// Whose value a field shows.
struct FieldState {
    bool stated = false; ///< the material states it
    bool edited = false; ///< otherwise than the file
};

/// The name in the colour of its state, with a tooltip of `meaning`, shortened to its column. The next item
/// has the width of the widget. Within an ImGui frame, as the next one.
void beginField(const Widgets& widgets, std::string_view name, const FieldState& state,
                std::string_view meaning);
/// After the widget; the button is there where `resettable`. True where it was pressed. Marks "reset.NAME".
[[nodiscard]] bool endField(Widgets& widgets, std::string_view name, bool resettable);

} // namespace touchstone
