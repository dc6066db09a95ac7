#pragma once

#include <nlohmann/json_fwd.hpp>

namespace touchstone {

/// A float as the shortest decimal that parses to the same float: 0.35, not 0.3499999940395355; whole numbers
/// without a point. Any thread.
[[nodiscard]] nlohmann::ordered_json jsonOf(float value);

} // namespace touchstone
