#include "assets/cut_torus.h"
#include "assets/glb_writer.h"
#include "assets/scenes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchstone::assets {

namespace {

Json paint(const char* name, double red, double green, double blue, bool doubleSided = false) {
    Json material{
        {"name", name},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {red, green, blue, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.5}}}};
    if (doubleSided)
        material["doubleSided"] = true;
    return material;
}

SceneFile bare(const std::string& name, const Shape& shape, const Json& material, const std::string& line,
               Packing packing = Packing::Plain) {
    GlbWriter glb(name, packing);
    if (!line.empty())
        glb.describe(line);
    glb.addNode(name, glb.addMesh(name, shape, glb.addMaterial(material)));
    return {name + ".glb", glb.finish()};
}

Shape withoutTexture(Shape shape) {
    shape.uv.clear();
    shape.tangents.clear();
    return shape;
}

/// The integer from `least` up whose square times `perSquare` is nearest to `triangles`.
uint32_t side(size_t triangles, double perSquare, uint32_t least) {
    const double exact = std::sqrt(static_cast<double>(triangles) / perSquare);
    return std::max(least, static_cast<uint32_t>(std::lround(exact)));
}

Shape tessellated(const std::string& shape, size_t triangles) {
    if (shape == "torus")
        return torus(0.060, 0.025, side(triangles, 2.0, 3), side(triangles, 2.0, 3));
    if (shape == "sphere")
        return sphere(0.050, side(triangles, 2.0, 3), side(triangles, 2.0, 3));
    if (shape == "box")
        return box(glm::dvec3(0.1), side(triangles, 12.0, 1));
    if (shape == "plane")
        return withoutTexture(plane(0.15, 0.15, side(triangles, 2.0, 1), side(triangles, 2.0, 1)));
    if (shape == "prism") {
        const double rows = (static_cast<double>(triangles) - 20.0) / 20.0;
        return prism(10, 0.050, 0.15, false, static_cast<uint32_t>(std::max(1L, std::lround(rows))));
    }
    throw std::invalid_argument("unknown shape \"" + shape +
                                "\": torus, sphere, box, plane and prism are known");
}

} // namespace

std::vector<SceneFile> tableOneObjects() {
    return {
        bare("table1_object1", boxWithSharedCorners(glm::dvec3(0.1)), paint("object 1", 0.25, 0.45, 0.70),
             "a cube of 12 triangles"),
        bare("table1_object2", tableOneRing(), paint("object 2", 0.30, 0.60, 0.40),
             "a ring of 456 triangles, cut open along 11 edges"),
        bare("table1_object3", sphere(0.050, 30, 30), paint("object 3", 0.75, 0.60, 0.25),
             "a ball of 1,800 triangles"),
        bare("table1_object4", sphere(0.050, 180, 180), paint("object 4", 0.65, 0.35, 0.55),
             "a ball of 64,800 triangles", Packing::Meshopt),
    };
}

std::vector<SceneFile> plainShapes() {
    const Json slate = paint("slate", 0.40, 0.47, 0.53);
    return {
        bare("torus_64800", torus(0.060, 0.025, 180, 180), slate, "64,800 triangles, smooth",
             Packing::Meshopt),
        bare("prism_flat", prism(10, 0.050, 0.15, false), slate, "ten sides, facets felt"),
        bare("prism_smooth", prism(10, 0.050, 0.15, true), slate, "ten sides, shaded round"),
        bare("plane", plane(0.15, 0.15), paint("slate", 0.40, 0.47, 0.53, true), "one flat square"),
        bare("box", box(glm::dvec3(0.1)), slate, "flat faces, edges, corners"),
    };
}

SceneFile bareShape(const std::string& shape, size_t triangles) {
    if (triangles < 2 || triangles > 20'000'000)
        throw std::invalid_argument("between 2 and 20,000,000 triangles can be made");
    return bare(shape, tessellated(shape, triangles), paint("slate", 0.40, 0.47, 0.53), "");
}

std::vector<SceneFile> allScenes() {
    std::vector<SceneFile> scenes{doughnut()};
    for (auto family : {tableOneObjects(), plainShapes(), bodies()})
        scenes.insert(scenes.end(), std::make_move_iterator(family.begin()),
                      std::make_move_iterator(family.end()));
    scenes.push_back(swatches());
    scenes.push_back(effects());
    scenes.push_back(moving());
    scenes.push_back(breathing());
    scenes.push_back(jellyDoughnut());
    scenes.push_back(cloth());
    scenes.push_back(jelly());
    scenes.push_back(virtualBump());
    scenes.push_back(fieldTorus());
    scenes.push_back(materials());
    scenes.push_back(wood());
    scenes.push_back(programs());
    scenes.push_back(surfaces());
    scenes.push_back(heights());
    scenes.push_back(plaque());
    scenes.push_back(mapped());
    return scenes;
}

} // namespace touchstone::assets
