#pragma once

#include "engine/import/file/json_fields.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace touchstone {

/// One of the spellings in `choices`; empty if absent. Fails for any other text.
template <class Choice, size_t N>
std::optional<Choice> choiceField(const ImportContext& context, const nlohmann::json& object,
                                  const char* name, const std::string& place,
                                  const std::array<std::pair<const char*, Choice>, N>& choices) {
    const auto text = textField(context, object, name, place);
    if (!text)
        return std::nullopt;
    std::string known;
    for (const auto& [spelling, choice] : choices) {
        if (*text == spelling)
            return choice;
        known += (known.empty() ? "" : ", ") + std::string(spelling);
    }
    context.fail(place + "." + name, "\"" + text->substr(0, 40) + "\" is not a choice",
                 "use one of: " + known);
}

} // namespace touchstone
