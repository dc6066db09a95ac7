// touchstone_assets OUTDIR                                writes every committed scene
// touchstone_assets --shape NAME --triangles N OUT.glb    writes one bare mesh of about N triangles
// touchstone_assets --volume NAME --voxels N OUT.nrrd     writes one volume (.nrrd or .vdb) of N^3 voxels

#include "assets/glb_writer.h"
#include "assets/scenes.h"
#include "assets/volumes.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <string>

namespace {

void announce(const std::filesystem::path& path, size_t bytes) {
    std::cout << path.string() << ": " << bytes << " bytes\n";
}

void writeAll(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    size_t total = 0;
    for (const auto& [name, bytes] : touchstone::assets::allScenes()) {
        touchstone::assets::writeFile(folder / name, bytes);
        announce(folder / name, bytes.size());
        total += bytes.size();
    }
    std::cout << total << " bytes together\n";
}

void writeVolume(const std::filesystem::path& out, const std::string& name, int voxels,
                 const std::string& type) {
    const auto volume = touchstone::assets::makeVolume(name, glm::ivec3(voxels), type);
    if (out.extension() == ".vdb")
        touchstone::assets::writeVdb(out, volume);
    else
        touchstone::assets::writeFile(out, touchstone::assets::nrrdOf(volume));
    announce(out, std::filesystem::file_size(out));
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Writes Touchstone's own scenes, the same bytes every time."};
    std::string out, shape, volume, type = "int16";
    size_t triangles = 64800;
    int voxels = 128;
    app.add_option("OUT", out, "folder for all scenes, or with --shape the file to write")->required();
    app.add_option("--shape", shape, "torus, sphere, box, plane or prism: write one bare mesh instead");
    app.add_option("--triangles", triangles, "about how many triangles it has")->needs("--shape");
    app.add_option("--volume", volume, "ball, gyroid or head: write one volume instead, .nrrd or .vdb")
        ->excludes("--shape");
    app.add_option("--voxels", voxels, "of the volume, on each axis [128]")->needs("--volume");
    app.add_option("--type", type, "of its values: uint8, int16 or float [int16]")->needs("--volume");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        if (!volume.empty()) {
            writeVolume(out, volume, voxels, type);
        } else if (shape.empty()) {
            writeAll(out);
        } else {
            const auto scene = touchstone::assets::bareShape(shape, triangles);
            touchstone::assets::writeFile(out, scene.bytes);
            announce(out, scene.bytes.size());
        }
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return 0;
}
