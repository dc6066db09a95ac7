#include "engine/core/output_file.h"
#include "study/report/fields.h"
#include "study/report/report.h"

#include <array>
#include <charconv>
#include <concepts>

namespace touchstone::study {

namespace {

/// A row of column names or of values. A structure becomes several columns: `position_error_p99_m` is the
/// field p99 of position_error in metres.
class Row {
  public:
    explicit Row(bool names) : names_(names) {}

    template <class Value>
    void operator()(std::string_view name, std::string_view unit, Value& value) {
        if constexpr (requires { visitFields(*this, value); }) {
            const std::string outerPrefix = prefix_;
            const std::string outerUnit = unit_;
            // The names of the errors need no prefix.
            prefix_ += name == "errors" ? "" : std::string(name) + "_";
            unit_ += unit;
            visitFields(*this, value);
            prefix_ = outerPrefix;
            unit_ = outerUnit;
        } else if (names_) {
            // The median of an estimate or of a spread has no suffix.
            std::string column = prefix_ + std::string(name);
            if (name == "value")
                column = prefix_.substr(0, prefix_.size() - 1);
            const std::string whole = unit_ + std::string(unit);
            cell(whole.empty() ? column : column + "_" + whole);
        } else {
            cell(text(value));
        }
    }
    [[nodiscard]] std::string line() const { return line_ + "\n"; }

  private:
    static std::string text(const std::string& value) {
        if (value.find_first_of(",\"\r\n") == std::string::npos)
            return value;
        std::string quoted = "\"";
        for (const char c : value)
            quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
        return quoted + "\"";
    }
    static std::string text(bool value) { return value ? "1" : "0"; }
    static std::string text(Truth value) { return std::string(kTruthNames[static_cast<size_t>(value)]); }
    template <class Number>
    requires(std::integral<Number> || std::floating_point<Number>) static std::string text(Number value) {
        std::array<char, 40> digits{};
        return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
    }
    void cell(const std::string& content) {
        if (!line_.empty() || !first_)
            line_ += ",";
        first_ = false;
        line_ += content;
    }

    bool names_, first_ = true;
    std::string prefix_, unit_, line_;
};

} // namespace

void writeStudyCsv(const StudyResult& result, const std::filesystem::path& file) {
    OutputFile out(file);
    ConfigurationResult none;
    Row names(true);
    visitFields(names, none);
    out.write(names.line());
    for (ConfigurationResult configuration : result.configurations) {
        Row values(false);
        visitFields(values, configuration);
        out.write(values.line());
    }
    out.commit();
}

} // namespace touchstone::study
