#pragma once

#include <string_view>

namespace touchstone::assets {

/// True for ink at u, v in 0..1 (origin upper left) of a square with `text` in capitals of a 5 x 7 dot font,
/// centred. Supports A..Z; other characters are blank.
[[nodiscard]] bool inked(std::string_view text, double u, double v);

} // namespace touchstone::assets
