#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "study/report/fields.h"
#include "study/report/report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <fstream>
#include <limits>

namespace touchstone::study {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "touchstone study";
constexpr int kVersion = 2;

std::string keyOf(std::string_view name, std::string_view unit) {
    return std::string(name) + (unit.empty() ? "" : "_" + std::string(unit));
}

/// Fills a JSON object with the fields of a value.
class Writer {
  public:
    template <class Value>
    void operator()(std::string_view name, std::string_view unit, Value& value) {
        object_[keyOf(name, unit)] = jsonOf(value);
    }
    template <class Value>
    static Json jsonOf(Value& value) {
        if constexpr (requires(Writer w) { visitFields(w, value); }) {
            Writer inner;
            visitFields(inner, value);
            return inner.object_;
        } else {
            return leaf(value);
        }
    }

  private:
    template <class Element>
    static Json leaf(std::vector<Element>& values) {
        Json array = Json::array();
        for (Element& value : values)
            array.push_back(jsonOf(value));
        return array;
    }
    /// JSON has no infinity: a figure without a measurement is a string.
    static Json leaf(double value) {
        if (std::isfinite(value))
            return value;
        return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
    }
    static Json leaf(Truth value) { return kTruthNames[static_cast<size_t>(value)]; }
    static Json leaf(const std::string& value) { return value; }
    template <std::integral Integer>
    static Json leaf(Integer value) {
        return value;
    }

    Json object_ = Json::object();
};

/// Fills a value from a JSON object, with the path in the file for errors. `file` outlives it.
class Reader {
  public:
    Reader(const std::string& file, std::string place, const Json& object)
        : file_(file), place_(std::move(place)), object_(object) {
        if (!object_.is_object())
            fail(place_, "is not an object");
    }
    template <class Value>
    void operator()(std::string_view name, std::string_view unit, Value& value) {
        const std::string key = keyOf(name, unit);
        const std::string place = place_.empty() ? key : place_ + "." + key;
        const auto found = object_.find(key);
        if (found == object_.end())
            fail(place, "is missing");
        read(place, *found, value);
    }

  private:
    [[noreturn]] void fail(const std::string& place, const std::string& problem) const {
        throw Error(file_, place, problem, "give a study.json that this version of touchstone study wrote");
    }
    template <class Value>
    void read(const std::string& place, const Json& json, Value& value) {
        if constexpr (requires(Reader r) { visitFields(r, value); }) {
            Reader inner(file_, place, json);
            visitFields(inner, value);
        } else {
            leaf(place, json, value);
        }
    }
    template <class Element>
    void leaf(const std::string& place, const Json& json, std::vector<Element>& values) {
        if (!json.is_array())
            fail(place, "is not a list");
        values.clear();
        for (size_t i = 0; i < json.size(); ++i)
            read(place + "[" + std::to_string(i) + "]", json[i], values.emplace_back());
    }
    void leaf(const std::string& place, const Json& json, double& value) {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        if (json.is_number())
            value = json.get<double>();
        else if (json == "inf" || json == "-inf")
            value = json == "inf" ? kInfinity : -kInfinity;
        else if (json == "nan")
            value = std::numeric_limits<double>::quiet_NaN();
        else
            fail(place, "is not a number");
    }
    void leaf(const std::string& place, const Json& json, bool& value) {
        if (!json.is_boolean())
            fail(place, "is neither true nor false");
        value = json.get<bool>();
    }
    void leaf(const std::string& place, const Json& json, Truth& value) {
        const std::string name = json.is_string() ? json.get<std::string>() : "";
        const auto known = std::find(kTruthNames.begin(), kTruthNames.end(), name);
        if (known == kTruthNames.end())
            fail(place, "is no truth that is known here");
        value = static_cast<Truth>(known - kTruthNames.begin());
    }
    void leaf(const std::string& place, const Json& json, std::string& value) {
        if (!json.is_string())
            fail(place, "is not a text");
        value = json.get<std::string>();
    }
    template <std::unsigned_integral Integer>
    void leaf(const std::string& place, const Json& json, Integer& value) {
        if (!json.is_number_unsigned() || json.get<uint64_t>() > std::numeric_limits<Integer>::max())
            fail(place, "is not a whole number in the range of one");
        value = json.get<Integer>();
    }

    const std::string& file_;
    std::string place_;
    const Json& object_;
};

} // namespace

void writeStudyJson(const StudyResult& result, const std::filesystem::path& file) {
    StudyResult copy = result;
    Json json{{"format", kFormat}, {"version", kVersion}};
    json.update(Writer::jsonOf(copy));
    writeFile(file, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

StudyResult readStudyJson(const std::filesystem::path& file) {
    const char* remedy = "give a study.json that touchstone study wrote";
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file))
        throw Error(file.string(), "", "cannot be read", remedy);
    Json json;
    try {
        json = Json::parse(in);
    } catch (const Json::exception& e) {
        throw Error(file.string(), "", std::string("is not JSON: ") + e.what(), remedy);
    }
    if (!json.is_object() || json.value("format", Json()) != kFormat)
        throw Error(file.string(), "format", "is not that of a study", remedy);
    if (json.value("version", Json()) != kVersion)
        throw Error(file.string(), "version", "is not " + std::to_string(kVersion),
                    "make the study again with this version of the program");
    StudyResult result;
    const std::string name = file.string();
    Reader reader(name, "", json);
    visitFields(reader, result);
    return result;
}

} // namespace touchstone::study
