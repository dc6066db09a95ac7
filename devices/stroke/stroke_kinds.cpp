#include "devices/stroke/stroke_kinds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone {

namespace {

using Curve = std::vector<glm::dvec2>; // m in the site's view

constexpr double kLanding = 0.08;   ///< m/s at most, from there onto the surface and back, in the air
constexpr double kSpacing = 2.5e-4; ///< m between the points that are laid
constexpr double kFewest = 16;      ///< minimum number of points of a curve

/// `place(t)` for t from 0 to 1, about `length` m long.
template <class Place>
Curve drawn(double length, const Place& place) {
    const double count = std::max(kFewest, std::ceil(length / kSpacing));
    Curve curve;
    for (double i = 0.0; i <= count; i += 1.0)
        curve.push_back(place(i / count));
    return curve;
}

Curve straight(double reach) {
    return drawn(2.0 * reach, [&](double t) { return glm::dvec2(reach * (2.0 * t - 1.0), 0.0); });
}

Curve ring(double reach) {
    const double round = 2.0 * std::numbers::pi;
    Curve curve = drawn(round * reach, [&](double t) {
        return reach * glm::dvec2(std::sin(round * t), std::cos(round * t));
    });
    curve.back() = curve.front();
    return curve;
}

/// Outwards with a seventh of the reach between the turns.
Curve spiral(double reach) {
    constexpr double kTurns = 6.0, kStart = 1.0 / 7.0;
    const double angle = 2.0 * std::numbers::pi * kTurns;
    // The radius grows linearly with the angle, so the arc length grows with the radius squared.
    return drawn(0.5 * (1.0 + kStart) * reach * angle, [&](double t) {
        const double share = std::sqrt(kStart * kStart + t * (1.0 - kStart * kStart));
        const double at = angle * (share - kStart) / (1.0 - kStart);
        return reach * share * glm::dvec2(std::sin(at), std::cos(at));
    });
}

/// Nine lines back and forth, joined by half circles: a scan of a 3:2 field.
Curve raster(double reach) {
    constexpr int kLines = 9;
    const double high = reach * 2.0 / 3.0, step = 2.0 * high / (kLines - 1), bend = 0.5 * step;
    const double wide = reach - bend, line = 2.0 * wide, turn = std::numbers::pi * bend;
    const double length = kLines * line + (kLines - 1) * turn;
    return drawn(length, [&](double t) {
        const double way = t * length;
        const int row = std::min(kLines - 1, static_cast<int>(way / (line + turn)));
        const double rest = way - row * (line + turn), y = high - row * step,
                     side = row % 2 == 0 ? 1.0 : -1.0;
        if (rest <= line)
            return glm::dvec2(side * (rest - wide), y);
        const double angle = (rest - line) / bend;
        return glm::dvec2(side * (wide + bend * std::sin(angle)), y - bend * (1.0 - std::cos(angle)));
    });
}

/// Descends at the landing speed in the air; a slower stroke slows down at the surface.
void land(StrokeMotion& motion, const StrokeTold& told) {
    if (told.speed < kLanding)
        motion.liftTo(told.depth, kLanding);
    motion.liftTo(0.0, std::min(told.speed, kLanding));
}
void leave(StrokeMotion& motion, const StrokeTold& told) {
    if (told.speed < kLanding)
        motion.liftTo(told.depth, told.speed);
    motion.liftTo(told.depth + told.hover, kLanding);
    motion.rest(0.2);
}

/// Onto the surface, then in and out, as in probing hardness.
void press(StrokeMotion& motion, const LaidCurve&, const StrokeTold& told) {
    motion.liftTo(told.depth, kLanding);
    for (int i = 0; i < 3; ++i) {
        motion.liftTo(0.0, told.speed);
        motion.rest(0.3);
        motion.liftTo(told.depth, told.speed);
        motion.rest(0.2);
    }
    leave(motion, told);
}

/// Five taps, each down and at once up again, twice a second.
void tap(StrokeMotion& motion, const LaidCurve&, const StrokeTold& told) {
    for (int i = 0; i < 5; ++i) {
        motion.liftTo(0.0, told.speed);
        motion.liftTo(told.depth + told.hover, told.speed);
        motion.rest(0.2);
    }
}

void hold(StrokeMotion& motion, const LaidCurve&, const StrokeTold& told) {
    constexpr double kTremor = 5e-5; // m; a finger that presses trembles by some hundredths of a millimetre
    motion.liftTo(0.0, told.speed);
    motion.tremble(4.0, kTremor);
    leave(motion, told);
}

/// Back and forth in reaches, as in feeling for a bump.
void rub(StrokeMotion& motion, const LaidCurve& curve, const StrokeTold& told) {
    land(motion, told);
    for (int i = 0; i < 3; ++i) {
        motion.reachTo(curve.length(), told.speed);
        motion.reachTo(0.0, told.speed);
    }
    leave(motion, told);
}

void round(StrokeMotion& motion, const LaidCurve& curve, const StrokeTold& told) {
    land(motion, told);
    motion.runTo(3.0 * curve.length(), told.speed);
    leave(motion, told);
}

/// Over the edge and back, three times: the curve is closed, and the far side is in its middle.
void cross(StrokeMotion& motion, const LaidCurve& curve, const StrokeTold& told) {
    land(motion, told);
    for (int i = 0; i < 6; ++i)
        motion.reachTo(0.5 * (i + 1) * curve.length(), told.speed);
    leave(motion, told);
}

/// To the end at constant speed and back.
void follow(StrokeMotion& motion, const LaidCurve& curve, const StrokeTold& told) {
    land(motion, told);
    motion.runTo(curve.length(), told.speed);
    motion.runTo(0.0, told.speed);
    leave(motion, told);
}

// Speeds and forces of human exploration: 20 to 200 mm/s and 0.5 to 2 N (0.6 N per millimetre at 600 N/m).
constexpr std::array kKinds{
    StrokeKind{
        {"tour", "round the model on the side that faces you, hopping over gaps and steps", 0.1, 0.001}},
    StrokeKind{{"press", "into the surface and out again, to feel how stiff it is", 0.02, 0.003},
               0.0,
               nullptr,
               press},
    StrokeKind{{"tap", "five taps, down and at once up again", 0.15, 0.0015}, 0.0, nullptr, tap},
    StrokeKind{{"slide", "straight to and fro over 30 mm", 0.1, 0.001}, 0.015, straight, rub},
    StrokeKind{{"circle", "three times round a circle of 20 mm", 0.08, 0.001}, 0.01, ring, round},
    StrokeKind{{"zigzag", "scans a field of 30 x 20 mm line by line", 0.08, 0.001}, 0.015, raster, follow},
    StrokeKind{{"spiral", "out and back in a spiral of 24 mm", 0.06, 0.001}, 0.012, spiral, follow},
    StrokeKind{{"hold", "rests on one point for 4 s, trembling at 8 to 12 Hz as hands do", 0.05, 0.0015},
               0.0,
               nullptr,
               hold},
    StrokeKind{
        {"edge", "to and fro across the model's sharpest edge", 0.05, 0.001}, 0.012, ring, cross, true},
    StrokeKind{{"fast", "to and fro over 60 mm, as fast as one wipes", 0.5, 0.001}, 0.03, straight, rub},
};

} // namespace

std::span<const StrokeKind> strokeKinds() {
    return kKinds;
}

const StrokeKind* findKind(std::string_view name) {
    const auto found =
        std::ranges::find_if(kKinds, [&](const StrokeKind& kind) { return kind.info.name == name; });
    return found != kKinds.end() ? &*found : nullptr;
}

} // namespace touchstone
