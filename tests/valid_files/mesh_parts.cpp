#include "tests/valid_files/mesh_parts.h"

#include "tests/valid_files/shape_parts.h"

#include <cmath>
#include <numeric>

namespace touchstone::test {
namespace {

using nlohmann::json;
using Columns = std::map<std::string, Column>;

template <class Vector>
std::vector<double> flat(const std::vector<Vector>& vectors) {
    std::vector<double> values;
    for (const Vector& v : vectors)
        for (int c = 0; c < Vector::length(); ++c)
            values.push_back(v[c]);
    return values;
}

/// One of the types for fractions of 0..1: float, or normalized unsigned integers.
void fractionType(Draw& draw, Column& column) {
    column.componentType = draw.pick(std::vector{kFloat, kUByte, kUShort});
    column.normalized = column.componentType != kFloat;
}

Column perVertex(Draw& draw, size_t count, double low, double high) {
    Column column;
    const bool constant = draw.chance(0.2), zero = draw.chance(0.1);
    const double value = draw.real(low, high);
    for (size_t v = 0; v < count; ++v)
        column.values.push_back(zero ? 0.0 : constant ? value : draw.real(low, high));
    return column;
}

std::vector<double> tangentsOf(Draw& draw, const RawShape& shape) {
    std::vector<double> values;
    for (const glm::dvec3& n : shape.normals) {
        const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
        const glm::dvec3 t = glm::normalize(axis - glm::dot(axis, n) * n);
        values.insert(values.end(), {t.x, t.y, t.z, draw.chance(0.8) ? 1.0 : -1.0});
    }
    return values;
}

/// KHR_mesh_quantization: integers where the core has floats, normalized or not.
void quantize(FileDraft& draft, const RawShape& shape, Columns& columns) {
    draft.use("KHR_mesh_quantization", true);
    Draw& draw = draft.draw;
    Column& positions = columns["POSITION"];
    positions.componentType = draw.pick(std::vector{kByte, kUByte, kShort, kUShort});
    positions.normalized = draw.chance(0.5);
    const bool sign = positions.componentType == kByte || positions.componentType == kShort;
    const double wide = positions.normalized                                                    ? 1.0
                        : positions.componentType == kByte || positions.componentType == kUByte ? 100.0
                                                                                                : 30000.0;
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const uint32_t index : shape.indices) { // strays would leave one step for all the rest
        low = glm::min(low, shape.positions[index]);
        high = glm::max(high, shape.positions[index]);
    }
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    for (size_t i = 0; i < positions.values.size(); ++i) {
        const double share =
            (positions.values[i] - low[static_cast<int>(i % 3)]) / (extent > 0.0 ? extent : 1.0);
        positions.values[i] = wide * (sign ? 2.0 * share - 1.0 : share);
    }
    for (const char* name : {"NORMAL", "TANGENT"})
        if (columns.contains(name)) {
            columns[name].componentType = draw.pick(std::vector{kByte, kShort});
            columns[name].normalized = true;
        }
}

void addCoordinates(FileDraft& draft, const RawShape& shape, Columns& columns) {
    for (const int set : {0, 1}) {
        if (!draft.has(set == 0 ? Feature::Uv0 : Feature::Uv1))
            continue;
        Column column{"VEC2", kFloat, false, flat(shape.uv), false};
        if (set == 1)
            for (double& value : column.values)
                value = 3.0 * value - 0.7;
        if (draft.has(Feature::NormalizedUv)) {
            fractionType(draft.draw, column);
            if (column.normalized)
                for (double& value : column.values)
                    value -= std::floor(value);
        }
        columns["TEXCOORD_" + std::to_string(set)] = column;
    }
}

/// TOUCHSTONE's own and application-specific attributes, and sets that nothing here reads.
void addScalars(FileDraft& draft, const RawShape& shape, Columns& columns) {
    const size_t count = shape.positions.size();
    Draw& draw = draft.draw;
    if (draft.has(Feature::VertexStiffness))
        columns["_STIFFNESS"] = perVertex(draw, count, 50.0, 3000.0);
    if (draft.has(Feature::VertexDamping))
        columns["_DAMPING"] = perVertex(draw, count, 0.0, 3.0);
    if (draft.has(Feature::VertexFriction))
        columns["_FRICTION"] = perVertex(draw, count, 0.0, 1.5);
    if (draft.has(Feature::VertexHeight))
        columns["_HEIGHT"] = perVertex(draw, count, -0.01 * shape.size, 0.02 * shape.size);
    if (!draft.has(Feature::OtherAttributes))
        return;
    columns["_TEMPERATURE"] = perVertex(draw, count, -1e6, 1e6);
    columns["_ID"] = {"SCALAR", kUShort, false, perVertex(draw, count, 0.0, 65535.0).values, false};
    for (const char* name : {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"})
        columns.try_emplace(name, Column{"VEC2", kFloat, false, flat(shape.uv), false});
}

void addColors(FileDraft& draft, size_t count, Columns& columns) {
    const size_t components = draft.draw.chance(0.5) ? 3 : 4;
    for (const char* name : {"COLOR_0", "COLOR_1"}) {
        if (name == std::string("COLOR_1") && !draft.has(Feature::OtherAttributes))
            continue;
        Column column = perVertex(draft.draw, count * components, 0.0, 1.0);
        column.type = components == 3 ? "VEC3" : "VEC4";
        fractionType(draft.draw, column);
        columns[name] = column;
    }
}

/// One or two sets of four joints whose weights add up to one, exactly where they are integers.
void addSkinning(FileDraft& draft, size_t count, Columns& columns) {
    Draw& draw = draft.draw;
    const bool second = draw.chance(0.3);
    for (const int set : {0, 1}) {
        if (set == 1 && !second)
            continue;
        Column joints{"VEC4", draw.pick(std::vector{kUByte, kUShort}), false, {}, false};
        Column weights{"VEC4", kFloat, false, {}, false};
        fractionType(draw, weights);
        const double full = weights.componentType == kUByte    ? 255.0
                            : weights.componentType == kUShort ? 65535.0
                                                               : 256.0;
        for (size_t v = 0; v < count; ++v) {
            // Both sets together weigh one: the first three quarters of it, where there is a second.
            const double all =
                second ? (set == 0 ? std::floor(0.75 * full) : full - std::floor(0.75 * full)) : full;
            const double first = std::floor(draw.real(0.0, 1.0) * all);
            joints.values.insert(joints.values.end(), {2.0 * set, 2.0 * set + 1.0, 0.0, 0.0});
            weights.values.insert(weights.values.end(), {first / full, (all - first) / full, 0.0, 0.0});
        }
        columns["JOINTS_" + std::to_string(set)] = joints;
        columns["WEIGHTS_" + std::to_string(set)] = weights;
    }
}

Columns vertexColumns(FileDraft& draft, const RawShape& shape) {
    Columns columns;
    columns["POSITION"] = {"VEC3", kFloat, false, flat(shape.positions), true};
    if (draft.has(Feature::Normals))
        columns["NORMAL"] = {"VEC3", kFloat, false, flat(shape.normals), false};
    if (draft.has(Feature::Tangents))
        columns["TANGENT"] = {"VEC4", kFloat, false, tangentsOf(draft.draw, shape), false};
    addCoordinates(draft, shape, columns);
    addScalars(draft, shape, columns);
    if (draft.has(Feature::Colors))
        addColors(draft, shape.positions.size(), columns);
    if (draft.has(Feature::Skin))
        addSkinning(draft, shape.positions.size(), columns);
    if (draft.has(Feature::QuantizedGeometry))
        quantize(draft, shape, columns);
    return columns;
}

/// Every vertex once a corner: what a primitive without indices draws.
RawShape exploded(const RawShape& shape) {
    RawShape all = shape;
    all.positions.clear();
    all.normals.clear();
    all.uv.clear();
    for (const uint32_t index : shape.indices) {
        all.positions.push_back(shape.positions[index]);
        all.normals.push_back(shape.normals[index]);
        all.uv.push_back(shape.uv[index]);
    }
    all.indices.resize(shape.indices.size());
    std::iota(all.indices.begin(), all.indices.end(), 0u);
    return all;
}

/// Displacements for each of the mesh's targets.
json targetsOf(FileDraft& draft, const RawShape& shape, size_t count) {
    json targets = json::array();
    for (size_t t = 0; t < count; ++t) {
        Columns columns;
        const auto displaced = [&](const char* name, double reach, bool bounds) {
            Column column = perVertex(draft.draw, 3 * shape.positions.size(), -reach, reach);
            column.type = "VEC3";
            column.bounds = bounds;
            columns[name] = column;
        };
        if (t == 0 || draft.draw.chance(0.8))
            displaced("POSITION", 0.1 * shape.size, true);
        if (draft.has(Feature::Normals) && draft.draw.chance(0.7))
            displaced("NORMAL", 0.2, false);
        if (draft.has(Feature::Tangents) && draft.draw.chance(0.5))
            displaced("TANGENT", 0.2, false);
        if (columns.empty())
            displaced("POSITION", 0.1 * shape.size, true);
        targets.push_back(writeVertices(draft, columns));
    }
    return targets;
}

json primitiveOf(FileDraft& draft, const json& attributes, const std::vector<uint32_t>& indices, int mode) {
    json primitive = {{"attributes", attributes}};
    if (!indices.empty())
        primitive["indices"] = writeIndices(draft, indices);
    if (mode != 4 || draft.draw.chance(0.3))
        primitive["mode"] = mode;
    if (!draft.materials.empty() && draft.draw.chance(0.95))
        primitive["material"] = draft.draw.pick(draft.materials);
    return primitive;
}

void addTriangles(FileDraft& draft, const RawShape& shape, const json& attributes, json& primitives) {
    if (draft.has(Feature::NoIndices)) {
        std::vector<int> modes{4};
        if (draft.has(Feature::Strip))
            modes.push_back(5);
        if (draft.has(Feature::Fan))
            modes.push_back(6);
        primitives.push_back(primitiveOf(draft, attributes, {}, draft.draw.pick(modes)));
        return;
    }
    if (draft.has(Feature::Strip) && draft.draw.chance(0.7)) {
        primitives.push_back(primitiveOf(draft, attributes, shape.indices, 5));
        return;
    }
    if (draft.has(Feature::Fan) && draft.draw.chance(0.7)) {
        const size_t corners = std::min<size_t>(shape.indices.size(), 3 + draft.draw.below(20));
        primitives.push_back(primitiveOf(
            draft, attributes,
            {shape.indices.begin(), shape.indices.begin() + static_cast<std::ptrdiff_t>(corners)}, 6));
        return;
    }
    // Triangles of one surface shared out among primitives: their materials meet at its edges and corners.
    const size_t parts = draft.has(Feature::SeveralPrimitives) ? 2 + draft.draw.below(3) : 1;
    std::vector<std::vector<uint32_t>> shares(parts);
    for (size_t t = 0; t + 2 < shape.indices.size(); t += 3) {
        auto& share = shares[draft.draw.below(parts)];
        share.insert(share.end(), &shape.indices[t], &shape.indices[t] + 3);
    }
    for (const auto& share : shares)
        if (!share.empty())
            primitives.push_back(primitiveOf(draft, attributes, share, 4));
}

} // namespace

size_t addMesh(FileDraft& draft) {
    RawShape shape = drawShape(draft);
    if (draft.has(Feature::NoIndices))
        shape = exploded(shape);
    const json attributes = writeVertices(draft, vertexColumns(draft, shape));
    json primitives = json::array();
    addTriangles(draft, shape, attributes, primitives);
    if (draft.has(Feature::PointsAndLines))
        for (const int mode : {0, 1, 2, 3}) {
            const auto last = static_cast<uint32_t>(shape.positions.size() - 1);
            primitives.push_back(primitiveOf(draft, attributes, {0, 1, last, 1}, mode));
        }
    if (draft.has(Feature::NoPositions) && !draft.has(Feature::Skin))
        primitives.push_back(
            {{"attributes",
              {{"_FRICTION",
                writeVertices(draft, {{"_FRICTION", perVertex(draft.draw, 3, 0.0, 1.0)}})["_FRICTION"]}}}});
    json mesh = {{"name", "mesh"}};
    const size_t index = draft.maker.json.contains("meshes") ? draft.maker.json["meshes"].size() : 0;
    if (draft.has(Feature::Morph) && !draft.has(Feature::NoPositions)) {
        const size_t targets = 1 + draft.draw.below(3);
        draft.morphs[index] = targets;
        const json stated = targetsOf(draft, shape, targets);
        for (json& primitive : primitives)
            primitive["targets"] = stated;
        if (draft.draw.chance(0.7))
            for (size_t t = 0; t < targets; ++t)
                mesh["weights"].push_back(draft.draw.real(-0.5, 1.0));
    }
    mesh["primitives"] = std::move(primitives);
    return draft.maker.append("meshes", std::move(mesh));
}

} // namespace touchstone::test
