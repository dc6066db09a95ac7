#include "tests/valid_files/node_parts.h"

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace touchstone::test {
namespace {

using nlohmann::json;

json listOf(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

glm::dquat anyRotation(Draw& draw) {
    const glm::dvec3 axis(draw.real(-1.0, 1.0), draw.real(-1.0, 1.0), draw.real(0.1, 1.0));
    return glm::angleAxis(draw.real(-3.1, 3.1), glm::normalize(axis));
}

/// Sizes that the recipe asks for; all of them at once multiply.
glm::dvec3 anyScale(FileDraft& draft) {
    Draw& draw = draft.draw;
    glm::dvec3 scale(1.0);
    if (draft.has(Feature::Transforms))
        scale *= draw.real(0.3, 3.0);
    if (draft.has(Feature::Uneven) || draft.has(Feature::Sheared))
        scale *= glm::dvec3(draw.real(0.1, 2.0), 1.0, draw.real(1.0, 10.0));
    if (draft.has(Feature::Mirrored) && draw.chance(0.7))
        scale *= draw.chance(0.5) ? glm::dvec3(-1.0, 1.0, 1.0) : glm::dvec3(-1.0);
    if (draft.has(Feature::TinyScale))
        scale *= draw.pick(std::vector{1e-3, 1e-6, 1e-9});
    if (draft.has(Feature::HugeScale))
        scale *= draw.pick(std::vector{1e3, 1e6, 1e9});
    if (draft.has(Feature::ZeroScale) && draw.chance(0.5))
        scale *= draw.chance(0.5) ? glm::dvec3(0.0) : glm::dvec3(1.0, 0.0, 1.0);
    return scale;
}

json transformed(FileDraft& draft) {
    Draw& draw = draft.draw;
    const bool moves = draft.has(Feature::Transforms);
    const glm::dvec3 translation =
        moves ? glm::dvec3(draw.real(-0.2, 0.2), draw.real(-0.2, 0.2), draw.real(-0.2, 0.2))
              : glm::dvec3(0.0);
    const glm::dquat rotation =
        moves || draft.has(Feature::Sheared) ? anyRotation(draw) : glm::dquat(1.0, 0.0, 0.0, 0.0);
    const glm::dvec3 scale = anyScale(draft);
    json node = json::object();
    if (draft.has(Feature::MatrixNodes) && draw.chance(0.6)) {
        const glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), translation) * glm::mat4_cast(rotation) *
                                  glm::scale(glm::dmat4(1.0), scale);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r)
                node["matrix"].push_back(matrix[c][r]);
        return node;
    }
    if (moves)
        node["translation"] = listOf(translation);
    if (moves || draft.has(Feature::Sheared))
        node["rotation"] = {rotation.x, rotation.y, rotation.z, rotation.w};
    if (scale != glm::dvec3(1.0))
        node["scale"] = listOf(scale);
    return node;
}

/// Two to four joints below one another, beside the mesh.
void addSkin(FileDraft& draft, size_t node, json& roots) {
    Draw& draw = draft.draw;
    json joints = json::array();
    Column inverses{"MAT4", kFloat, false, {}, false};
    size_t above = 0;
    for (size_t j = 0; j < 4; ++j) {
        json joint = {{"name", "joint"}};
        if (draw.chance(0.7)) {
            const glm::dquat turn = anyRotation(draw);
            joint["rotation"] = {turn.x, turn.y, turn.z, turn.w};
            joint["translation"] = {0.0, draw.real(0.0, 0.05), 0.0};
        }
        const size_t index = draft.maker.append("nodes", joint);
        if (j == 0)
            roots.push_back(index);
        else
            draft.maker.json["nodes"][above]["children"].push_back(index);
        above = index;
        joints.push_back(index);
        for (int i = 0; i < 16; ++i)
            inverses.values.push_back(i % 5 == 0 ? 1.0 : i == 13 ? draw.real(-0.1, 0.0) : 0.0);
    }
    json skin = {{"joints", joints}};
    if (draw.chance(0.7))
        skin["inverseBindMatrices"] = writeColumn(draft, inverses);
    if (draw.chance(0.3))
        skin["skeleton"] = joints[0];
    draft.maker.json["nodes"][node]["skin"] = draft.maker.append("skins", skin);
}

void addInstances(FileDraft& draft, size_t node) {
    Draw& draw = draft.draw;
    const size_t count = 1 + draw.below(5);
    Column translation{"VEC3", kFloat, false, {}, false}, rotation{"VEC4", kFloat, false, {}, false},
        scale = translation;
    rotation.componentType = draw.pick(std::vector{kFloat, kByte, kShort});
    rotation.normalized = rotation.componentType != kFloat;
    for (size_t i = 0; i < count; ++i) {
        const glm::dquat turn = anyRotation(draw);
        rotation.values.insert(rotation.values.end(), {turn.x, turn.y, turn.z, turn.w});
        for (int c = 0; c < 3; ++c) {
            translation.values.push_back(draw.real(-0.3, 0.3));
            scale.values.push_back(draw.chance(0.1) ? -1.0 : draw.real(0.2, 2.0));
        }
    }
    json attributes = {{"TRANSLATION", writeColumn(draft, translation)}};
    if (draw.chance(0.7))
        attributes["ROTATION"] = writeColumn(draft, rotation);
    if (draw.chance(0.7))
        attributes["SCALE"] = writeColumn(draft, scale);
    draft.use("EXT_mesh_gpu_instancing", draw.chance(0.3));
    draft.maker.json["nodes"][node]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", attributes}};
}

/// Nodes above it, and what the features hang beside and below it. Returns the root.
size_t nested(FileDraft& draft, size_t node) {
    Draw& draw = draft.draw;
    size_t levels = draft.has(Feature::DeepNesting) ? draw.pick(std::vector<size_t>{3, 40, 300}) : 0;
    if (draft.has(Feature::Sheared))
        ++levels;
    for (size_t i = 0; i < levels; ++i) {
        // Few levels scale: hundreds that do would leave what numbers can hold.
        json parent = i < 2 ? transformed(draft) : json{{"translation", {1e-4, 0.0, 0.0}}};
        parent["children"] = {node};
        if (draft.has(Feature::EmptyNodes) && draw.chance(0.3))
            parent["children"].push_back(draft.maker.append("nodes", {{"name", "empty"}}));
        node = draft.maker.append("nodes", parent);
    }
    return node;
}

void addScenes(FileDraft& draft, const json& roots) {
    json& file = draft.maker.json;
    if (draft.has(Feature::NoScene))
        return;
    if (draft.has(Feature::OtherScenes)) {
        file["scenes"] = {{{"name", "empty"}}, {{"nodes", roots}}, {{"nodes", {roots[0]}}}};
        file["scene"] = 1;
        return;
    }
    file["scenes"] = {{{"nodes", roots}}};
    if (draft.draw.chance(0.7))
        file["scene"] = 0;
}

/// Times and values of one channel.
json samplerOf(FileDraft& draft, const std::string& path, size_t targets) {
    Draw& draw = draft.draw;
    const bool cubic = draft.has(Feature::Cubic) && draw.chance(0.5),
               step = draft.has(Feature::Steps) && draw.chance(0.5);
    const size_t keys = (cubic ? 2u : 1u) + draw.below(5);
    Column times, values;
    values.type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    double time = draw.chance(0.5) ? 0.0 : draw.real(0.0, 0.1);
    times.bounds = true;
    for (size_t k = 0; k < keys; ++k) {
        times.values.push_back(time);
        time += draw.real(0.02, 0.3);
    }
    const bool fractions =
        draft.has(Feature::NormalizedKeys) && (path == "rotation" || path == "weights") && !cubic;
    if (fractions) {
        values.componentType = path == "rotation" ? draw.pick(std::vector{kByte, kShort})
                                                  : draw.pick(std::vector{kUByte, kUShort});
        values.normalized = true;
    }
    for (size_t k = 0; k < keys; ++k)
        for (size_t part = 0; part < (cubic ? 3u : 1u); ++part) {
            if (path == "rotation") {
                const glm::dquat turn =
                    cubic && part != 1 ? glm::dquat(0.1, 0.2, -0.3, 0.0) : anyRotation(draw);
                values.values.insert(values.values.end(), {turn.x, turn.y, turn.z, turn.w});
                continue;
            }
            for (size_t c = 0; c < (path == "weights" ? targets : 3); ++c)
                values.values.push_back(path == "translation" ? draw.real(-0.1, 0.1)
                                        : path == "scale" ? (draw.chance(0.1) ? 0.0 : draw.real(-0.5, 2.0))
                                                          : draw.real(0.0, 1.0));
        }
    json sampler = {{"input", writeColumn(draft, times)}, {"output", writeColumn(draft, values)}};
    if (cubic || step)
        sampler["interpolation"] = cubic ? "CUBICSPLINE" : "STEP";
    else if (draw.chance(0.5))
        sampler["interpolation"] = "LINEAR";
    return sampler;
}

} // namespace

void addNodes(FileDraft& draft) {
    Draw& draw = draft.draw;
    json& file = draft.maker.json;
    json roots = json::array();
    const size_t meshes = file["meshes"].size();
    for (size_t m = 0; m < meshes; ++m)
        for (size_t copies = draft.has(Feature::Instances) ? 1 + draw.below(3) : 1; copies > 0; --copies) {
            json node = transformed(draft);
            node["mesh"] = m;
            if (draft.morphs.contains(m) && draw.chance(0.5))
                for (size_t t = 0; t < draft.morphs[m]; ++t)
                    node["weights"].push_back(draw.real(-0.5, 1.0));
            const size_t index = draft.maker.append("nodes", node);
            draft.meshNodes.push_back(index);
            if (draft.has(Feature::Skin))
                addSkin(draft, index, roots);
            else if (draft.has(Feature::GpuInstances))
                addInstances(draft, index);
            roots.push_back(nested(draft, index));
        }
    if (draft.has(Feature::EmptyNodes)) {
        file["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.01}}}}};
        roots.push_back(draft.maker.append("nodes", {{"camera", 0}}));
        roots.push_back(draft.maker.append("nodes", json::object()));
    }
    addScenes(draft, roots);
}

void addAnimations(FileDraft& draft) {
    std::vector<std::string> paths;
    for (const auto& [feature, path] : {std::pair{Feature::Translations, "translation"},
                                        {Feature::Rotations, "rotation"},
                                        {Feature::Scales, "scale"},
                                        {Feature::Weights, "weights"}})
        if (draft.has(feature))
            paths.emplace_back(path);
    const json nodes = draft.maker.json["nodes"];
    for (size_t count = paths.empty() ? 0 : 1 + draft.draw.below(2); count > 0; --count) {
        json animation = {{"channels", json::array()}, {"samplers", json::array()}};
        for (size_t n = 0; n < nodes.size() && n < 12; ++n)
            for (const std::string& path : paths) {
                const size_t targets = nodes[n].contains("mesh") && draft.morphs.contains(nodes[n]["mesh"])
                                           ? draft.morphs[nodes[n]["mesh"]]
                                           : 0;
                if (nodes[n].contains("matrix") || (path == "weights" && targets == 0) ||
                    draft.draw.chance(0.3))
                    continue;
                json target = {{"path", path}};
                if (draft.draw.chance(0.95)) // without a node the channel is to be ignored
                    target["node"] = n;
                animation["channels"].push_back(
                    {{"sampler", animation["samplers"].size()}, {"target", target}});
                animation["samplers"].push_back(samplerOf(draft, path, targets));
            }
        if (!animation["channels"].empty())
            draft.maker.append("animations", std::move(animation));
    }
}

} // namespace touchstone::test
