#pragma once
// Shapes on which a proxy solver is likely to err: grooves, corners, fans, slivers, sheets that pass through
// each other. In metres, about 0.1 m long.

#include "assets/shapes.h"

#include <string>
#include <vector>

namespace touchstone::test {

struct HardShape {
    std::string name;
    assets::Shape shape;
};

[[nodiscard]] std::vector<HardShape> hardShapes();

} // namespace touchstone::test
