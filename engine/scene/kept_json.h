#pragma once
// Parts of a file that are not yet used: kept for saving and for `inspect`.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace touchstone {

/// Any JSON, immutable; copies share it. The haptic extensions can make some hundred thousand materials of
/// one, and its JSON may be most of the file. Any thread.
class KeptJson {
  public:
    KeptJson() = default; ///< null
    KeptJson(std::nullptr_t) {}
    explicit KeptJson(nlohmann::json value)
        : value_(value.is_null() ? nullptr : std::make_shared<const nlohmann::json>(std::move(value))) {}

    operator const nlohmann::json&() const { // NOLINT: implicit on purpose
        static const nlohmann::json kNull;
        return value_ != nullptr ? *value_ : kNull;
    }
    [[nodiscard]] bool is_null() const { return value_ == nullptr; }
    [[nodiscard]] std::string value(const char* name, const char* otherwise) const {
        return static_cast<const nlohmann::json&>(*this).value(name, otherwise);
    }

    friend bool operator==(const KeptJson& a, const KeptJson& b) {
        return a.value_ == b.value_ ||
               static_cast<const nlohmann::json&>(a) == static_cast<const nlohmann::json&>(b);
    }
    template <class Json>
    friend void to_json(Json& json, const KeptJson& kept) {
        json = static_cast<const nlohmann::json&>(kept);
    }

  private:
    std::shared_ptr<const nlohmann::json> value_; ///< null represents JSON's null
};

/// KeptJson by name.
struct KeptFields : std::map<std::string, KeptJson> {
    [[nodiscard]] bool is_null() const { return empty(); }
};

} // namespace touchstone
