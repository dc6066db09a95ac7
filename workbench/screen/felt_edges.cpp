#include "workbench/screen/felt_edges.h"

#include "renderer/false_color.h"
#include "study/perception/perceptual_check.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace touchstone {

std::vector<EffectColors::Kind> feltColors(const HapticScene& scene) {
    const study::PerceptualCheck check = study::checkPerception(scene, study::Search::CountAlone);
    std::vector<study::FacetCheck> limits = check.limits;
    std::ranges::sort(limits, {}, [](const study::FacetCheck& row) { return row.limit.degrees; });
    std::vector<EffectColors::Kind> kinds;
    const auto colorOf = [](size_t steps) {
        return falseColor(static_cast<double>(steps) / static_cast<double>(kFeltAngles.size()));
    };
    std::array<char, 160> text{};
    for (size_t i = limits.size(); i-- > 0;) {
        const study::FacetCheck& row = limits[i];
        std::snprintf(text.data(), text.size(), "> %.1f\u00b0: %zu edges; %s", row.limit.degrees, row.beyond,
                      row.limit.shaded && !check.anySmooth ? "no smooth normals to shade with"
                                                           : row.limit.rendering);
        kinds.push_back({text.data(), colorOf(i + 1)});
    }
    std::snprintf(text.data(), text.size(), "none of %zu edges (grey: %zu creases, borders)",
                  check.edges - check.creases, check.creases);
    kinds.push_back({text.data(), colorOf(0)});
    return kinds;
}

} // namespace touchstone
