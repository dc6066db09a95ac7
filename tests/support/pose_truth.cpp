#include "tests/support/pose_truth.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>

namespace touchstone::test {
namespace {

using nlohmann::json;
Affine parentFromNode(const json& node) {
    if (node.contains("matrix"))
        return fromColumns(node["matrix"].get<std::vector<Real>>());
    return fromTrs(node.value("translation", Real3{0, 0, 0}),
                   node.value("rotation", std::array<Real, 4>{0, 0, 0, 1}),
                   node.value("scale", Real3{1, 1, 1}));
}

/// The numbers of an accessor, `width` for each element.
struct Values {
    size_t width = 0, count = 0;
    std::vector<Real> all;
    [[nodiscard]] Real at(size_t element, size_t component) const { return all[element * width + component]; }
};

class Evaluation {
  public:
    explicit Evaluation(const TruthFile& file) : file_(file), json_(file.json) {}

    std::vector<TruthObject> run() {
        const json& nodes = json_["nodes"];
        sceneFromNode_.assign(nodes.size(), kIdentity);
        std::vector<bool> isChild(nodes.size(), false);
        for (const json& node : nodes)
            for (const json& child : node.value("children", json::array()))
                isChild[child.get<size_t>()] = true;
        for (size_t n = 0; n < nodes.size(); ++n)
            if (!isChild[n])
                descend(n, kIdentity, [](size_t) {});
        for (const json& root : json_["scenes"][json_.value("scene", size_t{0})]["nodes"])
            descend(root, kIdentity, [this](size_t node) { show(node); });
        return std::move(objects_);
    }

    [[nodiscard]] std::vector<Real> numbers(size_t accessor) const { return read(accessor).all; }

  private:
    void descend(size_t node, const Affine& sceneFromParent, const auto& visit) {
        sceneFromNode_[node] = sceneFromParent * parentFromNode(json_["nodes"][node]);
        visit(node);
        for (const json& child : json_["nodes"][node].value("children", json::array()))
            descend(child, sceneFromNode_[node], visit);
    }

    [[nodiscard]] Real number(const uint8_t* bytes, int type, bool normalized) const {
        const auto as = [&](auto sample, Real largest) {
            std::memcpy(&sample, bytes, sizeof sample);
            const Real value = static_cast<Real>(sample);
            return normalized ? std::max(value / largest, Real(-1)) : value;
        };
        switch (type) {
        case 5120:
            return as(int8_t{}, 127);
        case 5121:
            return as(uint8_t{}, 255);
        case 5122:
            return as(int16_t{}, 32767);
        case 5123:
            return as(uint16_t{}, 65535);
        case 5125:
            return as(uint32_t{}, 4294967295.0L);
        default:
            return as(float{}, 1);
        }
    }

    static size_t bytesOf(int type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

    [[nodiscard]] const uint8_t* viewBytes(const json& view) const {
        return file_.buffers.at(view["buffer"].get<size_t>()).data() + view.value("byteOffset", size_t{0});
    }

    [[nodiscard]] Values read(size_t index) const {
        static const std::map<std::string, size_t> kWidths = {
            {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
        const json& accessor = json_["accessors"][index];
        const int type = accessor["componentType"];
        const bool normalized = accessor.value("normalized", false);
        Values values;
        values.width = kWidths.at(accessor["type"]);
        values.count = accessor["count"];
        values.all.assign(values.width * values.count, 0);
        const auto take = [&](size_t element, const uint8_t* from) {
            for (size_t c = 0; c < values.width; ++c)
                values.all[element * values.width + c] = number(from + c * bytesOf(type), type, normalized);
        };
        const size_t packed = values.width * bytesOf(type);
        if (accessor.contains("bufferView")) {
            const json& view = json_["bufferViews"][accessor["bufferView"].get<size_t>()];
            const uint8_t* from = viewBytes(view) + accessor.value("byteOffset", size_t{0});
            for (size_t i = 0; i < values.count; ++i)
                take(i, from + i * view.value("byteStride", packed));
        }
        if (accessor.contains("sparse")) {
            const json& sparse = accessor["sparse"];
            const int indexType = sparse["indices"]["componentType"];
            const uint8_t* indices =
                viewBytes(json_["bufferViews"][sparse["indices"]["bufferView"].get<size_t>()]) +
                sparse["indices"].value("byteOffset", size_t{0});
            const uint8_t* replaced =
                viewBytes(json_["bufferViews"][sparse["values"]["bufferView"].get<size_t>()]) +
                sparse["values"].value("byteOffset", size_t{0});
            for (size_t i = 0; i < sparse["count"].get<size_t>(); ++i)
                take(static_cast<size_t>(number(indices + i * bytesOf(indexType), indexType, false)),
                     replaced + i * packed);
        }
        return values;
    }

    /// Base attribute plus weighted displacements; empty if there is none.
    [[nodiscard]] Values morphed(const json& primitive, const char* name,
                                 const std::vector<Real>& weights) const {
        if (!primitive["attributes"].contains(name))
            return {};
        Values base = read(primitive["attributes"][name]);
        const json targets = primitive.value("targets", json::array());
        for (size_t t = 0; t < targets.size() && t < weights.size(); ++t) {
            if (!targets[t].contains(name))
                continue;
            const Values displaced = read(targets[t][name]);
            for (size_t i = 0; i < displaced.all.size(); ++i)
                base.all[i / displaced.width * base.width + i % displaced.width] +=
                    weights[t] * displaced.all[i];
        }
        return base;
    }

    /// Where each vertex goes: by its joints, or all alike.
    [[nodiscard]] std::vector<Affine> placesOf(const json& primitive, const json& node, const Affine& rigid,
                                               const Affine& copy, size_t vertices) const {
        if (!node.contains("skin") || !primitive["attributes"].contains("JOINTS_0"))
            return std::vector<Affine>(vertices, rigid);
        const json& skin = json_["skins"][node["skin"].get<size_t>()];
        std::vector<Affine> joints;
        const Values inverseBinds =
            skin.contains("inverseBindMatrices") ? read(skin["inverseBindMatrices"]) : Values{};
        for (size_t j = 0; j < skin["joints"].size(); ++j) {
            Affine bind = kIdentity;
            if (!inverseBinds.all.empty())
                bind = fromColumns({inverseBinds.all.begin() + static_cast<std::ptrdiff_t>(16 * j),
                                    inverseBinds.all.begin() + static_cast<std::ptrdiff_t>(16 * j + 16)});
            joints.push_back(copy * sceneFromNode_[skin["joints"][j].get<size_t>()] * bind);
        }
        std::vector<Affine> places(vertices, Affine{});
        std::vector<Real> total(vertices, 0);
        for (size_t set = 0; primitive["attributes"].contains("JOINTS_" + std::to_string(set)); ++set) {
            const Values index = read(primitive["attributes"]["JOINTS_" + std::to_string(set)]),
                         weight = read(primitive["attributes"]["WEIGHTS_" + std::to_string(set)]);
            for (size_t i = 0; i < index.all.size(); ++i) {
                const Affine& joint = joints.at(static_cast<size_t>(index.all[i]));
                for (size_t k = 0; k < 12; ++k)
                    places[i / 4][k / 4][k % 4] += weight.all[i] * joint[k / 4][k % 4];
                total[i / 4] += weight.all[i];
            }
        }
        for (size_t v = 0; v < vertices; ++v)
            for (size_t k = 0; k < 12; ++k)
                places[v][k / 4][k % 4] /= total[v];
        return places;
    }

    void show(size_t index) {
        const json& node = json_["nodes"][index];
        if (!node.contains("mesh"))
            return;
        const json& mesh = json_["meshes"][node["mesh"].get<size_t>()];
        const std::vector<Real> weights =
            node.value("weights", mesh.value("weights", json::array())).get<std::vector<Real>>();
        const std::vector<Affine> copies = copiesOf(node);
        for (size_t c = 0; c < copies.size(); ++c) {
            const Affine rigid = sceneFromNode_[index] * copies[c];
            // A copy of a skin is displaced in the scene as the copy of a rigid mesh is.
            const bool instanced = node.contains("extensions") && node.contains("skin");
            const Affine copy = instanced ? rigid * inverse(sceneFromNode_[index]) : kIdentity;
            for (size_t p = 0; p < mesh["primitives"].size(); ++p) {
                const json& primitive = mesh["primitives"][p];
                objects_.push_back({"nodes[" + std::to_string(index) + "] copy " + std::to_string(c) +
                                        " primitives[" + std::to_string(p) + "]",
                                    triangles(primitive, node, weights, rigid, copy)});
            }
        }
    }

    [[nodiscard]] std::vector<Affine> copiesOf(const json& node) const {
        if (!node.contains("extensions") || !node["extensions"].contains("EXT_mesh_gpu_instancing"))
            return {kIdentity};
        const json& attributes = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        std::array<Values, 3> trs;
        constexpr const char* kNames[3] = {"TRANSLATION", "ROTATION", "SCALE"};
        size_t count = 0;
        for (size_t k = 0; k < 3; ++k)
            if (attributes.contains(kNames[k])) {
                trs[k] = read(attributes[kNames[k]]);
                count = trs[k].count;
            }
        std::vector<Affine> copies;
        for (size_t i = 0; i < count; ++i) {
            const auto get = [&](size_t which, size_t component, Real otherwise) {
                return trs[which].all.empty() ? otherwise : trs[which].at(i, component);
            };
            copies.push_back(fromTrs({get(0, 0, 0), get(0, 1, 0), get(0, 2, 0)},
                                     {get(1, 0, 0), get(1, 1, 0), get(1, 2, 0), get(1, 3, 1)},
                                     {get(2, 0, 1), get(2, 1, 1), get(2, 2, 1)}));
        }
        return copies;
    }

    [[nodiscard]] std::vector<std::array<TruthCorner, 3>> triangles(const json& primitive, const json& node,
                                                                    const std::vector<Real>& weights,
                                                                    const Affine& rigid,
                                                                    const Affine& copy) const {
        const Values position = morphed(primitive, "POSITION", weights),
                     normal = morphed(primitive, "NORMAL", weights),
                     uv = morphed(primitive, "TEXCOORD_0", weights),
                     color = morphed(primitive, "COLOR_0", weights);
        const std::vector<Affine> places = placesOf(primitive, node, rigid, copy, position.count);
        std::vector<size_t> drawn;
        if (primitive.contains("indices"))
            for (const Real each : read(primitive["indices"]).all)
                drawn.push_back(static_cast<size_t>(each));
        else
            for (size_t v = 0; v < position.count; ++v)
                drawn.push_back(v);
        std::vector<std::array<TruthCorner, 3>> result;
        for (size_t i = 0; i + 2 < drawn.size(); i += 3) {
            std::array<TruthCorner, 3> triangle;
            int turns = 0;
            for (size_t k = 0; k < 3; ++k) {
                const size_t v = drawn[i + k];
                TruthCorner& corner = triangle[k];
                corner.position = point(places[v], {position.at(v, 0), position.at(v, 1), position.at(v, 2)});
                turns += determinant(places[v]) < 0 ? -1 : 1;
                if (!normal.all.empty()) {
                    const Real3 inMesh = unit({normal.at(v, 0), normal.at(v, 1), normal.at(v, 2)});
                    corner.normal = normalUnder(places[v], inMesh);
                    corner.steady = steadiness(places[v], inMesh);
                }
                for (size_t c = 0; c < 2 && !uv.all.empty(); ++c)
                    corner.uv0[c] = uv.at(v, c);
                for (size_t c = 0; c < color.width; ++c)
                    corner.color[c] = std::clamp<Real>(color.at(v, c), 0, 1);
            }
            if (turns < 0)
                std::swap(triangle[1], triangle[2]);
            if (normal.all.empty())
                setFlat(triangle);
            result.push_back(triangle);
        }
        return result;
    }

    static void setFlat(std::array<TruthCorner, 3>& triangle) {
        Real3 a{}, b{};
        for (size_t c = 0; c < 3; ++c) {
            a[c] = triangle[1].position[c] - triangle[0].position[c];
            b[c] = triangle[2].position[c] - triangle[0].position[c];
        }
        const Real3 across = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                              a[0] * b[1] - a[1] * b[0]};
        // The floats of the positions are rounded by their distance from the mesh's origin at most.
        const Real reach = std::max({lengthOf(a), lengthOf(b), Real(1)});
        for (TruthCorner& corner : triangle) {
            corner.normal = unit(across);
            corner.steady = std::min<Real>(lengthOf(across) / (reach * reach), 1);
        }
    }

    const TruthFile& file_;
    const json& json_;
    std::vector<Affine> sceneFromNode_;
    std::vector<TruthObject> objects_;
};

std::vector<uint8_t> bytesOfFile(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    if (!stream)
        throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

TruthFile readTruthFile(const std::filesystem::path& path) {
    const std::vector<uint8_t> bytes = bytesOfFile(path);
    TruthFile file;
    if (path.extension() != ".glb") {
        file.json = json::parse(bytes.begin(), bytes.end());
        for (const json& buffer : file.json["buffers"])
            file.buffers.push_back(bytesOfFile(path.parent_path() / buffer["uri"].get<std::string>()));
        return file;
    }
    uint32_t length = 0;
    std::memcpy(&length, &bytes.at(12), 4);
    const auto text = bytes.begin() + 20;
    file.json = json::parse(text, text + length);
    if (bytes.size() > 28 + length)
        file.buffers.emplace_back(text + length + 8, bytes.end());
    return file;
}

std::vector<Real> truthNumbers(const TruthFile& file, size_t accessor) {
    return Evaluation(file).numbers(accessor);
}

std::vector<TruthObject> evaluatePose(const TruthFile& file) {
    return Evaluation(file).run();
}

} // namespace touchstone::test
