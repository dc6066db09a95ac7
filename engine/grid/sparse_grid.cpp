#include "engine/grid/sparse_grid.h"

#include "engine/core/error.h"
#include "engine/process/loaded_module.h"

namespace touchstone {

std::vector<uint32_t> triangleCorners(const GridFaces& faces) {
    std::vector<uint32_t> corners;
    corners.reserve(6 * faces.quads.size() + 3 * faces.triangles.size());
    for (const GridFaces::Quad& quad : faces.quads)
        corners.insert(corners.end(), {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
    for (const GridFaces::Triangle& triangle : faces.triangles)
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    return corners;
}

const GridLibrary& gridLibrary() {
    constexpr const char* kFile = "touchstone_grids.so";
    static std::string why;
    static void* const function = functionOfModule(kFile, kGridLibrarySymbol, why);
    if (function == nullptr)
        throw Error(kFile, "",
                    "the library of grids (distance fields, volumes) cannot be loaded (" + why + ")",
                    "build touchstone_grids and leave it beside touchstone");
    static const GridLibrary& library = *reinterpret_cast<const GridLibrary* (*)()>(function)();
    return library;
}

} // namespace touchstone
