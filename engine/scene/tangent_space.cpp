#include "engine/scene/tangent_space.h"

#include "engine/scene/mesh_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace touchstone {
namespace {

constexpr int kNone = -1;

struct Face {
    std::array<int, 3> vertex{};                       // welded
    std::array<int, 3> neighbour{kNone, kNone, kNone}; // across edge k -> k+1
    std::array<int, 3> group{kNone, kNone, kNone};     // per corner
    glm::dvec3 tangent{0.0};                           // unit dP/du
    bool collapsed = false;                            // two corners are the same vertex
    bool joinsAny = false;                             // its UVs have no area: any frame is valid
    bool mirrored = false;                             // its UVs wind opposite to its corners
};

glm::dvec3 rejected(const glm::dvec3& v, const glm::dvec3& normal) {
    return v - glm::dot(v, normal) * normal;
}

glm::dvec3 unitOr(const glm::dvec3& v, const glm::dvec3& otherwise) {
    const double length = glm::length(v);
    return length > 1e-300 ? v / length : otherwise;
}

glm::dvec3 anyPerpendicular(const glm::dvec3& n) {
    const glm::dvec3 axis = std::abs(n.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    return unitOr(rejected(axis, n), glm::dvec3(0.0, 0.0, 1.0));
}

class TangentBuilder {
  public:
    TangentBuilder(Mesh& mesh, const std::vector<glm::vec2>& uv, const Progress& progress)
        : mesh_(mesh), uv_(uv), progress_(progress) {}

    void run() {
        makeFaces(weldedVertices());
        linkNeighbours();
        groupCorners();
        sumGroups();
        writeTangents();
    }

  private:
    /// Called once for every face of a loop and every comparison of a sort.
    void answerCancel() {
        if (++asked_ % kProgressWork == 0)
            progress_.stopIfCancelled();
    }

    glm::dvec3 position(size_t face, size_t corner) const {
        return glm::dvec3(mesh_.positions[mesh_.indices[3 * face + corner]]);
    }

    /// Welds vertices that agree in position, normal and UV, however the file indexes them.
    std::vector<int> weldedVertices() {
        const size_t count = mesh_.positions.size();
        std::vector<uint32_t> order(count);
        std::iota(order.begin(), order.end(), 0u);
        const auto key = [&](uint32_t v) {
            const glm::vec3 &p = mesh_.positions[v], &n = mesh_.normals[v];
            return std::array<float, 8>{p.x, p.y, p.z, n.x, n.y, n.z, uv_[v].x, uv_[v].y};
        };
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            answerCancel();
            return key(a) < key(b);
        });
        std::vector<int> welded(count);
        for (size_t i = 0; i < count; ++i)
            welded[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? welded[order[i - 1]]
                                                                           : static_cast<int>(order[i]);
        return welded;
    }

    void makeFaces(const std::vector<int>& welded) {
        faces_.resize(mesh_.indices.size() / 3);
        for (size_t f = 0; f < faces_.size(); ++f) {
            answerCancel();
            Face& face = faces_[f];
            for (size_t k = 0; k < 3; ++k)
                face.vertex[k] = welded[mesh_.indices[3 * f + k]];
            face.collapsed = face.vertex[0] == face.vertex[1] || face.vertex[1] == face.vertex[2] ||
                             face.vertex[2] == face.vertex[0];
            // The image's v points down; the tangent frame's second axis points up the image.
            const auto uvOf = [&](size_t k) {
                const glm::dvec2 uv(uv_[mesh_.indices[3 * f + k]]);
                return glm::dvec2(uv.x, -uv.y);
            };
            const glm::dvec3 edge1 = position(f, 1) - position(f, 0), edge2 = position(f, 2) - position(f, 0);
            const glm::dvec2 uv1 = uvOf(1) - uvOf(0), uv2 = uvOf(2) - uvOf(0);
            // P = P0 + dP/du u + dP/dv v over the triangle; solve for dP/du. Only its direction is used.
            const double area = uv1.x * uv2.y - uv1.y * uv2.x;
            const glm::dvec3 along = (area < 0.0 ? -1.0 : 1.0) * (uv2.y * edge1 - uv1.y * edge2);
            face.tangent = unitOr(along, glm::dvec3(0.0));
            face.joinsAny = area == 0.0 || face.tangent == glm::dvec3(0.0);
            face.mirrored = area < 0.0;
        }
    }

    struct Edge {
        int low, high, face, side;
        bool forward; // from low to high
        auto operator<=>(const Edge&) const = default;
    };

    void linkNeighbours() {
        std::vector<Edge> edges;
        edges.reserve(3 * faces_.size());
        for (size_t f = 0; f < faces_.size(); ++f) {
            if (faces_[f].collapsed)
                continue;
            for (int k = 0; k < 3; ++k) {
                const int a = faces_[f].vertex[static_cast<size_t>(k)],
                          b = faces_[f].vertex[static_cast<size_t>((k + 1) % 3)];
                edges.push_back({std::min(a, b), std::max(a, b), static_cast<int>(f), k, a < b});
            }
        }
        std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) {
            answerCancel();
            return a < b;
        });
        // Among the faces on one edge, pair those that run along it in opposite directions, in their order.
        for (size_t first = 0; first < edges.size();) {
            size_t end = first;
            while (end < edges.size() && edges[end].low == edges[first].low &&
                   edges[end].high == edges[first].high)
                ++end;
            size_t forward = first, backward = first;
            while (true) {
                while (forward < end && !edges[forward].forward)
                    ++forward;
                while (backward < end && edges[backward].forward)
                    ++backward;
                if (forward >= end || backward >= end)
                    break;
                const Edge &a = edges[forward++], &b = edges[backward++];
                faces_[static_cast<size_t>(a.face)].neighbour[static_cast<size_t>(a.side)] = b.face;
                faces_[static_cast<size_t>(b.face)].neighbour[static_cast<size_t>(b.side)] = a.face;
            }
            first = end;
        }
    }

    static int cornerAt(const Face& face, int vertex) {
        for (int k = 0; k < 3; ++k)
            if (face.vertex[static_cast<size_t>(k)] == vertex)
                return k;
        return kNone;
    }

    /// Corners around a vertex share a frame while their faces are connected by edges and have the same UV
    /// handedness.
    void groupCorners() {
        std::vector<int> open;
        for (size_t f = 0; f < faces_.size(); ++f) {
            if (faces_[f].joinsAny || faces_[f].collapsed)
                continue;
            for (size_t k = 0; k < 3; ++k) {
                if (faces_[f].group[k] != kNone)
                    continue;
                const int group = static_cast<int>(mirroredGroup_.size()), vertex = faces_[f].vertex[k];
                const bool mirrored = faces_[f].mirrored;
                mirroredGroup_.push_back(mirrored);
                open.assign(1, static_cast<int>(f));
                while (!open.empty()) {
                    answerCancel();
                    Face& face = faces_[static_cast<size_t>(open.back())];
                    open.pop_back();
                    const int corner = cornerAt(face, vertex);
                    if (corner == kNone || face.group[static_cast<size_t>(corner)] != kNone)
                        continue;
                    const bool untouched = face.group == std::array<int, 3>{kNone, kNone, kNone};
                    if (face.joinsAny && untouched)
                        face.mirrored = mirrored;
                    if (face.mirrored != mirrored)
                        continue;
                    face.group[static_cast<size_t>(corner)] = group;
                    for (const int side : {corner, (corner + 2) % 3})
                        if (face.neighbour[static_cast<size_t>(side)] != kNone)
                            open.push_back(face.neighbour[static_cast<size_t>(side)]);
                }
            }
        }
    }

    /// Sums each face's direction in the plane of the vertex normal, weighted by its corner's angle there.
    void sumGroups() {
        sum_.assign(mirroredGroup_.size(), glm::dvec3(0.0));
        for (size_t f = 0; f < faces_.size(); ++f) {
            answerCancel();
            const Face& face = faces_[f];
            if (face.joinsAny)
                continue;
            for (size_t k = 0; k < 3; ++k) {
                if (face.group[k] == kNone)
                    continue;
                const glm::dvec3 normal(mesh_.normals[static_cast<size_t>(face.vertex[k])]);
                const glm::dvec3 here = position(f, k);
                const glm::dvec3 next =
                    unitOr(rejected(position(f, (k + 1) % 3) - here, normal), glm::dvec3(0.0));
                const glm::dvec3 previous =
                    unitOr(rejected(position(f, (k + 2) % 3) - here, normal), glm::dvec3(0.0));
                const double angle = std::acos(std::clamp(glm::dot(next, previous), -1.0, 1.0));
                sum_[static_cast<size_t>(face.group[k])] +=
                    angle * unitOr(rejected(face.tangent, normal), glm::dvec3(0.0));
            }
        }
    }

    /// A corner whose vertex already has another group's frame.
    struct Split {
        uint32_t vertex;
        int group;
        size_t corner;
        auto operator<=>(const Split&) const = default;
    };

    /// Gives every vertex the frame of its group, and splits those that belong to several.
    void writeTangents() {
        mesh_.tangents.assign(mesh_.positions.size(), glm::vec4(0.0f));
        constexpr int kUnset = -2;
        std::vector<int> groupOf(mesh_.positions.size(), kUnset);
        std::vector<Split> splits;
        // Collapsed faces come last: they use whatever frame their vertex already has.
        for (const bool collapsedPass : {false, true})
            for (size_t f = 0; f < faces_.size(); ++f) {
                answerCancel();
                if (faces_[f].collapsed != collapsedPass)
                    continue;
                for (size_t k = 0; k < 3; ++k) {
                    const int group = faces_[f].group[k];
                    const uint32_t v = mesh_.indices[3 * f + k];
                    if (groupOf[v] == kUnset) {
                        groupOf[v] = group;
                        setTangent(v, group);
                    } else if (group != kNone && group != groupOf[v]) {
                        splits.push_back({v, group, 3 * f + k});
                    }
                }
            }
        // Vertices without a triangle.
        for (size_t v = 0; v < groupOf.size(); ++v)
            if (groupOf[v] == kUnset)
                setTangent(static_cast<uint32_t>(v), kNone);
        splitVertices(splits);
    }

    /// One copy of a vertex for each further group, in the order of their first corners.
    void splitVertices(std::vector<Split>& splits) {
        std::sort(splits.begin(), splits.end(), [&](const Split& a, const Split& b) {
            answerCancel();
            return a < b;
        });
        const auto share = [](const Split& a, const Split& b) {
            return a.vertex == b.vertex && a.group == b.group;
        };
        std::vector<size_t> firsts;
        for (size_t i = 0; i < splits.size(); ++i)
            if (i == 0 || !share(splits[i - 1], splits[i]))
                firsts.push_back(i);
        std::sort(firsts.begin(), firsts.end(), [&](size_t a, size_t b) {
            answerCancel();
            return splits[a].corner < splits[b].corner;
        });
        for (const size_t first : firsts) {
            answerCancel();
            const uint32_t copy = duplicateVertex(mesh_, splits[first].vertex);
            setTangent(copy, splits[first].group);
            for (size_t i = first; i < splits.size() && share(splits[first], splits[i]); ++i)
                mesh_.indices[splits[i].corner] = copy;
        }
    }

    void setTangent(uint32_t v, int group) {
        const glm::dvec3 normal(mesh_.normals[v]);
        const glm::dvec3 sum =
            group == kNone ? glm::dvec3(0.0) : rejected(sum_[static_cast<size_t>(group)], normal);
        const glm::dvec3 tangent = glm::length(sum) > 1e-12 ? glm::normalize(sum) : anyPerpendicular(normal);
        const bool mirrored = group != kNone && mirroredGroup_[static_cast<size_t>(group)];
        mesh_.tangents[v] = glm::vec4(glm::vec3(tangent), mirrored ? -1.0f : 1.0f);
    }

    Mesh& mesh_;
    const std::vector<glm::vec2> uv_; // a copy: the mesh's own grows as vertices are split
    std::vector<Face> faces_;
    std::vector<bool> mirroredGroup_;
    std::vector<glm::dvec3> sum_;
    const Progress& progress_;
    size_t asked_ = 0; // answerCancel
};

} // namespace

void generateTangents(Mesh& mesh, int texCoord, const Progress& progress) {
    TangentBuilder(mesh, texCoord == 1 ? mesh.uv1 : mesh.uv0, progress).run();
}

} // namespace touchstone
