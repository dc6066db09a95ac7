#pragma once
// The cases of "how exact it is" in docs/architecture.md: short ones for every run, long ones for the sweep.

#include "tests/support/exact_trial.h"
#include "tests/support/strokes.h"

#include <filesystem>
#include <string>
#include <vector>

namespace touchstone::test {

/// A hand over a scene, anywhere on it.
struct HandCase {
    std::string name;
    double radius = 0.0;   ///< fitted m
    double speed = 0.1;    ///< fitted m/s
    int ticks = 500;       ///< at least, in whole strokes
    double compared = 1.0; ///< share of the ticks that the oracle checks too, by chance
    bool taps = false;     ///< no strokes
};

/// The four hands of a scene: both radii at 0.1 and 1 m/s, or taps.
[[nodiscard]] std::vector<HandCase> handsOver(const std::string& name, int ticks, double compared = 1.0);

/// The scene with its fields felt as the meshes that they are made of, which is what the oracle knows.
[[nodiscard]] Scene asMeshes(Scene scene);

/// Strokes in closed form over one of our shapes, for `ticks` ticks.
[[nodiscard]] ExactFigures runStroke(const StrokeCase& c, int ticks);
/// Random taps and strokes over a scene.
[[nodiscard]] ExactFigures runHand(const HandCase& c, ExactScene& scene);
[[nodiscard]] std::vector<ExactFigures> runHands(const std::vector<HandCase>& hands, const Scene& scene);
/// The worst distance of any corner of the compiled scene from the source's place for it, which is taken
/// through all transforms in long double; in diagonals of its object.
[[nodiscard]] long double vertexError(const Scene& source, Fit fit);
/// The same hands over a scene file.
[[nodiscard]] std::vector<ExactFigures> runFile(const std::filesystem::path& file, int ticks);

/// What every case must show; prints the table, its sum as `name`, and the list of divergences.
void expectExact(const std::string& name, const std::vector<ExactFigures>& all);

} // namespace touchstone::test
