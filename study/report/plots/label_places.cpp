#include "study/report/plots/label_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::study {

namespace {

constexpr double kClear = 2.0;       // minimum pixels between a label and anything else
constexpr double kMark = 4.5;        // half a mark
constexpr int kDirections = 16;      // tried at each distance
constexpr double kNear = 14.0;       // pixels, the first distance tried
constexpr double kFarther = 8.0;     // increment of the distance
constexpr int kDistances = 24;       // the last is 200 pixels away
constexpr double kLeaderFrom = 15.0; // pixels

double overlap(const Obstacle& a, const Obstacle& b, double clear) {
    const double x = a.halfWidth + b.halfWidth + clear - std::abs(a.x - b.x);
    const double y = a.halfHeight + b.halfHeight + clear - std::abs(a.y - b.y);
    return x > 0.0 && y > 0.0 ? x * y : 0.0;
}

} // namespace

std::vector<PlacedLabel> placeLabels(const std::vector<Obstacle>& anchors,
                                     const std::vector<Obstacle>& obstacles, double halfWidth,
                                     double halfHeight, double width, double height) {
    std::vector<PlacedLabel> placed;
    std::vector<Obstacle> labels;
    for (const Obstacle& anchor : anchors) {
        PlacedLabel best{};
        double least = INFINITY;
        for (int ring = 0; ring < kDistances && least > 0.0; ++ring)
            for (int i = 0; i < kDirections && least > 0.0; ++i) {
                // Above and to the right first.
                const double angle = std::numbers::pi * (0.25 + 2.0 * i / kDirections);
                const double away = kNear + kFarther * ring;
                const Obstacle label{
                    std::clamp(anchor.x + away * std::cos(angle), halfWidth, width - halfWidth),
                    std::clamp(anchor.y + away * std::sin(angle), halfHeight, height - halfHeight), halfWidth,
                    halfHeight};
                double cost = 0.0;
                for (const Obstacle& other : labels)
                    cost += 100.0 * overlap(label, other, kClear); // labels never overlap each other
                for (const Obstacle& other : obstacles)
                    cost += overlap(
                        label, {other.x, other.y, other.halfWidth + kMark, other.halfHeight + kMark}, 0.0);
                if (cost < least) {
                    least = cost;
                    best = {label.x, label.y, away > kLeaderFrom};
                }
            }
        placed.push_back(best);
        labels.push_back({best.x, best.y, halfWidth, halfHeight});
    }
    return placed;
}

} // namespace touchstone::study
