#include "workbench/model/default_scene.h"

#include "engine/process/helper_program.h"

#include <algorithm>
#include <system_error>

namespace touchstone {

std::filesystem::path defaultScene() {
    // build/<preset>/bin/touchstone: a tree that was moved as a whole still finds its scenes.
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (!error) {
        const std::filesystem::path beside = program.parent_path() / "../../../assets/scenes/effects.glb";
        if (std::filesystem::exists(beside, error))
            return std::filesystem::weakly_canonical(beside, error);
    }
    const std::filesystem::path source = TOUCHSTONE_DEFAULT_SCENE;
    return dataFolder("scenes", source.parent_path()) / source.filename();
}

std::vector<std::filesystem::path> sampleScenes() {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(defaultScene().parent_path(), error))
        if (entry.path().extension() == ".glb")
            found.push_back(entry.path());
    std::ranges::sort(found);
    return found;
}

bool isSample(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::weakly_canonical(path, error).parent_path() ==
           std::filesystem::weakly_canonical(defaultScene(), error).parent_path();
}

} // namespace touchstone
