// touchstone_mesh_reader obj|stl|ply: reads a mesh from standard input and writes its arrays to standard
// output (engine/import/mesh_file/flat_format.h). Exit status 1: standard output has a line that says why
// there is none.
//
// The library that reads meshes is large and meets files of any origin. So it runs in this process and not in
// the program: the parent limits memory and time, and the sandbox leaves it no file, network or process.

#include "engine/import/mesh_reader/flat_writer.h"
#include "engine/import/mesh_reader/one_file.h"
#include "engine/import/reader_child/sandbox.h"
#include "engine/import/reader_child/standard_streams.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <unistd.h>

#include <cstdint>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace touchstone {
namespace {

void read(const std::string& ending) {
    const std::span<const uint8_t> bytes = standardInput();
    Assimp::Importer importer;
    const std::string name = "model." + ending;
    importer.SetIOHandler(new OneFile(name, bytes)); // the importer owns it
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    unsigned steps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_SortByPType |
                     aiProcess_FlipUVs; // glTF counts v from the top
    if (ending == "stl") {
        // Those of its facets, which follow from the corners; often they are zero.
        importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS);
        steps |= aiProcess_RemoveComponent;
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (ending == "ply" && text.find("end_header") == std::string_view::npos)
        throw std::runtime_error("its header has no end"); // the library would look for it for ever
    enterSandbox();
    const aiScene* scene = importer.ReadFile(name, steps);
    const std::string problem = importer.GetErrorString();
    if (scene == nullptr) // points and lines alone: the library's words for it would help nobody
        throw std::runtime_error(problem == "No meshes remaining" ? "it holds no triangles" : problem);
    writeFlat(*scene);
    _exit(0); // memory is the system's to tidy
}

} // namespace
} // namespace touchstone

int main(int argc, char** argv) {
    try {
        if (argc == 2)
            touchstone::read(argv[1]);
        touchstone::endWith(1, "usage: touchstone_mesh_reader obj|stl|ply <MODEL");
    } catch (const std::bad_alloc&) {
        touchstone::endWith(1, "it needs more memory than it may have");
    } catch (const std::exception& error) {
        touchstone::endWith(1, error.what());
    }
}
