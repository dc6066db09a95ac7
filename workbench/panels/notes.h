#pragma once
// The tooltips of the window: one table by widget name. What a setting does is told once, in settingFields()
// (also --help), what a field of a material does in numberFields() and its like (also `edit --help`).

#include <string>
#include <string_view>

namespace touchstone {

/// Text of the tooltip of the widget `name` of Widgets::mark, in lines; empty: unknown. Any thread.
[[nodiscard]] std::string noteOf(std::string_view name);

/// Drawing areas: no tooltip lies over what the pointer reads there.
[[nodiscard]] bool isArea(std::string_view name);

} // namespace touchstone
