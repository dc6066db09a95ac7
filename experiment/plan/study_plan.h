#pragma once
// A study: conditions, each of which asks people to tell one rendering from another, as a JSON file
// (docs/experiment.md).

#include "experiment/procedure/staircase.h"
#include "haptics/finger/planar_touch.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace touchstone::experiment {

/// A curve in the plane under the arc finger [004].
struct PlanarStimulus {
    enum class Curve : uint8_t { Arc, Polygon, Points };
    Curve curve = Curve::Arc;
    SmoothArc arc{};                  ///< of Arc and Polygon
    size_t segments = 0;              ///< of Polygon; 0: the level
    std::vector<glm::dvec2> points{}; ///< m, of Points
    bool closed = false;
    PlanarRendering rendering{};
};

/// A model under the proxy.
struct ModelStimulus {
    std::filesystem::path model{};
    std::vector<std::pair<std::string, std::string>> settings{}; ///< names and values of setSetting, in order
};

using StimulusChoice = std::variant<PlanarStimulus, ModelStimulus>;

/// What the level of a condition's comparison is.
enum class Varied : uint8_t {
    Segments, ///< of its polygon
    Setting,  ///< percent of the way from `easy` to `hard` of one setting
    Nothing   ///< a fixed number of trials
};

struct Condition {
    std::string name{}, title{};
    StimulusChoice reference{}, comparison{};
    Varied varied = Varied::Segments;
    std::string setting{}; ///< where a setting is varied
    double easy = 0.0, hard = 0.0;
    StaircaseRule rule{}; ///< not where nothing is varied
    size_t trials = 0;    ///< where nothing is varied
    bool pilot = false;   ///< in no Latin square and no analysis of variance; for some people only

    /// The value of `setting` at a level.
    [[nodiscard]] double settingAt(double level) const noexcept {
        return easy + 0.01 * level * (hard - easy);
    }
};

enum class Order : uint8_t { LatinSquare, Given };

struct StudyPlan {
    std::string name{}, question{};
    Order order = Order::LatinSquare;
    std::vector<Condition> conditions{};
    nlohmann::ordered_json source; ///< as read

    /// Indices of the conditions that are pilots, or not.
    [[nodiscard]] std::vector<size_t> selected(bool pilots) const;
    /// In the order of person 0, 1, ...: a row of a square in which, for an even number of conditions, each
    /// follows each other once (Williams 1949), in the odd case its rotation.
    [[nodiscard]] std::vector<size_t> orderFor(size_t person, bool pilots = false) const;
};

/// `name`: of the file, for messages; models are sought beside it. Throws Error that names the place, for
/// text that is no study, an unknown member, and for polylines that Polyline refuses.
[[nodiscard]] StudyPlan parseStudy(const std::string& text, const std::filesystem::path& name);
[[nodiscard]] StudyPlan readStudy(const std::filesystem::path& file);

/// The study of [004]: C1 to C4 and the pilots P1, P2.
[[nodiscard]] std::string_view paperStudy();

inline constexpr int kStudyVersion = 1;

} // namespace touchstone::experiment
