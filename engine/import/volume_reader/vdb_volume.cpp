// OpenVDB's files: the first grid of numbers, made dense over its active voxels. World coordinates count as
// metres of the scene. A level set (negative inside) is turned round, with its surface at 0.

#include "engine/import/reader_child/standard_streams.h"
#include "engine/import/volume_file/flat_volume_format.h"
#include "engine/import/volume_reader/volume_values.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <istream>
#include <streambuf>

namespace touchstone {

namespace {

/// A file in memory.
class MemoryBuffer final : public std::streambuf {
  public:
    explicit MemoryBuffer(std::span<const uint8_t> bytes) {
        char* const begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data())); // only read
        setg(begin, begin, begin + bytes.size());
    }

  protected:
    pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
        const off_type base = from == std::ios_base::beg   ? 0
                              : from == std::ios_base::cur ? gptr() - eback()
                                                           : egptr() - eback();
        const off_type target = base + offset;
        if (target < 0 || target > egptr() - eback())
            return pos_type(off_type(-1));
        setg(eback(), eback() + target, egptr());
        return pos_type(target);
    }
    pos_type seekpos(pos_type at, std::ios_base::openmode mode) override {
        return seekoff(off_type(at), std::ios_base::beg, mode);
    }
};

/// The grid's values around its active voxels, and one voxel more on each side.
template <class Grid>
void writeGrid(const Grid& grid, bool several, uint64_t most) {
    openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (box.empty())
        throw BadVolume("its grid '" + grid.getName() + "' has no active voxel");
    box.expand(1);
    RawVolume volume;
    volume.type = SampleType::F32;
    for (int axis = 0; axis < 3; ++axis)
        volume.size[static_cast<size_t>(axis)] =
            static_cast<uint64_t>(int64_t{box.max()[axis]} - int64_t{box.min()[axis]} + 1);
    checkVolumeSize(volume, most);
    if (!grid.transform().isLinear())
        throw BadVolume("its grid '" + grid.getName() + "' is not placed by a linear transform");
    const openvdb::Vec3d origin = grid.indexToWorld(box.min().asVec3d());
    FlatVolumeHead head;
    head.type = static_cast<uint32_t>(VolumeType::Float);
    head.notes = several ? kSeveralGrids : 0u;
    const bool levelSet = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
    head.iso = levelSet ? 0.0 : std::nan("");
    glm::dmat3 axes(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Coord next = box.min();
        next[axis] += 1;
        const openvdb::Vec3d step = grid.indexToWorld(next.asVec3d()) - origin;
        for (int part = 0; part < 3; ++part)
            axes[axis][part] = step[part];
    }
    const bool reversed = glm::determinant(axes) < 0.0;
    const auto width = static_cast<int>(volume.size[0]);
    for (int part = 0; part < 3; ++part) {
        head.origin[part] = origin[part] + (reversed ? (width - 1) * axes[0][part] : 0.0);
        for (int axis = 0; axis < 3; ++axis)
            head.axes[axis][part] = reversed && axis == 0 ? -axes[axis][part] : axes[axis][part];
        head.size[part] = static_cast<uint32_t>(volume.size[static_cast<size_t>(part)]);
    }
    std::strncpy(head.fileType, grid.valueType().c_str(), sizeof head.fileType - 1);
    writeOutput(&head, sizeof head);
    const float sign = levelSet ? -1.0f : 1.0f;
    std::vector<float> row(static_cast<size_t>(width));
    auto read = grid.getConstAccessor();
    for (int z = box.min().z(); z <= box.max().z(); ++z)
        for (int y = box.min().y(); y <= box.max().y(); ++y) {
            for (int x = 0; x < width; ++x)
                row[static_cast<size_t>(reversed ? width - 1 - x : x)] =
                    sign * static_cast<float>(read.getValue({box.min().x() + x, y, z}));
            writeOutput(row.data(), row.size() * sizeof(float));
        }
}

template <class Grid>
bool tryGrid(const openvdb::GridBase& base, bool several, uint64_t most) {
    const auto* const grid = dynamic_cast<const Grid*>(&base);
    if (grid != nullptr)
        writeGrid(*grid, several, most);
    return grid != nullptr;
}

} // namespace

void prepareVdb() {
    // The sandbox starts no threads.
    static const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    openvdb::initialize();
}

void writeVdb(std::span<const uint8_t> file, uint64_t most) {
    MemoryBuffer buffer(file);
    std::istream input(&buffer);
    openvdb::GridPtrVecPtr grids;
    try {
        grids = openvdb::io::Stream(input, false).getGrids();
    } catch (const openvdb::Exception& problem) {
        throw BadVolume(problem.what());
    }
    if (grids == nullptr || grids->empty())
        throw BadVolume("it holds no grid");
    for (const openvdb::GridBase::Ptr& grid : *grids)
        if (grid != nullptr && (tryGrid<openvdb::FloatGrid>(*grid, grids->size() > 1, most) ||
                                tryGrid<openvdb::DoubleGrid>(*grid, grids->size() > 1, most) ||
                                tryGrid<openvdb::Int32Grid>(*grid, grids->size() > 1, most) ||
                                tryGrid<openvdb::Int64Grid>(*grid, grids->size() > 1, most)))
            return;
    throw BadVolume("none of its grids holds one number a voxel");
}

} // namespace touchstone
