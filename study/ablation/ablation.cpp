#include "study/ablation/ablation.h"

#include <array>

namespace touchstone::study {

namespace {

constexpr std::string_view kBare = "forceShading=off texture=off friction=off stiffness=600 damping=0";
constexpr std::string_view kUntextured = "texture=off friction=off stiffness=600 damping=0";

/// Without the tilt limit, which the closed form does not model.
constexpr std::string_view kBump = "friction=off stiffness=600 damping=0 textureTiltLimit=90";

constexpr std::array kAblations{
    Ablation{"contact", "how contacts are found", kBare, "contact=sweep iterationBudget=1000",
             Against::Shape},
    Ablation{"budget", "how many moves the proxy may make in a tick", kBare,
             "contact=sweep iterationBudget=1000", Against::Shape},
    Ablation{"shading", "what smooth normals do to the force", kUntextured,
             "contact=sweep forceShading=twoPass iterationBudget=1000", Against::Smooth},
    Ablation{"texture", "how bump height becomes force", kBump, "contact=sweep texture=law", Against::Bump},
    Ablation{"filter", "how maps are read between their texels", kBump,
             "contact=sweep texture=law textureFilter=bicubic textureGradient=central", Against::Bump},
    Ablation{"gradient", "where the slope of a height map comes from", kBump,
             "contact=sweep texture=law textureFilter=bicubic textureGradient=central", Against::Bump},
    Ablation{"friction", "how the surface holds the hand back",
             "texture=off stiffness=600 damping=0 staticFriction=0.4 dynamicFriction=0.3",
             "contact=sweep friction=off", Against::Coulomb},
    Ablation{"program", "where the slope of a program's displacement comes from", kBare,
             "contact=sweep programs=dual", Against::Exact},
    Ablation{"tessellation", "into how many triangles a shape is cut", kUntextured,
             "contact=sweep forceShading=twoPass iterationBudget=1000", Against::Smooth},
    Ablation{"combination", "everything about the shape at once", kUntextured,
             "contact=sweep forceShading=twoPass iterationBudget=1000", Against::Smooth},
};

constexpr std::array kConfigurations{
    ConfigurationLine{"contact", "neighbourhood", "contact=neighbourhood"},
    ConfigurationLine{"contact", "rays, single", "contact=rays precision=single"},
    ConfigurationLine{"contact", "rays", "contact=rays"},
    ConfigurationLine{"contact", "sweep r = 0", "contact=sweep proxyRadius=0"},
    ConfigurationLine{"contact", "sweep r = 0.5 mm", "contact=sweep proxyRadius=0.0005"},

    ConfigurationLine{"budget", "1 move", "iterationBudget=1"},
    ConfigurationLine{"budget", "2 moves", "iterationBudget=2"},
    ConfigurationLine{"budget", "4 moves", "iterationBudget=4"},
    ConfigurationLine{"budget", "64 moves", "iterationBudget=64"},

    ConfigurationLine{"shading", "off", "forceShading=off"},
    ConfigurationLine{"shading", "direction", "forceShading=direction", Need::SmoothNormals},
    ConfigurationLine{"shading", "projected", "forceShading=projected", Need::SmoothNormals},
    ConfigurationLine{"shading", "two-pass", "forceShading=twoPass", Need::SmoothNormals},
    ConfigurationLine{"shading", "bezier", "forceShading=bezier", Need::SmoothNormals},
    ConfigurationLine{"shading", "single round", "forceShading=singleRound", Need::SmoothNormals},

    ConfigurationLine{"texture", "off", "texture=off", Need::Bump},
    ConfigurationLine{"texture", "law", "texture=law", Need::Bump},
    ConfigurationLine{"texture", "Blinn", "texture=blinn", Need::Bump},
    ConfigurationLine{"texture", "Blinn, magnitude", "texture=blinnMagnitude", Need::HeightMap},
    ConfigurationLine{"texture", "Minsky", "texture=minsky", Need::Bump},

    ConfigurationLine{"filter", "nearest", "textureFilter=nearest", Need::Bump},
    ConfigurationLine{"filter", "bilinear", "textureFilter=bilinear", Need::Bump},
    ConfigurationLine{"filter", "bicubic", "textureFilter=bicubic", Need::Bump},
    ConfigurationLine{"filter", "mip by speed", "textureFilter=mip", Need::Bump},

    ConfigurationLine{"gradient", "central", "textureGradient=central", Need::HeightMap},
    ConfigurationLine{"gradient", "precomputed", "textureGradient=precomputed", Need::HeightMap},
    ConfigurationLine{"gradient", "analytic", "textureGradient=analytic", Need::HeightMap},
    ConfigurationLine{"gradient", "bicubic, central", "textureFilter=bicubic textureGradient=central",
                      Need::HeightMap},
    ConfigurationLine{"gradient", "bicubic, precomputed", "textureFilter=bicubic textureGradient=precomputed",
                      Need::HeightMap},
    ConfigurationLine{"gradient", "bicubic, analytic", "textureFilter=bicubic textureGradient=analytic",
                      Need::HeightMap},

    ConfigurationLine{"friction", "off", "friction=off"},
    ConfigurationLine{"friction", "Zilles", "friction=zilles"},
    ConfigurationLine{"friction", "Ho", "friction=ho"},
    ConfigurationLine{"friction", "elasto-plastic", "friction=elastoplastic"},
    ConfigurationLine{"friction", "velocity threshold", "friction=velocityThreshold"},

    ConfigurationLine{"program", "off", "programs=off", Need::Program},
    ConfigurationLine{"program", "no gradient", "programs=noGradient", Need::Program},
    ConfigurationLine{"program", "central differences", "programs=central", Need::Program},
    ConfigurationLine{"program", "dual numbers", "programs=dual", Need::Program},

    ConfigurationLine{"tessellation", "flat", "forceShading=off"},
    ConfigurationLine{"tessellation", "direction", "forceShading=direction", Need::SmoothNormals},
    ConfigurationLine{"tessellation", "two-pass", "forceShading=twoPass", Need::SmoothNormals},
};

} // namespace

std::span<const Ablation> ablations() {
    return kAblations;
}

std::span<const ConfigurationLine> configurationLines() {
    return kConfigurations;
}

std::span<const Product> products() {
    static const std::array kProducts{Product{"combination", {"contact", "budget", "shading"}}};
    return kProducts;
}

} // namespace touchstone::study
