#pragma once
// The ablations: which ways to compute each stage there are, as data. A configuration more is a line more
// (ablation.cpp).

#include "haptics/settings/haptic_settings.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {
class HapticScene;
}

namespace touchstone::study {

/// With what the configurations of an ablation are compared.
enum class Against : uint8_t {
    Shape,   ///< the frictionless rest on the true shape: closed form, else the oracle on the mesh
    Smooth,  ///< the same, but what smooth normals mean has no truth on a mesh: there the most exact
             ///< configuration
    Bump,    ///< what the height map means in closed form, where that is known; else the most exact
             ///< configuration
    Coulomb, ///< ideal friction on what is felt without friction
};

/// A stage with a choice. Settings as `--set` takes them, separated by spaces.
struct Ablation {
    std::string_view name, question;
    std::string_view base;  ///< settings under every configuration: what other stages would add is off
    std::string_view exact; ///< on top of `base`: the most exact settings that there are
    Against against = Against::Shape;
};

/// What a scene must have for a configuration to make sense.
enum class Need : uint8_t { Nothing, SmoothNormals, Bump, HeightMap };

struct ConfigurationLine {
    std::string_view ablation, name, settings;
    Need need = Need::Nothing;
};

/// An ablation whose configurations are every choice of one configuration from each of `axes`.
struct Product {
    std::string_view ablation;
    std::vector<std::string_view> axes; ///< ablations
};

[[nodiscard]] std::span<const Ablation> ablations();
[[nodiscard]] std::span<const ConfigurationLine> rungLines();
[[nodiscard]] std::span<const Product> products();

/// Applies "NAME=VALUE NAME=VALUE". Throws Error where one is no setting.
void applySettings(HapticSettings& settings, std::string_view assignments);

/// A configuration that is to be measured on a scene.
struct PlannedConfiguration {
    const Ablation* ablation = nullptr;
    std::string name;
    std::string text;        ///< all that --set takes
    HapticSettings settings; ///< the same
    HapticSettings exact;    ///< the ablation's most exact settings with this configuration's radius
    bool isDefault = false;  ///< chooses what the program does by itself
};

/// The configurations of one ablation that make a difference on the scene; what is left out is said in
/// `notes`.
[[nodiscard]] std::vector<PlannedConfiguration>
planAblation(const Ablation& ablation, const HapticScene& scene, std::vector<std::string>& notes);

/// Settings without what nothing in the scene asks for: two that are equal so are felt alike.
[[nodiscard]] HapticSettings inEffect(HapticSettings settings, const HapticScene& scene);

} // namespace touchstone::study
