#include "experiment/plan/study_plan.h"

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "haptics/settings/haptic_settings.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <set>
#include <sstream>

namespace touchstone::experiment {

namespace {

using Json = nlohmann::ordered_json;

/// One object of the file, with its place for messages. Every member must be named by `only`.
class Part {
  public:
    Part(const Json& json, std::string file, std::string place)
        : json_(json), file_(std::move(file)), place_(std::move(place)) {
        if (!json_.is_object())
            refuse("it is no object", "see touchstone experiment --print-study");
    }

    void only(std::initializer_list<std::string_view> names) const {
        for (const auto& [key, value] : json_.items())
            if (std::find(names.begin(), names.end(), key) == names.end()) {
                std::string known;
                for (const std::string_view name : names)
                    known += (known.empty() ? "" : ", ") + std::string(name);
                refuse("unknown member '" + key + "'", "known here: " + known);
            }
    }
    [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }
    [[nodiscard]] const Json& at(const char* key) const {
        if (!has(key))
            refuse(std::string("'") + key + "' is missing", "see touchstone experiment --print-study");
        return json_.at(key);
    }
    [[nodiscard]] Part part(const char* key) const { return {at(key), file_, inside(key)}; }
    [[nodiscard]] std::string text(const char* key) const {
        if (!at(key).is_string())
            refuse(std::string("'") + key + "' is no text", "give it in quotes");
        return at(key).get<std::string>();
    }
    [[nodiscard]] double number(const char* key) const {
        if (!at(key).is_number() || !std::isfinite(at(key).get<double>()))
            refuse(std::string("'") + key + "' is no number", "give it as a number");
        return at(key).get<double>();
    }
    [[nodiscard]] double number(const char* key, double otherwise) const {
        return has(key) ? number(key) : otherwise;
    }
    [[nodiscard]] size_t count(const char* key, size_t otherwise, size_t most) const {
        if (!has(key))
            return otherwise;
        const double value = number(key);
        if (value < 0.0 || value > static_cast<double>(most) || value != std::floor(value))
            refuse(std::string("'") + key + "' is no whole number up to " + std::to_string(most), "");
        return static_cast<size_t>(value);
    }
    [[nodiscard]] bool flag(const char* key) const {
        if (!has(key))
            return false;
        if (!at(key).is_boolean())
            refuse(std::string("'") + key + "' is neither true nor false", "");
        return at(key).get<bool>();
    }
    template <size_t N>
    [[nodiscard]] size_t oneOf(const char* key, const std::array<std::string_view, N>& names) const {
        const std::string value = text(key);
        const auto found = std::find(names.begin(), names.end(), value);
        if (found == names.end()) {
            std::string known;
            for (const std::string_view name : names)
                known += (known.empty() ? "" : ", ") + std::string(name);
            refuse("'" + value + "' is no choice of '" + key + "'", "one of " + known);
        }
        return static_cast<size_t>(found - names.begin());
    }
    [[nodiscard]] std::string inside(const char* key) const {
        return place_.empty() ? key : place_ + "." + key;
    }
    [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const {
        throw Error(file_, place_, problem, remedy);
    }
    [[nodiscard]] const std::string& file() const { return file_; }

  private:
    const Json& json_;
    std::string file_, place_;
};

constexpr double kSmallestRadius = 1e-3, kLargestRadius = 10.0; // m
constexpr size_t kMostSegments = 100000, kMostConditions = 26;

SmoothArc readArc(const Part& part) {
    const SmoothArc arc{.radius = part.number("radius"), .angle = part.number("angle")};
    if (!(arc.radius >= kSmallestRadius && arc.radius <= kLargestRadius))
        part.refuse("its radius lies beyond 1 mm to 10 m", "give metres");
    if (!(arc.angle > 0.0 && arc.angle < 3.0))
        part.refuse("its angle lies beyond 0 to 3 rad", "give radians");
    return arc;
}

std::vector<glm::dvec2> readPoints(const Part& part) {
    std::vector<glm::dvec2> points;
    if (!part.at("points").is_array())
        part.refuse("'points' is no list", "give [[x, y], ...] in metres");
    for (const Json& point : part.at("points")) {
        if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
            part.refuse("point " + std::to_string(points.size()) + " is not [x, y]",
                        "give two numbers in metres");
        points.emplace_back(point[0].get<double>(), point[1].get<double>());
    }
    return points;
}

PlanarStimulus readPlanar(const Part& part, const PlanarRendering& usual) {
    part.only({"arc", "polygon", "points", "closed", "force", "location"});
    PlanarStimulus stimulus{.rendering = usual};
    if (part.has("arc")) {
        part.part("arc").only({"radius", "angle"});
        stimulus.arc = readArc(part.part("arc"));
    } else if (part.has("polygon")) {
        const Part polygon = part.part("polygon");
        polygon.only({"radius", "angle", "segments"});
        stimulus.curve = PlanarStimulus::Curve::Polygon;
        stimulus.arc = readArc(polygon);
        stimulus.segments = polygon.count("segments", 0, kMostSegments);
    } else {
        stimulus.curve = PlanarStimulus::Curve::Points;
        stimulus.points = readPoints(part);
        stimulus.closed = part.flag("closed");
        try {
            (void)Polyline(stimulus.points, stimulus.closed);
        } catch (const Error& error) {
            part.refuse(error.problem(), error.remedy());
        }
    }
    if (part.has("force"))
        stimulus.rendering.force = static_cast<PlanarForce>(part.oneOf("force", kPlanarForceNames));
    if (part.has("location"))
        stimulus.rendering.location =
            static_cast<PlanarLocation>(part.oneOf("location", kPlanarLocationNames));
    return stimulus;
}

ModelStimulus readModel(const Part& part, const std::filesystem::path& folder) {
    part.only({"model", "set"});
    ModelStimulus stimulus;
    const std::filesystem::path given = part.text("model");
    stimulus.model = given.is_absolute() ? given : folder / given;
    if (!std::filesystem::exists(stimulus.model))
        part.refuse("there is no file " + stimulus.model.string(),
                    "name the model relative to the study's folder");
    if (!part.has("set"))
        return stimulus;
    if (!part.at("set").is_object())
        part.refuse("'set' is no object", "give {\"NAME\": \"VALUE\"} as for --set");
    HapticSettings trial;
    for (const auto& [name, value] : part.at("set").items()) {
        const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
        if (const std::string problem = setSetting(trial, name, text); !problem.empty())
            part.refuse("set: " + problem, "see touchstone --help");
        stimulus.settings.emplace_back(name, text);
    }
    return stimulus;
}

StimulusChoice readStimulus(const Part& part, const PlanarRendering& usual,
                            const std::filesystem::path& folder) {
    if (part.has("model"))
        return readModel(part, folder);
    return readPlanar(part, usual);
}

void readVaried(const Part& part, const StaircaseRule& usual, Condition& condition) {
    const Json& vary = part.at("vary");
    condition.rule = usual;
    const auto* planar = std::get_if<PlanarStimulus>(&condition.comparison);
    if (vary.is_string() && vary == "nothing") {
        condition.varied = Varied::Nothing;
        condition.trials = part.count("trials", 0, 10000);
        if (condition.trials == 0)
            part.refuse("it varies nothing and has no 'trials'", "give the number of trials");
        return;
    }
    if (vary.is_string() && vary == "segments") {
        condition.varied = Varied::Segments;
        if (planar == nullptr || planar->curve != PlanarStimulus::Curve::Polygon)
            part.refuse("only a polygon's segments can be varied", "compare with {\"polygon\": ...}");
    } else {
        const Part setting = part.part("vary");
        setting.only({"setting", "easy", "hard"});
        condition.varied = Varied::Setting;
        condition.setting = setting.text("setting");
        condition.easy = setting.number("easy");
        condition.hard = setting.number("hard");
        if (planar != nullptr)
            part.refuse("a curve has no settings to vary", "vary \"segments\", or compare models");
        for (const double end : {condition.easy, condition.hard}) {
            HapticSettings trial;
            if (const std::string problem = setSetting(trial, condition.setting, std::to_string(end));
                !problem.empty())
                part.refuse("vary: " + problem, "see touchstone --help");
        }
    }
    const bool segments = condition.varied == Varied::Segments;
    condition.rule.start = part.number("start");
    condition.rule.largeStep = part.number("largeStep");
    condition.rule.smallStep = part.number("smallStep");
    condition.rule.lowest = part.number("lowest", segments ? 2.0 : 0.0);
    condition.rule.highest = part.number("highest", segments ? 1000.0 : 100.0);
    if (segments)
        for (const double value : {condition.rule.start, condition.rule.largeStep, condition.rule.smallStep,
                                   condition.rule.lowest, condition.rule.highest})
            if (value != std::floor(value) || value < 1.0 || value > static_cast<double>(kMostSegments))
                part.refuse("a number of segments is not whole", "give whole levels and steps");
    try {
        (void)Staircase(condition.rule);
    } catch (const Error& error) {
        part.refuse(error.problem(), error.remedy());
    }
}

Condition readCondition(const Part& part, const PlanarRendering& rendering, const StaircaseRule& rule,
                        const std::filesystem::path& folder) {
    part.only({"name", "title", "reference", "comparison", "vary", "start", "largeStep", "smallStep",
               "lowest", "highest", "trials", "pilot"});
    Condition condition;
    condition.name = part.text("name");
    condition.title = part.has("title") ? part.text("title") : condition.name;
    condition.pilot = part.flag("pilot");
    condition.reference = readStimulus(part.part("reference"), rendering, folder);
    condition.comparison = readStimulus(part.part("comparison"), rendering, folder);
    if (condition.reference.index() != condition.comparison.index())
        part.refuse("it compares a curve with a model", "compare two curves, or two renderings of models");
    if (const auto* reference = std::get_if<PlanarStimulus>(&condition.reference);
        reference != nullptr && reference->curve == PlanarStimulus::Curve::Polygon &&
        reference->segments == 0)
        part.refuse("the reference's polygon has no 'segments'", "only the comparison's are varied");
    readVaried(part, rule, condition);
    if (const auto* polygon = std::get_if<PlanarStimulus>(&condition.comparison);
        condition.varied == Varied::Nothing && polygon != nullptr &&
        polygon->curve == PlanarStimulus::Curve::Polygon && polygon->segments == 0)
        part.refuse("the comparison's polygon has no 'segments'", "give them, or vary them");
    return condition;
}

PlanarRendering readFinger(const Part& part) {
    part.only({"stiffness", "step"});
    PlanarRendering rendering;
    rendering.stiffness = part.number("stiffness", rendering.stiffness);
    if (!(rendering.stiffness > 0.0 && rendering.stiffness <= 1e5))
        part.refuse("its stiffness lies beyond 0 to 100000 N/m", "");
    if (part.has("step"))
        rendering.step = static_cast<TangentStep>(
            part.oneOf("step", std::array<std::string_view, 2>{"published", "solved"}));
    return rendering;
}

StaircaseRule readRule(const Part& part) {
    part.only({"largeReversals", "reversals", "averaged", "mostTrials"});
    StaircaseRule rule;
    rule.largeReversals = part.count("largeReversals", rule.largeReversals, 1000);
    rule.reversals = part.count("reversals", rule.reversals, 1000);
    rule.averaged = part.count("averaged", rule.averaged, 1000);
    rule.mostTrials = part.count("mostTrials", rule.mostTrials, 100000);
    return rule;
}

} // namespace

StudyPlan parseStudy(const std::string& text, const std::filesystem::path& name) {
    StudyPlan plan;
    try {
        plan.source = Json::parse(text);
    } catch (const Json::exception& error) {
        throw Error(name.string(), "", std::string("it is no JSON: ") + error.what(),
                    "see touchstone experiment --print-study");
    }
    const Part study(plan.source, name.string(), "");
    if (!study.has("touchstoneStudy"))
        study.refuse("it is no study", "see touchstone experiment --print-study");
    if (study.number("touchstoneStudy") != kStudyVersion)
        study.refuse("it is a study of version " + study.at("touchstoneStudy").dump() +
                         "; this program reads version " + std::to_string(kStudyVersion),
                     "use the program that wrote it");
    study.only({"touchstoneStudy", "name", "question", "order", "finger", "staircase", "conditions"});
    plan.name = study.text("name");
    plan.question = study.text("question");
    if (study.has("order"))
        plan.order =
            static_cast<Order>(study.oneOf("order", std::array<std::string_view, 2>{"latinSquare", "given"}));
    const PlanarRendering rendering =
        study.has("finger") ? readFinger(study.part("finger")) : PlanarRendering{};
    const StaircaseRule rule = study.has("staircase") ? readRule(study.part("staircase")) : StaircaseRule{};
    const Json& conditions = study.at("conditions");
    if (!conditions.is_array() || conditions.empty() || conditions.size() > kMostConditions)
        study.refuse("'conditions' is no list of 1 to 26", "");
    std::set<std::string> names;
    for (size_t i = 0; i < conditions.size(); ++i) {
        const Part part(conditions[i], name.string(), "conditions[" + std::to_string(i) + "]");
        plan.conditions.push_back(readCondition(part, rendering, rule, name.parent_path()));
        if (!names.insert(plan.conditions.back().name).second)
            part.refuse("a second condition has the name '" + plan.conditions.back().name + "'", "");
    }
    return plan;
}

StudyPlan readStudy(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in)
        throw Error(file.string(), "", "cannot be opened", "check the name");
    std::stringstream text;
    text << in.rdbuf();
    return parseStudy(text.str(), file);
}

std::vector<size_t> StudyPlan::selected(bool pilots) const {
    std::vector<size_t> found;
    for (size_t i = 0; i < conditions.size(); ++i)
        if (conditions[i].pilot == pilots)
            found.push_back(i);
    return found;
}

std::vector<size_t> StudyPlan::orderFor(size_t person, bool pilots) const {
    const std::vector<size_t> all = selected(pilots);
    const size_t count = all.size();
    if (order == Order::Given || count < 2)
        return all;
    // 0, 1, n-1, 2, n-2, ... plus the person's row.
    std::vector<size_t> row(count);
    for (size_t i = 0; i < count; ++i) {
        const size_t base = i % 2 == 1 ? (i + 1) / 2 : (count - i / 2) % count;
        row[i] = all[(base + person) % count];
    }
    return row;
}

} // namespace touchstone::experiment
