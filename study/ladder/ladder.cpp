#include "study/ladder/ladder.h"

#include <array>

namespace touchstone::study {

namespace {

constexpr std::string_view kBare = "forceShading=off texture=off friction=off stiffness=600 damping=0";
constexpr std::string_view kUntextured = "texture=off friction=off stiffness=600 damping=0";

/// Without the limit of tilts, which the closed form does not know.
constexpr std::string_view kRelief = "friction=off stiffness=600 damping=0 textureTiltLimit=90";

constexpr std::array kLadders{
    Ladder{"contact", "how contacts are found", kBare, "contact=sweep iterationBudget=1000", Against::Shape},
    Ladder{"budget", "how many moves the proxy may make in a tick", kBare,
           "contact=sweep iterationBudget=1000", Against::Shape},
    Ladder{"shading", "what smooth normals do to the force", kUntextured,
           "contact=sweep forceShading=twoPass iterationBudget=1000", Against::Smooth},
    Ladder{"texture", "how relief becomes force", kRelief, "contact=sweep texture=law", Against::Relief},
    Ladder{"filter", "how maps are read between their texels", kRelief,
           "contact=sweep texture=law textureFilter=bicubic textureGradient=central", Against::Relief},
    Ladder{"gradient", "where the slope of a height map comes from", kRelief,
           "contact=sweep texture=law textureFilter=bicubic textureGradient=central", Against::Relief},
    Ladder{"friction", "how the surface holds the hand back",
           "texture=off stiffness=600 damping=0 staticFriction=0.4 dynamicFriction=0.3",
           "contact=sweep friction=off", Against::Coulomb},
    Ladder{"tessellation", "into how many triangles a shape is cut", kUntextured,
           "contact=sweep forceShading=twoPass iterationBudget=1000", Against::Smooth},
    Ladder{"combination", "everything about the shape at once", kUntextured,
           "contact=sweep forceShading=twoPass iterationBudget=1000", Against::Smooth},
};

constexpr std::array kRungs{
    RungLine{"contact", "neighbourhood", "contact=neighbourhood"},
    RungLine{"contact", "rays, single", "contact=rays precision=single"},
    RungLine{"contact", "rays", "contact=rays"},
    RungLine{"contact", "sweep r = 0", "contact=sweep proxyRadius=0"},
    RungLine{"contact", "sweep r = 0.5 mm", "contact=sweep proxyRadius=0.0005"},

    RungLine{"budget", "1 move", "iterationBudget=1"},
    RungLine{"budget", "2 moves", "iterationBudget=2"},
    RungLine{"budget", "4 moves", "iterationBudget=4"},
    RungLine{"budget", "64 moves", "iterationBudget=64"},

    RungLine{"shading", "off", "forceShading=off"},
    RungLine{"shading", "direction", "forceShading=direction", Need::SmoothNormals},
    RungLine{"shading", "projected", "forceShading=projected", Need::SmoothNormals},
    RungLine{"shading", "two-pass", "forceShading=twoPass", Need::SmoothNormals},

    RungLine{"texture", "off", "texture=off", Need::Relief},
    RungLine{"texture", "law", "texture=law", Need::Relief},
    RungLine{"texture", "Blinn", "texture=blinn", Need::Relief},
    RungLine{"texture", "Minsky", "texture=minsky", Need::Relief},

    RungLine{"filter", "nearest", "textureFilter=nearest", Need::Relief},
    RungLine{"filter", "bilinear", "textureFilter=bilinear", Need::Relief},
    RungLine{"filter", "bicubic", "textureFilter=bicubic", Need::Relief},
    RungLine{"filter", "mip by speed", "textureFilter=mip", Need::Relief},

    RungLine{"gradient", "central", "textureGradient=central", Need::HeightMap},
    RungLine{"gradient", "precomputed", "textureGradient=precomputed", Need::HeightMap},
    RungLine{"gradient", "analytic", "textureGradient=analytic", Need::HeightMap},
    RungLine{"gradient", "bicubic, central", "textureFilter=bicubic textureGradient=central",
             Need::HeightMap},
    RungLine{"gradient", "bicubic, precomputed", "textureFilter=bicubic textureGradient=precomputed",
             Need::HeightMap},
    RungLine{"gradient", "bicubic, analytic", "textureFilter=bicubic textureGradient=analytic",
             Need::HeightMap},

    RungLine{"friction", "off", "friction=off"},
    RungLine{"friction", "Zilles", "friction=zilles"},
    RungLine{"friction", "Ho", "friction=ho"},
    RungLine{"friction", "elasto-plastic", "friction=elastoplastic"},

    RungLine{"tessellation", "flat", "forceShading=off"},
    RungLine{"tessellation", "direction", "forceShading=direction", Need::SmoothNormals},
    RungLine{"tessellation", "two-pass", "forceShading=twoPass", Need::SmoothNormals},
};

} // namespace

std::span<const Ladder> ladders() {
    return kLadders;
}

std::span<const RungLine> rungLines() {
    return kRungs;
}

std::span<const Product> products() {
    static const std::array kProducts{Product{"combination", {"contact", "budget", "shading"}}};
    return kProducts;
}

} // namespace touchstone::study
