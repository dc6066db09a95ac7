#pragma once
// The ablations: the alternatives of each stage, as data. A new configuration is one line (ablation.cpp).

#include "haptics/settings/haptic_settings.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {
class HapticScene;
}

namespace touchstone::study {

/// The reference of an ablation.
enum class Against : uint8_t {
    Shape,   ///< the frictionless solve on the true shape: closed form, else the oracle on the mesh
    Smooth,  ///< the same; smooth normals have no truth on a mesh, so there the most exact configuration
    Bump,    ///< the closed form of the height map where known; else the most exact configuration
    Coulomb, ///< ideal friction on the frictionless result
    Exact,   ///< the most exact configuration
};

/// A stage with alternatives. Settings as `--set` takes them, separated by spaces.
struct Ablation {
    std::string_view name, question;
    std::string_view base;  ///< settings under every configuration: they disable what other stages would add
    std::string_view exact; ///< on top of `base`: the most exact settings available
    Against against = Against::Shape;
};

/// What a scene must have for a configuration to be meaningful.
enum class Need : uint8_t { Nothing, SmoothNormals, Bump, HeightMap, Program };

struct ConfigurationLine {
    std::string_view ablation, name, settings;
    Need need = Need::Nothing;
};

/// An ablation whose configurations are the Cartesian product of `axes`.
struct Product {
    std::string_view ablation;
    std::vector<std::string_view> axes; ///< ablations
};

[[nodiscard]] std::span<const Ablation> ablations();
[[nodiscard]] std::span<const ConfigurationLine> configurationLines();
[[nodiscard]] std::span<const Product> products();

/// Applies "NAME=VALUE NAME=VALUE". Throws Error for an invalid setting.
void applySettings(HapticSettings& settings, std::string_view assignments);

/// A configuration to be measured on a scene.
struct PlannedConfiguration {
    const Ablation* ablation = nullptr;
    std::string name;
    std::string text;        ///< everything that --set takes
    HapticSettings settings; ///< the same
    HapticSettings exact;    ///< the ablation's most exact settings, with this configuration's radius
    bool isDefault = false;  ///< the program's default
};

/// The configurations of one ablation that differ on the scene; `notes` lists what is left out.
[[nodiscard]] std::vector<PlannedConfiguration>
planAblation(const Ablation& ablation, const HapticScene& scene, std::vector<std::string>& notes);

/// Settings without those that have no effect on the scene: two that are equal render the same force.
[[nodiscard]] HapticSettings inEffect(HapticSettings settings, const HapticScene& scene);

} // namespace touchstone::study
