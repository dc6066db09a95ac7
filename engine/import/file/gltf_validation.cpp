#include "engine/import/file/gltf_validation.h"

#include "engine/import/file/gltf_extensions.h"
#include "engine/import/file/gltf_flaws.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

namespace touchstone {
namespace {

using nlohmann::json;

void checkBufferViews(ImportContext& context, json& gltf) {
    if (!gltf.contains("bufferViews"))
        return;
    json& views = gltf["bufferViews"];
    for (size_t i = 0; i < views.size(); ++i) {
        if (views[i].value("byteStride", 1) == 0) {
            context.warn(element("bufferViews", i) + ".byteStride", "is 0; it is ignored");
            views[i].erase("byteStride");
        }
        const uint64_t offset = views[i].value("byteOffset", uint64_t{0}), length = views[i]["byteLength"];
        const uint64_t available = gltf["buffers"][views[i]["buffer"].get<size_t>()]["byteLength"];
        if (offset > available || length > available - offset)
            context.fail(element("bufferViews", i), "reaches to byte " + std::to_string(offset + length) +
                                                        " of a buffer of " + std::to_string(available) +
                                                        " bytes");
    }
}

/// Fails unless `number` elements fit into the buffer view. All values are below 2^53 / 2^31 / 2^8.
void checkRange(const ImportContext& context, const json& gltf, const std::string& place, size_t viewIndex,
                uint64_t offset, uint64_t number, ElementSize size, bool strided) {
    if (number == 0)
        return;
    const json& view = gltf["bufferViews"][viewIndex];
    const uint64_t length = view["byteLength"];
    const uint64_t stride = strided ? view.value("byteStride", size.step) : size.step;
    if (stride < size.bytes)
        context.fail(place, "its elements have " + std::to_string(size.bytes) +
                                " bytes, but the buffer view's byteStride is " + std::to_string(stride));
    const uint64_t needed = (number - 1) * stride + size.bytes;
    if (offset > length || needed > length - offset)
        context.fail(place, "reads to byte " + std::to_string(offset + needed) + " of a buffer view of " +
                                std::to_string(length) + " bytes");
}

void checkAccessors(ImportContext& context, const json& gltf) {
    if (!gltf.contains("accessors"))
        return;
    const json& accessors = gltf["accessors"];
    for (size_t i = 0; i < accessors.size(); ++i) {
        const json& accessor = accessors[i];
        const std::string place = element("accessors", i);
        const int componentType = accessor["componentType"];
        const std::string type = accessor["type"];
        const uint64_t number = accessor["count"];
        const ElementSize size = elementSize(type, componentType);
        if (componentCount(type) == 0)
            context.fail(place + ".type", "\"" + type.substr(0, 40) + "\" is no accessor type");
        if (size.bytes == 0)
            context.fail(place + ".componentType", std::to_string(componentType) + " is no component type");
        if (accessor.contains("bufferView"))
            checkRange(context, gltf, place, accessor["bufferView"],
                       accessor.value("byteOffset", uint64_t{0}), number, size, true);
        if (!accessor.contains("sparse"))
            continue;
        const json& sparse = accessor["sparse"];
        const json& indices = sparse["indices"];
        const json& values = sparse["values"];
        const uint64_t replaced = sparse["count"];
        if (replaced > number)
            context.fail(place + ".sparse.count", "replaces more elements than there are");
        const int indexType = indices["componentType"];
        if (indexType != 5121 && indexType != 5123 && indexType != 5125)
            context.fail(place + ".sparse.indices.componentType", "must be an unsigned integer type");
        checkRange(context, gltf, place + ".sparse.indices", indices["bufferView"],
                   indices.value("byteOffset", uint64_t{0}), replaced,
                   {componentBytes(indexType), componentBytes(indexType)}, false);
        checkRange(context, gltf, place + ".sparse.values", values["bufferView"],
                   values.value("byteOffset", uint64_t{0}), replaced, size, false);
    }
}

/// The parent of every node, -1 for roots. A child that its parent lists twice is removed from the second
/// place.
std::vector<int> parentsOf(ImportContext& context, json& nodes) {
    std::vector<int> parent(nodes.size(), -1);
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].contains("children"))
            continue;
        json& children = nodes[i]["children"];
        bool twice = false;
        for (size_t c = 0; c < children.size(); ++c) {
            const size_t child = children[c];
            const std::string place = element("nodes", i) + "." + element("children", c);
            if (parent[child] == static_cast<int>(i)) {
                context.warn(place, "nodes[" + std::to_string(child) + "] stands there twice");
                children[c] = nullptr; // null is never an index
                twice = true;
                continue;
            }
            if (parent[child] >= 0)
                context.fail(place, "nodes[" + std::to_string(child) + "] already has a parent, nodes[" +
                                        std::to_string(parent[child]) + "]");
            parent[child] = static_cast<int>(i);
        }
        if (twice)
            children.erase(std::remove(children.begin(), children.end(), json()), children.end());
    }
    return parent;
}

void warnOfScenes(ImportContext& context, const json& gltf, const std::vector<int>& parent) {
    const json none = json::array();
    const json& scenes = gltf.contains("scenes") ? gltf["scenes"] : none;
    for (size_t s = 0; s < scenes.size(); ++s) {
        std::unordered_set<size_t> seen;
        const json& roots = scenes[s].contains("nodes") ? scenes[s]["nodes"] : none;
        for (size_t r = 0; r < roots.size(); ++r) {
            const size_t node = roots[r];
            const std::string place = element("scenes", s) + "." + element("nodes", r);
            if (parent[node] >= 0)
                context.warn(place, "nodes[" + std::to_string(node) +
                                        "] is not a root: it is a child of nodes[" +
                                        std::to_string(parent[node]) + "] and stays where its parent is");
            if (!seen.insert(node).second)
                context.warn(place, "nodes[" + std::to_string(node) + "] stands there twice");
        }
    }
}

// Every node has at most one parent and no node is its own ancestor. With at most one parent each, a node
// that cannot be reached from a root lies on a loop or below one.
void checkNodes(ImportContext& context, json& gltf) {
    if (!gltf.contains("nodes"))
        return;
    json& nodes = gltf["nodes"];
    const std::vector<int> parent = parentsOf(context, nodes);
    std::vector<size_t> open;
    for (size_t i = 0; i < nodes.size(); ++i)
        if (parent[i] < 0)
            open.push_back(i);
    std::vector<bool> reached(nodes.size(), false);
    while (!open.empty()) {
        const size_t node = open.back();
        open.pop_back();
        reached[node] = true;
        for (const json& child : nodes[node].value("children", json::array()))
            open.push_back(child);
    }
    const auto stray = std::find(reached.begin(), reached.end(), false);
    if (stray != reached.end())
        context.fail(element("nodes", static_cast<size_t>(stray - reached.begin())) + ".children",
                     "the nodes form a loop");
    warnOfScenes(context, gltf, parent);
}

} // namespace

uint64_t componentBytes(int componentType) {
    switch (componentType) {
    case 5120:
    case 5121:
        return 1;
    case 5122:
    case 5123:
        return 2;
    case 5125:
    case 5126:
        return 4;
    default:
        return 0;
    }
}

int componentCount(const std::string& type) {
    static constexpr std::pair<std::string_view, int> kCounts[] = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, count] : kCounts)
        if (type == name)
            return count;
    return 0;
}

ElementSize elementSize(const std::string& type, int componentType) {
    const uint64_t bytes = componentBytes(componentType);
    const uint64_t columns = type == "MAT2" ? 2 : type == "MAT3" ? 3 : type == "MAT4" ? 4 : 0;
    if (columns == 0) {
        const uint64_t all = bytes * static_cast<uint64_t>(componentCount(type));
        return {all, all};
    }
    const uint64_t column = (columns * bytes + 3) / 4 * 4;
    return {(columns - 1) * column + columns * bytes, columns * column};
}

void validateGltf(ImportContext& context, json& gltf) {
    checkExtensions(context, gltf);
    checkBufferViews(context, gltf);
    checkAccessors(context, gltf);
    checkNodes(context, gltf);
    warnOfFlaws(context, gltf);
}

} // namespace touchstone
