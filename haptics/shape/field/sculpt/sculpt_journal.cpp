#include "haptics/shape/field/sculpt/sculpt_journal.h"

#include "engine/core/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

/// Reads the members of one step.
class StepReader {
  public:
    StepReader(const Json& json, const std::string& shownAs, size_t number)
        : json_(json), shownAs_(shownAs), place_("strokes[" + std::to_string(number) + "]") {
        if (!json.is_object())
            refuse("is no object", "see docs/sculpting.md");
    }

    [[nodiscard]] SculptStep read() const {
        SculptStep step;
        const std::string tool = text("tool");
        if (json_.contains("time"))
            step.time = number("time", 0.0, 0.0, 1e9);
        if (tool == "undo" || tool == "redo") {
            knowsOnly({"tool", "time"});
            step.action = tool == "undo" ? SculptAction::Undo : SculptAction::Redo;
            return step;
        }
        const std::optional<SculptTool> named = sculptToolNamed(tool);
        if (!named)
            refuse("has no known tool: \"" + tool.substr(0, 40) + "\"", toolNames());
        knowsOnly({"tool", "time", "radius", "strength", "falloff", "points", "object", "stamp", "color"});
        step.tool = *named;
        step.radius = number("radius", {}, 1e-12, 1e9);
        step.strength = number("strength", 1.0, 1e-6, 1.0);
        step.falloff = number("falloff", 0.0, 0.0, 1.0);
        step.object = text("object");
        step.stamp = text("stamp");
        const bool stamps = step.tool == SculptTool::Stamp || step.tool == SculptTool::Imprint;
        if (stamps == step.stamp.empty())
            refuse(stamps ? "names no \"stamp\"" : "names a \"stamp\", which its tool does not use",
                   "stamp and imprint name an object of the scene");
        const bool paints = step.tool == SculptTool::Paint;
        if (paints != json_.contains("color"))
            refuse(paints ? "has no \"color\"" : "has a \"color\", which its tool does not use",
                   "paint has one: [red, green, blue], linear, 0 to 1");
        if (paints)
            step.color = color();
        readPoints(step.points);
        return step;
    }
    [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const {
        throw Error(shownAs_, place_, problem, remedy);
    }

  private:
    static std::string toolNames() {
        std::string names = "tools are undo, redo";
        for (const SculptToolInfo& info : sculptTools())
            names += std::string(", ") + info.name;
        return names;
    }
    void knowsOnly(std::initializer_list<const char*> known) const {
        for (const auto& [name, value] : json_.items())
            if (std::ranges::find_if(known, [&, own = std::string_view(name)](const char* one) {
                    return own == one;
                }) == known.end())
                refuse("has an unknown member \"" + name.substr(0, 40) + "\"", "see docs/sculpting.md");
    }
    [[nodiscard]] std::string text(const char* name) const {
        const auto found = json_.find(name);
        if (found == json_.end())
            return {};
        if (!found->is_string())
            refuse(std::string("its \"") + name + "\" is no text", "");
        return found->get<std::string>();
    }
    [[nodiscard]] double number(const char* name, std::optional<double> otherwise, double low,
                                double high) const {
        const auto found = json_.find(name);
        if (found == json_.end() && otherwise)
            return *otherwise;
        const double value = found != json_.end() && found->is_number() ? found->get<double>() : std::nan("");
        if (!(value >= low && value <= high))
            refuse(std::string("its \"") + name + "\" is no number in the range",
                   "give " + std::to_string(low) + " to " + std::to_string(high));
        return value;
    }
    [[nodiscard]] glm::vec3 color() const {
        const Json& three = json_.at("color");
        glm::vec3 color(NAN);
        for (size_t k = 0; three.is_array() && three.size() == 3 && k < 3; ++k)
            if (three[k].is_number())
                color[static_cast<glm::vec3::length_type>(k)] = three[k].get<float>();
        for (int k = 0; k < 3; ++k)
            if (!(color[k] >= 0.0f && color[k] <= 1.0f))
                refuse("its \"color\" is not three numbers in 0..1", "give [red, green, blue], linear");
        return color;
    }
    void readPoints(std::vector<glm::dvec3>& points) const {
        const auto found = json_.find("points");
        if (found == json_.end() || !found->is_array() || found->empty())
            refuse("has no \"points\"", "give at least one [x, y, z], metres");
        for (const Json& point : *found) {
            glm::dvec3 place(NAN);
            for (size_t axis = 0; point.is_array() && point.size() == 3 && axis < 3; ++axis)
                if (point[axis].is_number())
                    place[static_cast<glm::dvec3::length_type>(axis)] = point[axis].get<double>();
            if (!(glm::length(place) < 1e9))
                refuse("points[" + std::to_string(points.size()) + "] is not three numbers below 1e9",
                       "give [x, y, z], metres");
            points.push_back(place);
        }
    }

    const Json& json_;
    const std::string& shownAs_;
    std::string place_;
};

} // namespace

std::vector<SculptStep> sculptJournalOf(std::string_view text, const std::string& shownAs) {
    const Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded() || !json.is_object() || !json.contains("sculpt") || json["sculpt"] != 1 ||
        !json.contains("strokes") || !json["strokes"].is_array())
        throw Error(shownAs, "", "is no journal of sculpting: {\"sculpt\": 1, \"strokes\": [...]}",
                    "see docs/sculpting.md");
    std::vector<SculptStep> steps;
    std::optional<double> last;
    for (const Json& one : json["strokes"]) {
        const StepReader reader(one, shownAs, steps.size());
        steps.push_back(reader.read());
        const std::optional<double>& time = steps.back().time;
        if (last && (!time || *time < *last))
            reader.refuse("comes before the one before it", "order the strokes by their times");
        last = time;
    }
    return steps;
}

std::vector<SculptStep> readSculptJournal(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::error_code problem;
    const uint64_t size = std::filesystem::file_size(file, problem);
    if (!stream || problem)
        throw Error(file.string(), "", "cannot be read", "check its name");
    if (size > kMostJournalBytes)
        throw Error(file.string(), "", "is larger than 64 MiB", "divide the journal");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return sculptJournalOf(text, file.string());
}

std::string sculptJournalText(const std::vector<SculptStep>& steps) {
    Json strokes = Json::array();
    for (const SculptStep& step : steps) {
        Json json;
        if (step.action != SculptAction::Stroke) {
            json["tool"] = step.action == SculptAction::Undo ? "undo" : "redo";
        } else {
            json = {{"tool", infoOf(step.tool).name},
                    {"radius", step.radius},
                    {"strength", step.strength},
                    {"falloff", step.falloff},
                    {"points", Json::array()}};
            for (const glm::dvec3& point : step.points)
                json["points"].push_back({point.x, point.y, point.z});
            if (!step.object.empty())
                json["object"] = step.object;
            if (!step.stamp.empty())
                json["stamp"] = step.stamp;
            if (step.tool == SculptTool::Paint)
                json["color"] = Json::array({step.color.x, step.color.y, step.color.z});
        }
        if (step.time)
            json["time"] = *step.time;
        strokes.push_back(std::move(json));
    }
    return Json{{"sculpt", 1}, {"strokes", std::move(strokes)}}.dump(1, ' ', false,
                                                                     Json::error_handler_t::replace) +
           "\n";
}

} // namespace touchstone
