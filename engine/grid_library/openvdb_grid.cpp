// touchstone_grids.so: sparse grids by OpenVDB.

#include "engine/grid/sparse_grid.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

#include <optional>
#include <sstream>
#include <utility>

namespace touchstone {

namespace {

openvdb::Coord coordOf(const glm::ivec3& at) {
    return {at.x, at.y, at.z};
}

/// Of a leaf's node x, y, z, x fastest.
size_t nodeOf(int x, int y, int z) {
    return static_cast<size_t>(x + SparseGrid::kLeaf * (y + SparseGrid::kLeaf * z));
}

class OpenVdbGrid final : public SparseGrid {
  public:
    /// `threads`: none: OpenVDB chooses.
    OpenVdbGrid(openvdb::FloatGrid::Ptr grid, std::optional<int> threads)
        : grid_(std::move(grid)), accessor_(grid_->getAccessor()), threads_(threads) {}
    ~OpenVdbGrid() override {
        accessor_.reset();
        limited([&] { grid_.reset(); });
    }
    OpenVdbGrid(const OpenVdbGrid&) = delete;
    OpenVdbGrid& operator=(const OpenVdbGrid&) = delete;

    void fillLeaf(const glm::ivec3& first, float value) override {
        accessor_->addTile(1, coordOf(first), value, false);
    }
    void setLeaf(const glm::ivec3& first, std::span<const float> values, float low, float high) override {
        auto* const leaf = accessor_->touchLeaf(coordOf(first));
        for (int z = 0; z < kLeaf; ++z)
            for (int y = 0; y < kLeaf; ++y)
                for (int x = 0; x < kLeaf; ++x) {
                    const float value = values[nodeOf(x, y, z)];
                    if (value > low && value < high)
                        leaf->setValueOn({x, y, z}, value);
                    else
                        leaf->setValueOff({x, y, z}, value);
                }
    }
    void setBox(const glm::ivec3& low, const glm::ivec3& size, std::span<const float> values) override {
        size_t i = 0;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    accessor_->setValueOn(coordOf(low + glm::ivec3(x, y, z)), values[i++]);
    }

    [[nodiscard]] float value(const glm::ivec3& at) const override {
        return grid_->tree().getValue(coordOf(at));
    }
    void copyLeaf(const glm::ivec3& first, std::span<float> values) const override {
        const auto* const leaf = grid_->tree().probeConstLeaf(coordOf(first));
        const float flat = leaf == nullptr ? value(first) : 0.0f;
        for (int z = 0; z < kLeaf; ++z)
            for (int y = 0; y < kLeaf; ++y)
                for (int x = 0; x < kLeaf; ++x)
                    values[nodeOf(x, y, z)] = leaf == nullptr ? flat : leaf->getValue({x, y, z});
    }
    [[nodiscard]] GridFaces zero() const override {
        std::vector<openvdb::Vec3s> points;
        std::vector<openvdb::Vec3I> triangles;
        std::vector<openvdb::Vec4I> quads;
        limited([&] { openvdb::tools::volumeToMesh(*grid_, points, triangles, quads, 0.0, 0.0); });
        GridFaces faces;
        faces.points.reserve(points.size());
        for (const openvdb::Vec3s& point : points)
            faces.points.emplace_back(point.x(), point.y(), point.z());
        faces.triangles.reserve(triangles.size());
        for (const openvdb::Vec3I& t : triangles)
            faces.triangles.push_back({t[0], t[1], t[2]});
        faces.quads.reserve(quads.size());
        for (const openvdb::Vec4I& q : quads)
            faces.quads.push_back({q[0], q[1], q[2], q[3]});
        return faces;
    }
    [[nodiscard]] std::string file(const std::string& name, const std::array<glm::dvec3, 3>& steps,
                                   const glm::dvec3& origin) const override {
        // OpenVDB multiplies row vectors: an axis is a row.
        openvdb::Mat4d worldFromIndex = openvdb::Mat4d::identity();
        for (int k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis)
                worldFromIndex(axis, k) = steps[static_cast<size_t>(axis)][k];
            worldFromIndex(3, k) = origin[k];
        }
        const openvdb::FloatGrid::Ptr named = grid_->copy();
        named->setTransform(openvdb::math::Transform::createLinearTransform(worldFromIndex));
        named->setGridClass(openvdb::GRID_LEVEL_SET);
        named->setName(name);
        std::ostringstream bytes(std::ios::binary);
        openvdb::io::Stream(bytes).write(openvdb::GridCPtrVec{named});
        return std::move(bytes).str();
    }

  private:
    /// The default arena would take all cores from the servo, also to free a grid.
    template <class Work>
    void limited(const Work& work) const {
        if (threads_)
            tbb::task_arena(*threads_).execute(work);
        else
            work();
    }

    openvdb::FloatGrid::Ptr grid_;
    std::optional<openvdb::FloatGrid::Accessor> accessor_; // freed before the grid
    std::optional<int> threads_;
};

/// OpenVDB asks it now and then whether to stop. As its base it is given to what OpenVDB's library holds
/// compiled.
class Interrupter final : public openvdb::util::NullInterrupter {
  public:
    explicit Interrupter(const std::function<bool()>& cancelled) : cancelled_(cancelled) {}
    bool wasInterrupted(int = -1) override { return cancelled_(); }

  private:
    const std::function<bool()>& cancelled_;
};

class OpenVdbLibrary final : public GridLibrary {
  public:
    OpenVdbLibrary() { openvdb::initialize(); }

    [[nodiscard]] uint32_t version() const override { return openvdb::OPENVDB_LIBRARY_VERSION; }
    [[nodiscard]] std::unique_ptr<SparseGrid> create(float background, int threads) const override {
        return std::make_unique<OpenVdbGrid>(openvdb::FloatGrid::create(background), threads);
    }
    [[nodiscard]] std::unique_ptr<SparseGrid>
    distances(std::span<const glm::dvec3> vertices, std::span<const uint32_t> corners, float band,
              const std::function<bool()>& cancelled) const override {
        std::vector<openvdb::Vec3s> points;
        points.reserve(vertices.size());
        for (const glm::dvec3& p : vertices)
            points.emplace_back(p.x, p.y, p.z);
        std::vector<openvdb::Vec3I> triangles;
        triangles.reserve(corners.size() / 3);
        for (size_t t = 0; t < corners.size(); t += 3)
            triangles.emplace_back(corners[t], corners[t + 1], corners[t + 2]);
        const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> soup(points,
                                                                                              triangles);
        const auto unit = openvdb::math::Transform::createLinearTransform(1.0);
        Interrupter interrupter(cancelled);
        return std::make_unique<OpenVdbGrid>(openvdb::tools::meshToVolume<openvdb::FloatGrid>(
                                                 static_cast<openvdb::util::NullInterrupter&>(interrupter),
                                                 soup, *unit, band, band,
                                                 openvdb::tools::DISABLE_RENORMALIZATION),
                                             std::nullopt);
    }
};

} // namespace

} // namespace touchstone

extern "C" [[gnu::visibility("default")]] const touchstone::GridLibrary* touchstoneGridLibrary() {
    static const touchstone::OpenVdbLibrary library;
    return &library;
}
