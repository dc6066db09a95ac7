#include "workbench/editor/haptic_fields.h"

#include "engine/core/error.h"
#include "workbench/editor/texture_fields.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace touchstone {

namespace {

constexpr float kLargest = kLargestHapticNumber;

template <auto Map, auto Part>
std::optional<float> getPart(const HapticStatement& statement) {
    return statement.*Map ? std::optional((*(statement.*Map)).*Part) : std::nullopt;
}
template <auto Map, auto Part>
bool setPart(HapticStatement& statement, std::optional<float> value) {
    auto& map = statement.*Map;
    if (!map)
        return false;
    std::remove_cvref_t<decltype(*map)> unset;
    if constexpr (requires { unset.scale; })
        unset.scale = kNewHeight;
    (*map).*Part = value.value_or(unset.*Part);
    return true;
}

template <auto Map>
std::optional<float> getSet(const HapticStatement& statement) {
    return statement.*Map ? std::optional(static_cast<float>((statement.*Map)->texture.texCoord))
                          : std::nullopt;
}
template <auto Map>
bool setSet(HapticStatement& statement, std::optional<float> value) {
    auto& map = statement.*Map;
    if (map)
        map->texture.texCoord = value.value_or(0.0f) >= 0.5f ? 1 : 0;
    return map.has_value();
}

template <auto Map>
const TextureRef* getMap(const HapticStatement& statement) {
    return statement.*Map ? &(*(statement.*Map)).texture : nullptr;
}
/// Another texture keeps the texture coordinates and transform of the previous one.
template <auto Map>
void setMap(HapticStatement& statement, const TextureRef& texture) {
    auto& map = statement.*Map;
    if (!texture) {
        map.reset();
        return;
    }
    if (!map) {
        map.emplace();
        if constexpr (requires { map->scale; })
            map->scale = kNewHeight;
        map->texture = texture;
        return;
    }
    TextureRef placed = texture;
    placed.texCoord = map->texture.texCoord;
    placed.offset = map->texture.offset;
    placed.rotation = map->texture.rotation;
    placed.scale = map->texture.scale;
    map->texture = placed;
}

template <auto Member, class Enum>
std::optional<size_t> getChoice(const HapticStatement& statement) {
    return statement.*Member ? std::optional(static_cast<size_t>(*(statement.*Member))) : std::nullopt;
}
template <auto Member, class Enum>
void setChoice(HapticStatement& statement, std::optional<size_t> value) {
    statement.*Member = value ? std::optional(static_cast<Enum>(*value)) : std::nullopt;
}

#define TOUCHSTONE_PART(map, Kind, part)                                                                     \
    getPart<&HapticStatement::map, &Kind::part>, setPart<&HapticStatement::map, &Kind::part>
#define TOUCHSTONE_SET(map) getSet<&HapticStatement::map>, setSet<&HapticStatement::map>

constexpr std::string_view kTexCoord = "which set of texture coordinates";
constexpr std::string_view kBlack = "factor where the map is black", kWhite = "factor where the map is white";

constexpr std::array kMapParts{
    NumberField{{"heightTexture.scale", "height", "m", -kLargest, kLargest, -0.02f, 0.02f, false, "0.001",
                 "from black to white, model metres"},
                nullptr,
                TOUCHSTONE_PART(height, HeightMap, scale)},
    NumberField{{"heightTexture.midLevel", "mid level", "", 0.0f, 1.0f, 0.0f, 1.0f, false, "0.5",
                 "the value that lies on the mesh"},
                nullptr,
                TOUCHSTONE_PART(height, HeightMap, midLevel)},
    NumberField{{"heightTexture.texCoord", "coordinates", "", 0.0f, 1.0f, 0.0f, 1.0f, false, "0", kTexCoord},
                nullptr,
                TOUCHSTONE_SET(height)},
    NumberField{{"frictionTexture.min", "black", "", 0.0f, kLargest, 0.0f, 3.0f, false, "0", kBlack},
                nullptr,
                TOUCHSTONE_PART(friction, FactorMap, min)},
    NumberField{{"frictionTexture.max", "white", "", 0.0f, kLargest, 0.0f, 3.0f, false, "1", kWhite},
                nullptr,
                TOUCHSTONE_PART(friction, FactorMap, max)},
    NumberField{
        {"frictionTexture.texCoord", "coordinates", "", 0.0f, 1.0f, 0.0f, 1.0f, false, "0", kTexCoord},
        nullptr,
        TOUCHSTONE_SET(friction)},
    NumberField{{"stiffnessTexture.min", "black", "", 0.0f, kLargest, 0.0f, 3.0f, false, "0", kBlack},
                nullptr,
                TOUCHSTONE_PART(stiffnessMap, FactorMap, min)},
    NumberField{{"stiffnessTexture.max", "white", "", 0.0f, kLargest, 0.0f, 3.0f, false, "1", kWhite},
                nullptr,
                TOUCHSTONE_PART(stiffnessMap, FactorMap, max)},
    NumberField{
        {"stiffnessTexture.texCoord", "coordinates", "", 0.0f, 1.0f, 0.0f, 1.0f, false, "0", kTexCoord},
        nullptr,
        TOUCHSTONE_SET(stiffnessMap)},
    NumberField{{"dampingTexture.min", "black", "", 0.0f, kLargest, 0.0f, 3.0f, false, "0", kBlack},
                nullptr,
                TOUCHSTONE_PART(dampingMap, FactorMap, min)},
    NumberField{{"dampingTexture.max", "white", "", 0.0f, kLargest, 0.0f, 3.0f, false, "1", kWhite},
                nullptr,
                TOUCHSTONE_PART(dampingMap, FactorMap, max)},
    NumberField{{"dampingTexture.texCoord", "coordinates", "", 0.0f, 1.0f, 0.0f, 1.0f, false, "0", kTexCoord},
                nullptr,
                TOUCHSTONE_SET(dampingMap)}};

#undef TOUCHSTONE_PART
#undef TOUCHSTONE_SET

constexpr std::array<std::string_view, 6> kShading{"auto",      "off",       "twoPass",
                                                   "projected", "direction", "bezier"};
constexpr std::array<std::string_view, 2> kSides{"both", "front"}, kRepresentations{"mesh", "implicit"};

constexpr std::array kChoices{
    ChoiceField{"forceShading", "force shading", kShading, 0,
                "how the force follows the vertex normals; bezier: two-pass with a patch of normals",
                getChoice<&HapticStatement::forceShading, ShadingChoice>,
                setChoice<&HapticStatement::forceShading, ShadingChoice>},
    ChoiceField{"sides", "sides", kSides, 0, "front: from behind the hand comes through",
                getChoice<&HapticStatement::sides, SideChoice>,
                setChoice<&HapticStatement::sides, SideChoice>},
    ChoiceField{"representation", "representation", kRepresentations, 0,
                "implicit: felt as a distance field of the triangles, without its maps",
                getChoice<&HapticStatement::implicit, bool>, setChoice<&HapticStatement::implicit, bool>}};

constexpr std::array kMaps{
    MapField{"heightTexture", "height map", "bump height of the surface", getMap<&HapticStatement::height>,
             setMap<&HapticStatement::height>},
    MapField{"frictionTexture", "friction map", "multiplies both coefficients",
             getMap<&HapticStatement::friction>, setMap<&HapticStatement::friction>},
    MapField{"stiffnessTexture", "stiffness map", "multiplies the stiffness",
             getMap<&HapticStatement::stiffnessMap>, setMap<&HapticStatement::stiffnessMap>},
    MapField{"dampingTexture", "damping map", "multiplies the damping", getMap<&HapticStatement::dampingMap>,
             setMap<&HapticStatement::dampingMap>}};

constexpr std::string_view kShader = "shader";
constexpr std::string_view kParameter = "shader."; // "shader.NAME": a parameter of the program

template <class Fields>
auto find(const Fields& fields, std::string_view name) {
    const auto found =
        std::find_if(fields.begin(), fields.end(), [&](const auto& field) { return field.name == name; });
    return found == fields.end() ? nullptr : &*found;
}

std::string joined(std::span<const std::string_view> words) {
    std::string text;
    for (const std::string_view word : words)
        text += (text.empty() ? "" : ", ") + std::string(word);
    return text;
}

std::string shown(float value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// Reads a number in the field's range, or returns why it is none.
std::string readNumber(const NumberField& field, std::string_view text, float& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        return "'" + std::string(text) + "' is not a number";
    if (value < field.least || value > field.most)
        return shown(value) + " is out of range: " +
               (field.most < kLargest ? shown(field.least) + " to " + shown(field.most)
                : field.least > 0.0f  ? "above 0"
                                      : "at least " + shown(field.least));
    return {};
}

std::string setNumberField(const NumberField& field, HapticStatement& statement, std::string_view text) {
    float value = 0.0f;
    if (std::string problem = readNumber(field, text, value); !problem.empty())
        return problem;
    if (field.set(statement, value))
        return {};
    const std::string map(field.name.substr(0, field.name.find('.')));
    return "the material has no such map; give it one first: " + map + "=TEXTURE";
}

/// The index of a choice's word; the number of choices where it is none.
size_t choiceOf(const ChoiceField& field, std::string_view word) {
    return static_cast<size_t>(std::ranges::find(field.choices, word) - field.choices.begin());
}
std::string choiceProblem(const ChoiceField& field, std::string_view word) {
    return choiceOf(field, word) < field.choices.size()
               ? std::string()
               : "'" + std::string(word) + "' is none of " + joined(field.choices);
}

/// A problem with the name of its field.
std::string ofField(std::string_view name, const std::string& problem) {
    return problem.empty() ? problem : std::string(name) + ": " + problem;
}

/// "0.5" or "0.1,0.2,0.3"; empty where it is not numbers.
std::vector<double> numbersOf(std::string_view text) {
    std::vector<double> numbers;
    while (true) {
        const size_t end = std::min(text.find(','), text.size());
        double number = 0.0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + end, number);
        if (error != std::errc{} || stop != text.data() + end || !std::isfinite(number))
            return {};
        numbers.push_back(number);
        if (end == text.size())
            return numbers;
        text.remove_prefix(end + 1);
    }
}

constexpr const char* kNumbersProblem = "should be a number, or numbers with commas between them";

std::string setParameterField(HapticStatement& statement, std::string_view name, std::string_view text) {
    if (statement.program == nullptr)
        return "the material has no program that compiles";
    const auto& declared = statement.program->source.parameters;
    const auto parameter = std::ranges::find(declared, name, &ProgramParameter::name);
    if (parameter == declared.end()) {
        std::string known;
        for (const ProgramParameter& each : declared)
            known += (known.empty() ? "" : ", ") + each.name;
        return statement.program->source.name + " declares no such parameter; there are " + known;
    }
    const std::vector<double> numbers = numbersOf(text);
    if (numbers.size() != parameter->components)
        return "has " + std::to_string(parameter->components) + " components; give as many numbers";
    std::array<double, 4> value{};
    std::ranges::copy(numbers, value.begin());
    const nlohmann::json changed = withParameter(statement.shader, *parameter, value);
    try {
        (void)materialProgram(statement.program, changed);
    } catch (const Error& error) {
        return error.problem() + "; " + error.remedy();
    }
    statement.shader = KeptJson(changed);
    return {};
}

bool resetParameterField(HapticStatement& statement, std::string_view name) {
    if (statement.program == nullptr)
        return false;
    const auto& declared = statement.program->source.parameters;
    const auto parameter = std::ranges::find(declared, name, &ProgramParameter::name);
    if (parameter == declared.end())
        return false;
    statement.shader = KeptJson(withParameter(statement.shader, *parameter, parameter->value));
    return true;
}

std::string setMapField(const MapField& field, HapticStatement& statement, const Scene& scene,
                        std::string_view text) {
    if (text == "none") {
        field.set(statement, {});
        return {};
    }
    size_t index = scene.textures.size();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc{} || end != text.data() + text.size()) {
        const auto named =
            std::find_if(scene.textures.begin(), scene.textures.end(), [&](const SceneTexture& texture) {
                const int image = texture.reference.image;
                return texture.name == text ||
                       (image >= 0 && scene.images[static_cast<size_t>(image)].name == text);
            });
        index = static_cast<size_t>(named - scene.textures.begin());
    }
    if (index >= scene.textures.size() || !scene.textures[index].reference)
        return "'" + std::string(text) + "' is none of the file's textures: it has " +
               std::to_string(scene.textures.size()) + "; give an index, a name, or none";
    field.set(statement, scene.textures[index].reference);
    return {};
}

} // namespace

std::span<const NumberField> numberFields() {
    static const std::vector<NumberField> fields = [] {
        std::vector<NumberField> all;
        for (const HapticNumber& number : hapticNumbers())
            all.push_back({number, number.stated, nullptr, nullptr});
        all.insert(all.end(), kMapParts.begin(), kMapParts.end());
        return all;
    }();
    return fields;
}
std::optional<float> NumberField::get(const HapticStatement& statement) const {
    return stated != nullptr ? statement.*stated : getPart(statement);
}
bool NumberField::set(HapticStatement& statement, std::optional<float> value) const {
    if (stated == nullptr)
        return setPart(statement, value);
    statement.*stated = value;
    return true;
}
std::span<const ChoiceField> choiceFields() {
    return kChoices;
}
std::span<const MapField> mapFields() {
    return kMaps;
}

std::string setHapticField(HapticStatement& statement, const Scene& scene, std::string_view name,
                           std::string_view value) {
    std::string problem;
    if (const NumberField* number = find(numberFields(), name)) {
        problem = setNumberField(*number, statement, value);
    } else if (const MapField* map = find(kMaps, name)) {
        problem = setMapField(*map, statement, scene, value);
    } else if (const ChoiceField* choice = find(kChoices, name)) {
        problem = choiceProblem(*choice, value);
        if (problem.empty())
            choice->set(statement, choiceOf(*choice, value));
    } else if (isPersistentField(name)) {
        problem = setPersistentField(statement, name, value);
    } else if (name.starts_with(kParameter)) {
        problem = setParameterField(statement, name.substr(kParameter.size()), value);
    } else {
        return hapticFieldProblem(name);
    }
    return ofField(name, problem);
}

bool resetHapticField(HapticStatement& statement, std::string_view name) {
    if (isPersistentField(name))
        return resetPersistentField(statement, name);
    if (name.starts_with(kParameter))
        return resetParameterField(statement, name.substr(kParameter.size()));
    if (name == kShader) {
        statement.shader = nullptr;
        statement.program = nullptr;
    } else if (const NumberField* number = find(numberFields(), name))
        number->set(statement, std::nullopt);
    else if (const MapField* map = find(kMaps, name))
        map->set(statement, {});
    else if (const ChoiceField* choice = find(kChoices, name))
        choice->set(statement, std::nullopt);
    else
        return false;
    return true;
}

std::string hapticFieldProblem(std::string_view name) {
    const std::vector<std::string_view> names = hapticFieldNames();
    if (std::find(names.begin(), names.end(), name) != names.end())
        return {};
    return "'" + std::string(name) + "' is no field of a material; there are " + joined(names);
}

std::string hapticValueProblem(std::string_view name, std::string_view value) {
    float ignored = 0.0f;
    if (const NumberField* number = find(numberFields(), name))
        return ofField(name, readNumber(*number, value, ignored));
    if (const ChoiceField* choice = find(kChoices, name))
        return ofField(name, choiceProblem(*choice, value));
    if (isMappingField(name))
        return {}; // with what the file says of it
    if (name.starts_with(kParameter))
        return ofField(name, numbersOf(value).empty() ? kNumbersProblem : "");
    return hapticFieldProblem(name);
}

std::vector<std::string_view> hapticFieldNames() {
    std::vector<std::string_view> names;
    for (const NumberField& field : numberFields())
        names.push_back(field.name);
    for (const MapField& field : kMaps)
        names.push_back(field.name);
    for (const ChoiceField& field : kChoices)
        names.push_back(field.name);
    return names;
}

std::string hapticFieldHelp() {
    std::string text = "Fields of a material (NAME=VALUE):\n";
    const auto line = [&](std::string_view name, const std::string& what) {
        std::string entry = "  " + std::string(name);
        entry.resize(std::max<size_t>(entry.size() + 2, 30), ' ');
        text += entry + what + "\n";
    };
    for (const NumberField& field : numberFields())
        line(field.name, std::string(field.unit) + (field.unit.empty() ? "" : ", ") +
                             std::string(field.meaning) + " [" + std::string(field.unset) + "]");
    for (const MapField& field : kMaps)
        line(field.name, std::string(field.meaning) + ": index or name of a texture of the file, or none");
    for (const ChoiceField& field : kChoices)
        line(field.name, std::string(field.meaning) + ": " + joined(field.choices));
    line("shader.PARAMETER", "a parameter of the material's haptic program: a number, or several with commas "
                             "between them");
    return text + textureFieldHelp();
}

} // namespace touchstone
