#pragma once

#include "workbench/model/model.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace touchstone {

/// Which edges of a model people may feel (study/perception), for `inspect`; lengths in the model's metres.
[[nodiscard]] nlohmann::ordered_json perceptionJson(const Model& model);
/// The same as lines of text, from that JSON.
[[nodiscard]] std::string perceptionText(const nlohmann::ordered_json& perception);

} // namespace touchstone
