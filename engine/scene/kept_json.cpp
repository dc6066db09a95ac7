#include "engine/scene/kept_json.h"

#include <nlohmann/json.hpp>

#include <utility>

namespace touchstone {

KeptJson::KeptJson(nlohmann::json value)
    : value_(value.is_null() ? nullptr : std::make_shared<const nlohmann::json>(std::move(value))) {}

KeptJson::operator const nlohmann::json&() const {
    static const nlohmann::json kNull;
    return value_ != nullptr ? *value_ : kNull;
}

std::string KeptJson::value(const char* name, const char* otherwise) const {
    return static_cast<const nlohmann::json&>(*this).value(name, otherwise);
}

bool operator==(const KeptJson& a, const KeptJson& b) {
    return a.value_ == b.value_ ||
           static_cast<const nlohmann::json&>(a) == static_cast<const nlohmann::json&>(b);
}

} // namespace touchstone
