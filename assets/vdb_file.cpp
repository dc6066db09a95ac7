#include "assets/volumes.h"

#include <openvdb/openvdb.h>

#include <algorithm>

namespace touchstone::assets {

void writeVdb(const std::filesystem::path& path, const VolumeData& volume) {
    openvdb::initialize();
    const auto grid = openvdb::FloatGrid::create(*std::ranges::min_element(volume.values));
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    const glm::dvec3 step = 1e-3 * volume.spacing, first = -0.5 * step * glm::dvec3(volume.voxels - 1);
    grid->setTransform(openvdb::math::Transform::Ptr(new openvdb::math::Transform(openvdb::math::MapBase::Ptr(
        new openvdb::math::ScaleTranslateMap({step.x, step.y, step.z}, {first.x, first.y, first.z})))));
    openvdb::FloatGrid::Accessor accessor = grid->getAccessor();
    size_t i = 0;
    for (int z = 0; z < volume.voxels.z; ++z)
        for (int y = 0; y < volume.voxels.y; ++y)
            for (int x = 0; x < volume.voxels.x; ++x)
                accessor.setValue({x, y, z}, volume.values[i++]);
    openvdb::io::File file(path.string());
    file.write({grid});
}

} // namespace touchstone::assets
