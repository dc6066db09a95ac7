#include "assets/glb_writer.h"
#include "assets/picture.h"
#include "assets/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace touchstone::assets {

namespace {

constexpr size_t kTilesAcross = 5, kTilesDown = 2;
constexpr double kTileSide = 0.040, kTileGap = 0.004, kThickness = 0.012; // m
constexpr int kTileTexels = 256;                                          // 0.16 mm a texel
constexpr double kTurn = 2.0 * std::numbers::pi;

constexpr double kBumpHeight = 0.0006, kRibHeight = 0.0004, kTallRibHeight = 0.001,
                 kGrainHeight = 0.00015; // m

/// Round bumps 8 mm apart, flat between them.
double bumps(double u, double v) {
    const auto fromCentre = [](double t) { return 5.0 * t - std::floor(5.0 * t) - 0.5; };
    const double distance = std::min(1.0, 2.4 * std::hypot(fromCentre(u), fromCentre(v)));
    return 0.5 + 0.5 * std::cos(std::numbers::pi * distance);
}

/// Upright ribs, 4 mm apart.
double ribs(double u, double) {
    return 0.5 + 0.5 * std::sin(kTurn * 10.0 * u);
}

/// Grains of 0.4 to 1.2 mm.
double grains(double u, double v) {
    return 0.6 * tilingNoise(u, v, 32, 1) + 0.4 * tilingNoise(u, v, 80, 2);
}

/// Smooth stripes between two friction or stiffness values, 10 mm apart.
double stripes(double u, double) {
    return std::clamp(0.5 + 1.5 * std::sin(kTurn * 4.0 * u), 0.0, 1.0);
}

struct Swatch {
    const char* name;
    glm::ivec3 colour; ///< sRGB
    Json haptic;
    HeightFunction bump = {};        ///< empty: flat
    double reliefHeight = 0.0;       ///< m
    bool reliefAsHeight = false;     ///< tangible through a height map; otherwise through the normal map
                                     ///< alone
    const char* factorMap = nullptr; ///< the haptic field modulated by the stripes
    double factorMin = 0.0, factorMax = 0.0;
};

std::array<Swatch, kTilesAcross * kTilesDown> palette() {
    return {{
        {.name = "SLIPPERY",
         .colour = {150, 205, 225},
         .haptic = {{"staticFriction", 0.05}, {"dynamicFriction", 0.03}}},
        {.name = "GRIPPY",
         .colour = {205, 95, 75},
         .haptic = {{"staticFriction", 0.9}, {"dynamicFriction", 0.7}}},
        {.name = "SAND",
         .colour = {222, 196, 140},
         .haptic = {{"staticFriction", 0.4}, {"dynamicFriction", 0.35}},
         .bump = grains,
         .reliefHeight = kGrainHeight},
        {.name = "BUMPS",
         .colour = {140, 180, 110},
         .haptic = {{"staticFriction", 0.2}, {"dynamicFriction", 0.15}},
         .bump = bumps,
         .reliefHeight = kBumpHeight,
         .reliefAsHeight = true},
        {.name = "RIBS",
         .colour = {115, 150, 190},
         .haptic = {{"staticFriction", 0.2}, {"dynamicFriction", 0.15}, {"normalTextureInfluence", 0.0}},
         .bump = ribs,
         .reliefHeight = kRibHeight,
         .reliefAsHeight = true},
        {.name = "SOFT", .colour = {235, 175, 190}, .haptic = {{"stiffness", 120.0}, {"damping", 0.5}}},
        {.name = "HARD", .colour = {120, 120, 128}, .haptic = {{"stiffness", 1500.0}}},
        {.name = "VISCOUS",
         .colour = {170, 130, 185},
         .haptic = {{"stiffness", 500.0},
                    {"damping", 2.0},
                    {"staticFriction", 0.1},
                    {"dynamicFriction", 0.1},
                    {"viscousFriction", 4.0}}},
        {.name = "STRIPES",
         .colour = {230, 150, 80},
         .haptic = {{"staticFriction", 1.0}, {"dynamicFriction", 0.8}},
         .factorMap = "frictionTexture",
         .factorMin = 0.05,
         .factorMax = 1.0},
        {.name = "SPRINGS",
         .colour = {95, 175, 165},
         .haptic = {{"stiffness", 1200.0}},
         .factorMap = "stiffnessTexture",
         .factorMin = 0.15,
         .factorMax = 1.0},
    }};
}

int addSwatchMaterial(GlbWriter& glb, const Swatch& swatch) {
    const std::string name = swatch.name;
    const glm::ivec3 ink = swatch.colour / 3;
    Json material{
        {"name", name},
        {"pbrMetallicRoughness",
         {{"baseColorTexture", {{"index", glb.addTexture(name, png(label(name, 128, swatch.colour, ink)))}}},
          {"metallicFactor", 0.0},
          {"roughnessFactor", 0.6}}}};
    Json haptic = swatch.haptic;
    if (swatch.bump) {
        const int normals = glb.addTexture(
            name + ", normals", png(normalMap(swatch.bump, kTileTexels, kTileSide, swatch.reliefHeight)));
        material["normalTexture"] = {{"index", normals}};
    }
    if (swatch.reliefAsHeight)
        haptic["heightTexture"] = {
            {"index", glb.addTexture(name + ", heights", png(heightMap(swatch.bump, kTileTexels)))},
            {"scale", swatch.reliefHeight},
            {"midLevel", 0.0}};
    if (swatch.factorMap != nullptr)
        haptic[swatch.factorMap] = {
            {"index", glb.addTexture(name + ", factors", png(factorMap(stripes, 128)))},
            {"min", swatch.factorMin},
            {"max", swatch.factorMax}};
    material["extensions"]["TOUCHSTONE_materials_haptic"] = haptic;
    return glb.addMaterial(material);
}

/// Gap, tile, gap, tile, ..., gap, centred.
std::vector<double> cuts(size_t tiles) {
    std::vector<double> result;
    const auto count = static_cast<double>(tiles);
    const double start = -0.5 * (count * kTileSide + (count + 1.0) * kTileGap);
    for (double i = 0.0; i <= count; i += 1.0) {
        result.push_back(start + i * (kTileSide + kTileGap));
        result.push_back(start + i * (kTileSide + kTileGap) + kTileGap);
    }
    return result;
}

/// Primitives of one closed box whose front (+z) is cut into tiles, row by row from the upper left, and the
/// frame between them, each with its own material: a stroke between tiles meets no edge, only a change of
/// material. The first primitive is the frame.
std::vector<std::pair<Shape, int>> board(GlbWriter& glb, size_t columns, std::span<const Swatch> tiles) {
    const size_t rows = tiles.size() / columns;
    const std::vector<double> x = cuts(columns), y = cuts(rows), z{-0.5 * kThickness, 0.5 * kThickness};
    const Face front{2, 1.0, z[1], x, y};
    const auto isTile = [](size_t i, size_t j) { return i % 2 == 1 && j % 2 == 1; };
    const auto everywhere = [](size_t, size_t) { return true; };

    Shape frame;
    appendFace(frame, front, [&](size_t i, size_t j) { return !isTile(i, j); });
    appendFace(frame, Face{2, -1.0, z[0], x, y}, everywhere);
    for (const double sign : {-1.0, 1.0}) {
        appendFace(frame, Face{0, sign, sign < 0.0 ? x.front() : x.back(), y, z}, everywhere);
        appendFace(frame, Face{1, sign, sign < 0.0 ? y.front() : y.back(), z, x}, everywhere);
    }
    const int wood = glb.addMaterial({{"name", "board"},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorFactor", {0.10, 0.09, 0.08, 1.0}},
                                        {"metallicFactor", 0.0},
                                        {"roughnessFactor", 0.8}}}});
    std::vector<std::pair<Shape, int>> parts{{frame, wood}};
    for (size_t i = 0; i < tiles.size(); ++i) {
        // From the upper left, row by row; cell 2 i + 1 of the cuts is tile i, and y grows upwards.
        const size_t column = i % columns, rowFromBelow = rows - 1 - i / columns;
        Shape tile;
        appendCell(tile, front, 2 * column + 1, 2 * rowFromBelow + 1);
        tile.uv = {{0.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 0.0f}, {0.0f, 0.0f}};
        tile.tangents.assign(4, glm::vec4(1.0f, 0.0f, 0.0f, 1.0f));
        parts.emplace_back(tile, addSwatchMaterial(glb, tiles[i]));
    }
    return parts;
}

/// The tile that shading is felt on lies beneath a ridge of four flat facets, 21.8 degrees from one to the
/// next, whose vertex normals are those of the cylinder through its corners.
constexpr double kRidgeHeight = 0.008, kRidgeFoot = 0.003;         // m; the foot is in the board
constexpr double kRidgeMiddle = 0.5 * (kRidgeHeight - kRidgeFoot); // above its rim
constexpr uint32_t kRidgeFacets = 4;

/// Runs along y, as wide as a tile. A closed prism about the origin: the label's UVs on the facets.
Shape ridge() {
    constexpr double kHalf = 0.5 * kTileSide;
    constexpr double kRadius = (kHalf * kHalf + kRidgeHeight * kRidgeHeight) / (2.0 * kRidgeHeight);
    const double halfAngle = std::asin(kHalf / kRadius);
    std::vector<glm::dvec2> outline; // x, z, clockwise seen from -y
    std::vector<glm::dvec2> radial;
    for (uint32_t i = 0; i <= kRidgeFacets; ++i) {
        const double angle = halfAngle * (2.0 * i / kRidgeFacets - 1.0);
        radial.emplace_back(std::sin(angle), std::cos(angle));
        outline.emplace_back(kRadius * radial[i].x,
                             kRadius * radial[i].y - kRadius + kRidgeHeight - kRidgeMiddle);
    }
    outline.emplace_back(kHalf, -kRidgeFoot - kRidgeMiddle);
    outline.emplace_back(-kHalf, -kRidgeFoot - kRidgeMiddle);

    Shape shape;
    const auto vertex = [&](const glm::dvec2& at, double y, const glm::dvec3& normal) {
        shape.positions.emplace_back(at.x, y, at.y);
        shape.normals.emplace_back(normal);
        shape.uv.emplace_back(at.x / kTileSide + 0.5, 0.5 - y / kTileSide);
        return static_cast<uint32_t>(shape.positions.size() - 1);
    };
    const size_t corners = outline.size();
    for (size_t i = 0; i < corners; ++i) {
        const size_t next = (i + 1) % corners;
        const glm::dvec2 along = glm::normalize(outline[next] - outline[i]);
        const bool facet = i < kRidgeFacets;
        const auto normalAt = [&](size_t corner) {
            return facet ? glm::dvec3(radial[corner].x, 0.0, radial[corner].y)
                         : glm::dvec3(-along.y, 0.0, along.x);
        };
        const uint32_t a = vertex(outline[i], -kHalf, normalAt(i));
        const uint32_t b = vertex(outline[next], -kHalf, normalAt(next));
        const uint32_t c = vertex(outline[next], kHalf, normalAt(next));
        const uint32_t d = vertex(outline[i], kHalf, normalAt(i));
        shape.indices.insert(shape.indices.end(), {a, b, c, a, c, d});
    }
    for (const double side : {-1.0, 1.0}) {
        const auto first = static_cast<uint32_t>(shape.positions.size());
        for (const glm::dvec2& at : outline)
            vertex(at, side * kHalf, {0.0, side, 0.0});
        for (uint32_t i = 1; i + 1 < corners; ++i)
            shape.indices.insert(shape.indices.end(),
                                 {first, first + (side > 0.0 ? i : i + 1), first + (side > 0.0 ? i + 1 : i)});
    }
    return shape;
}

} // namespace

SceneFile swatches() {
    GlbWriter glb("swatches");
    glb.describe("ten materials side by side");
    glb.addNode("swatches", glb.addMesh("swatches", board(glb, kTilesAcross, palette())));
    return {"swatches.glb", glb.finish()};
}

SceneFile effects() {
    GlbWriter glb("effects");
    glb.describe("shading, texture and friction, a tile each");
    const Json smooth{{"staticFriction", 0.0}, {"dynamicFriction", 0.0}};
    Json ribbed = smooth;
    ribbed["normalTextureInfluence"] = 0.0;
    const std::array<Swatch, 3> tiles{{{.name = "SHADING", .colour = {205, 95, 75}, .haptic = smooth},
                                       {.name = "TEXTURE",
                                        .colour = {115, 150, 190},
                                        .haptic = ribbed,
                                        .bump = ribs,
                                        .reliefHeight = kTallRibHeight,
                                        .reliefAsHeight = true},
                                       {.name = "FRICTION",
                                        .colour = {222, 196, 140},
                                        .haptic = {{"staticFriction", 0.7}, {"dynamicFriction", 0.5}}}}};
    const auto parts = board(glb, tiles.size(), tiles);
    glb.addNode("board", glb.addMesh("board", parts));
    glb.addNode("ridge", glb.addMesh("ridge", ridge(), parts[1].second),
                {-(kTileSide + kTileGap), 0.0, 0.5 * kThickness + kRidgeMiddle});
    return {"effects.glb", glb.finish()};
}

} // namespace touchstone::assets
