#pragma once
// Parts of a file that are not yet used: kept for saving and for `inspect`.

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <string>

namespace touchstone {

/// Any JSON, immutable; copies share it. The haptic extensions can make some hundred thousand materials of
/// one, and its JSON may be most of the file. Any thread.
class KeptJson {
  public:
    KeptJson() = default; ///< null
    KeptJson(std::nullptr_t) {}
    explicit KeptJson(nlohmann::json value);

    operator const nlohmann::json&() const; // NOLINT: implicit on purpose
    [[nodiscard]] bool is_null() const { return value_ == nullptr; }
    [[nodiscard]] std::string value(const char* name, const char* otherwise) const;

    friend bool operator==(const KeptJson& a, const KeptJson& b);
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
