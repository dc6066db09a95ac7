#pragma once
// The ladders: which ways to compute each stage there are, as data. A rung more is a line more (ladder.cpp).

#include "haptics/settings/haptic_settings.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {
class HapticScene;
}

namespace touchstone::study {

/// With what the rungs of a ladder are compared.
enum class Against : uint8_t {
    Shape,   ///< the frictionless rest on the true shape: closed form, else the oracle on the mesh
    Smooth,  ///< the same, but what smooth normals mean has no truth on a mesh: there the most exact rung
    Relief,  ///< what the height map means in closed form, where that is known; else the most exact rung
    Coulomb, ///< ideal friction on what is felt without friction
};

/// A stage with a choice. Settings as `--set` takes them, separated by spaces.
struct Ladder {
    std::string_view name, question;
    std::string_view base;  ///< settings under every rung: what other stages would add is off
    std::string_view exact; ///< on top of `base`: the most exact settings that there are
    Against against = Against::Shape;
};

/// What a scene must have for a rung to make sense.
enum class Need : uint8_t { Nothing, SmoothNormals, Relief, HeightMap };

struct RungLine {
    std::string_view ladder, name, settings;
    Need need = Need::Nothing;
};

/// A ladder whose rungs are every choice of one rung from each of `axes`.
struct Product {
    std::string_view ladder;
    std::vector<std::string_view> axes; ///< ladders
};

[[nodiscard]] std::span<const Ladder> ladders();
[[nodiscard]] std::span<const RungLine> rungLines();
[[nodiscard]] std::span<const Product> products();

/// Applies "NAME=VALUE NAME=VALUE". Throws Error where one is no setting.
void applySettings(HapticSettings& settings, std::string_view assignments);

/// A rung that is to be climbed on a scene.
struct PlannedRung {
    const Ladder* ladder = nullptr;
    std::string name;
    std::string text;        ///< all that --set takes
    HapticSettings settings; ///< the same
    HapticSettings exact;    ///< the ladder's most exact settings with this rung's radius
    bool isDefault = false;  ///< chooses what the program does by itself
};

/// The rungs of one ladder that make a difference on the scene; what is left out is said in `notes`.
[[nodiscard]] std::vector<PlannedRung> planLadder(const Ladder& ladder, const HapticScene& scene,
                                                  std::vector<std::string>& notes);

/// Settings without what nothing in the scene asks for: two that are equal so are felt alike.
[[nodiscard]] HapticSettings inEffect(HapticSettings settings, const HapticScene& scene);

} // namespace touchstone::study
