#include "engine/import/geometry/gltf_nodes.h"

#include <glm/gtc/type_ptr.hpp>

namespace touchstone {
namespace {

Node readNode(ImportContext& context, const tinygltf::Node& gltf, const std::string& place) {
    Node node;
    node.name = gltf.name;
    if (!gltf.translation.empty())
        node.translation = {gltf.translation[0], gltf.translation[1], gltf.translation[2]};
    if (!gltf.scale.empty())
        node.scale = {gltf.scale[0], gltf.scale[1], gltf.scale[2]};
    if (!gltf.rotation.empty()) {
        const glm::dquat stated(gltf.rotation[3], gltf.rotation[0], gltf.rotation[1], gltf.rotation[2]);
        const double length = glm::length(stated);
        if (length > 1e-6 && std::isfinite(length))
            node.rotation = stated / length;
        else
            context.warn(place + ".rotation", "is no rotation (a quaternion of length 0); left out");
        if (length > 1e-6 && std::abs(length - 1.0) > 1e-2)
            context.warn(place + ".rotation", "is not of unit length and was normalised");
    }
    if (!gltf.matrix.empty()) {
        if (!gltf.translation.empty() || !gltf.rotation.empty() || !gltf.scale.empty())
            context.warn(place, "has both a matrix and a translation, rotation or scale; the matrix is used");
        node.hasMatrix = true;
        node.matrix = glm::make_mat4(gltf.matrix.data());
        constexpr double kRounding = 1e-6; // of exporters that multiply in single precision
        const glm::dvec4 lastRow(node.matrix[0][3], node.matrix[1][3], node.matrix[2][3], node.matrix[3][3]);
        if (lastRow != glm::dvec4(0.0, 0.0, 0.0, 1.0)) {
            if (!(glm::distance(lastRow, glm::dvec4(0.0, 0.0, 0.0, 1.0)) < kRounding))
                context.fail(place + ".matrix", "is not affine: its last row is not 0, 0, 0, 1");
            context.warn(place + ".matrix", "has a last row that is 0, 0, 0, 1 only up to rounding");
            for (int column = 0; column < 4; ++column)
                node.matrix[column][3] = column == 3 ? 1.0 : 0.0;
        }
    }
    return node;
}

} // namespace

NodeForest readNodes(ImportContext& context, const GltfDocument& document) {
    const tinygltf::Model& model = document.model;
    NodeForest forest;
    forest.nodeOfGltf.assign(model.nodes.size(), -1);

    std::vector<bool> isChild(model.nodes.size(), false),
        isRootShown(model.nodes.size(), model.scenes.empty());
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children)
            isChild[static_cast<size_t>(child)] = true;
    if (!model.scenes.empty())
        for (const int root : model.scenes[static_cast<size_t>(std::max(model.defaultScene, 0))].nodes)
            isRootShown[static_cast<size_t>(root)] = true;

    // Depth first without recursion: a chain of a hundred thousand nodes is legal.
    struct Open {
        int gltf, parent;
        bool shown;
    };
    std::vector<Open> open;
    for (size_t i = model.nodes.size(); i-- > 0;)
        if (!isChild[i])
            open.push_back({static_cast<int>(i), -1, isRootShown[i]});
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        const tinygltf::Node& gltf = model.nodes[static_cast<size_t>(next.gltf)];
        const int index = static_cast<int>(forest.nodes.size());
        forest.nodes.push_back(readNode(context, gltf, element("nodes", static_cast<size_t>(next.gltf))));
        forest.nodes.back().parent = next.parent;
        forest.nodeOfGltf[static_cast<size_t>(next.gltf)] = index;
        forest.gltfOfNode.push_back(next.gltf);
        forest.shown.push_back(next.shown);
        for (size_t c = gltf.children.size(); c-- > 0;)
            open.push_back(
                {gltf.children[c], index, next.shown || isRootShown[static_cast<size_t>(gltf.children[c])]});
    }
    return forest;
}

} // namespace touchstone
