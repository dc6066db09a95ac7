#pragma once
// The range of an option that takes a number.

#include <CLI/CLI.hpp>

#include <cmath>

namespace touchstone {

/// A number from `lowest` to `highest`. CLI::Range alone lets NaN pass: it asks whether a value is below or
/// above.
[[nodiscard]] inline CLI::Validator within(double lowest, double highest) {
    CLI::Validator range = CLI::Range(lowest, highest);
    return {[range](std::string& text) {
                double value = 0.0;
                const bool nan = CLI::detail::lexical_cast(text, value) && std::isnan(value);
                return nan ? "Value " + text + " is no number" : range(text);
            },
            range.get_description()};
}

} // namespace touchstone
