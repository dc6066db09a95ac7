#include "workbench/figures/perception_figures.h"

#include "study/perception/perceptual_check.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdio>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

template <class... Values>
std::string line(const char* format, Values... values) {
    std::array<char, 320> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

double rounded(double value) {
    return std::round(1e6 * value) * 1e-6;
}

} // namespace

Json perceptionJson(const Model& model) {
    const study::PerceptualCheck check = study::checkPerception(*model.haptic);
    const double scale = model.workspaceFromScene.scale;
    const glm::dvec3 at = model.workspaceFromScene.inversePoint(check.largestAt);
    Json limits = Json::array();
    for (const study::FacetCheck& row : check.limits) {
        Json one{{"condition", row.limit.condition},
                 {"rendering", row.limit.rendering},
                 {"limit_deg", row.limit.degrees},
                 {"edges_beyond", row.beyond},
                 {"applies", !row.limit.shaded || check.anySmooth},
                 {"triangles_enough", nullptr},
                 {"error_m", nullptr},
                 {"triangles_needed", nullptr}};
        if (row.enough) {
            one["triangles_enough"] = *row.enough;
            one["error_m"] = row.error / scale;
        }
        if (row.needed)
            one["triangles_needed"] = *row.needed;
        limits.push_back(std::move(one));
    }
    return {{"triangles", check.triangles},
            {"edges", check.edges},
            {"creases", check.creases},
            {"median_deg", rounded(check.median)},
            {"p90_deg", rounded(check.most90)},
            {"p99_deg", rounded(check.most99)},
            {"largest_deg", rounded(check.largest)},
            {"largest_at_m", {at.x, at.y, at.z}},
            {"simplified", check.simplified},
            {"limits", limits}};
}

std::string perceptionText(const Json& json) {
    const size_t smooth = json["edges"].get<size_t>() - json["creases"].get<size_t>();
    if (json["edges"] == 0)
        return "";
    std::string text = line("  facets: %zu edges, and %zu creases that are meant; angles %.3g degrees "
                            "(median), %.3g (99 %%), %.3g at most\n",
                            smooth, json["creases"].get<size_t>(), json["median_deg"].get<double>(),
                            json["p99_deg"].get<double>(), json["largest_deg"].get<double>());
    text += "  edges beyond the angles of [004] (one cylinder of 100 mm, means of twelve people who were "
            "right in 70.7 %):\n";
    for (const Json& row : json["limits"]) {
        const std::string rendering = row["rendering"];
        text += line("    %4.1f  %-42s", row["limit_deg"].get<double>(), rendering.c_str());
        if (!row["applies"].get<bool>()) {
            text += " no smooth normals to shade with\n";
            continue;
        }
        const auto beyond = row["edges_beyond"].get<size_t>();
        text += line(" %9zu (%.3g %%)", beyond,
                     smooth > 0 ? 100.0 * static_cast<double>(beyond) / static_cast<double>(smooth) : 0.0);
        if (!row["triangles_enough"].is_null() && json["simplified"].get<bool>())
            text += line("; %zu triangles would do, within %.2g mm", row["triangles_enough"].get<size_t>(),
                         1e3 * row["error_m"].get<double>());
        else if (!row["triangles_needed"].is_null())
            text += line("; about %zu triangles needed", row["triangles_needed"].get<size_t>());
        text += "\n";
    }
    return text;
}

} // namespace touchstone
