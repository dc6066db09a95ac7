#include "engine/program/program_source.h"

#include "engine/core/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace touchstone {

namespace {

constexpr std::string_view kKeyword = "parameter";
constexpr const char* kForm = "write: parameter float name = 1.0; // 0..10 unit: what it does";
constexpr double kLargest = 1e9;

struct ParameterType {
    std::string_view name;
    ProgramParameter::Kind kind;
    size_t components;
};
constexpr std::array<ParameterType, 6> kTypes = {{{"float", ProgramParameter::Kind::Float, 1},
                                                  {"vec2", ProgramParameter::Kind::Float, 2},
                                                  {"vec3", ProgramParameter::Kind::Float, 3},
                                                  {"vec4", ProgramParameter::Kind::Float, 4},
                                                  {"int", ProgramParameter::Kind::Int, 1},
                                                  {"uint", ProgramParameter::Kind::Uint, 1}}};

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

/// Of one line.
class LineReader {
  public:
    LineReader(const std::string& file, unsigned line, std::string_view text)
        : file_(file), line_(line), rest_(text) {}

    [[noreturn]] void fail(const std::string& problem, const std::string& remedy = kForm) const {
        throw Error(file_, "line " + std::to_string(line_), problem, remedy);
    }
    void skipSpace() {
        while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\t' || rest_[0] == '\r'))
            rest_.remove_prefix(1);
    }
    bool take(std::string_view wanted) {
        skipSpace();
        if (!rest_.starts_with(wanted))
            return false;
        rest_.remove_prefix(wanted.size());
        return true;
    }
    void expect(std::string_view wanted) {
        if (!take(wanted))
            fail("the declaration of a parameter lacks '" + std::string(wanted) + "'");
    }
    std::string_view word() {
        skipSpace();
        size_t length = 0;
        while (length < rest_.size() && (isLetter(rest_[length]) || (length > 0 && isDigit(rest_[length]))))
            ++length;
        return takeFirst(length);
    }
    double number() {
        skipSpace();
        if (rest_.starts_with('+'))
            rest_.remove_prefix(1);
        // "0..1" is 0 and 1: the point that begins a range is no decimal point.
        const size_t range = rest_.find("..");
        const std::string_view digits = rest_.substr(0, range);
        double value = 0.0;
        const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (problem != std::errc() || !std::isfinite(value) || std::abs(value) > kLargest)
            fail("the declaration of a parameter lacks a number of at most 1e9");
        rest_.remove_prefix(static_cast<size_t>(end - digits.data()));
        return value;
    }
    std::string_view takeFirst(size_t length) {
        const std::string_view first = rest_.substr(0, length);
        rest_.remove_prefix(length);
        return first;
    }
    [[nodiscard]] std::string_view rest() const { return rest_; }

  private:
    const std::string& file_;
    unsigned line_;
    std::string_view rest_;
};

std::string trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? "" : std::string(text.substr(first, last - first + 1));
}

/// True where the type has the number.
bool isOfKind(ProgramParameter::Kind kind, double value) {
    return kind == ProgramParameter::Kind::Float ||
           (value == std::floor(value) && (kind == ProgramParameter::Kind::Int || value >= 0.0));
}

/// "#line", which would give the messages wrong places.
bool namesLines(std::string_view line) {
    const std::string none;
    LineReader reader(none, 0, line);
    return reader.take("#") && reader.word() == "line";
}

const ParameterType& takeType(LineReader& reader) {
    const std::string_view name = reader.word();
    const auto type = std::ranges::find(kTypes, name, &ParameterType::name);
    if (type == kTypes.end())
        reader.fail("a parameter cannot have the type '" + std::string(name) + "'",
                    "use float, int, uint, vec2, vec3 or vec4");
    return *type;
}

void takeDefault(LineReader& reader, const ParameterType& type, ProgramParameter& parameter) {
    const bool constructed = reader.take(type.name);
    if (constructed)
        reader.expect("(");
    size_t given = 0;
    do
        parameter.value[given++] = reader.number();
    while (constructed && given < type.components && reader.take(","));
    if (constructed)
        reader.expect(")");
    if (given == 1)
        parameter.value.fill(parameter.value[0]);
    else if (given != type.components)
        reader.fail("the default has " + std::to_string(given) + " components instead of " +
                    std::to_string(type.components));
}

/// LEAST..GREATEST UNIT: TEXT
void takeRange(LineReader& reader, ProgramParameter& parameter) {
    reader.expect(";");
    if (!reader.take("//"))
        reader.fail("the parameter '" + parameter.name + "' has no range");
    parameter.least = reader.number();
    reader.expect("..");
    parameter.greatest = reader.number();
    const std::string_view rest = reader.rest();
    const size_t colon = rest.find(':');
    parameter.unit = trimmed(rest.substr(0, colon));
    if (colon != std::string_view::npos)
        parameter.text = trimmed(rest.substr(colon + 1));
}

ProgramParameter readParameter(LineReader& reader, unsigned line) {
    ProgramParameter parameter;
    const ParameterType& type = takeType(reader);
    parameter.kind = type.kind;
    parameter.components = type.components;
    parameter.line = line;
    parameter.name = reader.word();
    if (parameter.name.empty() || parameter.name.size() > 64 || parameter.name.starts_with("gl_") ||
        parameter.name.starts_with("touchstone_") || parameter.name.find("__") != std::string::npos)
        reader.fail("the parameter has no name that it can have",
                    "use up to 64 letters, digits and underscores");
    reader.expect("=");
    takeDefault(reader, type, parameter);
    takeRange(reader, parameter);
    if (!(parameter.least < parameter.greatest))
        reader.fail("the range of '" + parameter.name + "' is empty");
    if (!isOfKind(parameter.kind, parameter.least) || !isOfKind(parameter.kind, parameter.greatest))
        reader.fail("the range of '" + parameter.name + "' ends at no whole number that its type has");
    for (size_t i = 0; i < parameter.components; ++i) {
        const double value = parameter.value[i];
        if (value < parameter.least || value > parameter.greatest)
            reader.fail("the default of '" + parameter.name + "' lies outside of its range");
        if (!isOfKind(parameter.kind, value))
            reader.fail("the default of '" + parameter.name + "' is no whole number that its type has");
    }
    return parameter;
}

/// Length of the UTF-8 sequence at the beginning; 0 where it is none.
size_t sequenceLength(std::string_view text) {
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
    if (byte(0) < 0x80)
        return byte(0) == 0 ? 0 : 1;
    const size_t length = byte(0) < 0xc2   ? 0
                          : byte(0) < 0xe0 ? 2
                          : byte(0) < 0xf0 ? 3
                          : byte(0) < 0xf5 ? 4
                                           : 0;
    if (length == 0 || length > text.size())
        return 0;
    for (size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0u) != 0x80u)
            return 0;
    const bool overlong = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xf0 && byte(1) < 0x90);
    const bool beyond = (byte(0) == 0xed && byte(1) >= 0xa0) || (byte(0) == 0xf4 && byte(1) >= 0x90);
    return overlong || beyond ? 0 : length;
}

void checkText(const std::string& name, std::string_view text) {
    if (text.size() > kMaxProgramBytes)
        throw Error(name, "",
                    "the program has " + std::to_string(text.size()) + " bytes, more than " +
                        std::to_string(kMaxProgramBytes),
                    "shorten it");
    size_t line = 1;
    for (size_t i = 0; i < text.size();) {
        const size_t length = sequenceLength(text.substr(i));
        if (length == 0)
            throw Error(name, "line " + std::to_string(line), "the program is no text in UTF-8",
                        "save it as UTF-8");
        line += text[i] == '\n' ? 1 : 0;
        i += length;
    }
}

} // namespace

ProgramSource readProgramSource(const std::string& name, std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf"))
        text.remove_prefix(3); // the mark that some editors put before UTF-8
    checkText(name, text);
    ProgramSource source{name, "", {}};
    source.text.reserve(text.size());
    for (unsigned line = 1; !text.empty(); ++line) {
        const size_t end = std::min(text.find('\n'), text.size());
        LineReader reader(name, line, text.substr(0, end));
        if (namesLines(text.substr(0, end)))
            reader.fail("the program numbers its lines itself (#line)", "take the line out");
        if (reader.word() == kKeyword) {
            if (source.parameters.size() == kMaxProgramParameters)
                reader.fail("the program has more than " + std::to_string(kMaxProgramParameters) +
                                " parameters",
                            "use constants for some of them");
            ProgramParameter parameter = readParameter(reader, line);
            if (std::ranges::find(source.parameters, parameter.name, &ProgramParameter::name) !=
                source.parameters.end())
                reader.fail("the parameter '" + parameter.name + "' is declared twice",
                            "take one of them out");
            source.parameters.push_back(std::move(parameter));
        } else {
            source.text += text.substr(0, end);
        }
        source.text += '\n';
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return source;
}

std::string withoutComments(std::string_view text) {
    std::string code(text);
    for (size_t at = code.find('/'); at != std::string::npos && at + 1 < code.size();
         at = code.find('/', at + 1)) {
        const bool block = code[at + 1] == '*';
        if (!block && code[at + 1] != '/')
            continue;
        const size_t end = block ? code.find("*/", at + 2) : code.find('\n', at);
        const size_t past = std::min(end, code.size() - (block ? 2 : 0)) + (block ? 2 : 0);
        std::replace_if(
            code.begin() + static_cast<std::ptrdiff_t>(at), code.begin() + static_cast<std::ptrdiff_t>(past),
            [](char c) { return c != '\n'; }, ' ');
        at = past - 1;
    }
    return code;
}

uint32_t lineAt(std::string_view text, size_t place) {
    return 1 + static_cast<uint32_t>(std::ranges::count(text.substr(0, place), '\n'));
}

std::string declarationOf(const std::vector<ProgramParameter>& parameters) {
    if (parameters.empty())
        return "";
    std::string text = "layout(std140, set = 0, binding = 0) uniform touchstone_Parameters {\n";
    for (const ProgramParameter& parameter : parameters) {
        const auto type = std::ranges::find_if(kTypes, [&](const ParameterType& candidate) {
            return candidate.kind == parameter.kind && candidate.components == parameter.components;
        });
        text += std::string(type->name) + " " + parameter.name + ";\n";
    }
    return text + "};\n";
}

} // namespace touchstone
