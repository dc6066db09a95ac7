#pragma once

#include <string_view>

namespace touchstone::assets {

/// True where ink is, at u, v in 0..1 (origin upper left) of a square that holds `text` in capitals of our
/// own 5 x 7 dots, centred. Knows A..Z; all else is blank.
[[nodiscard]] bool inked(std::string_view text, double u, double v);

} // namespace touchstone::assets
