#pragma once
// Materials of our scenes that bring a haptic program along.

#include "assets/glb_writer.h"

#include <glm/glm.hpp>

namespace touchstone::assets {

struct ProgramMaterial {
    const char* program; ///< a file of assets/programs
    glm::dvec3 colour;   ///< linear
    double metallic = 0.0, roughness = 0.6;
    Json haptic = Json::object(); ///< besides the program
    Json parameters = Json::object();
    Json texture = Json::object(); ///< persistentTexture; empty: none
};

/// The program is a buffer view of the file. Throws std::runtime_error where there is none of that name.
int addMaterial(GlbWriter& glb, const ProgramMaterial& material);

} // namespace touchstone::assets
