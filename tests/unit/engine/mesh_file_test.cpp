// OBJ, STL and PLY become scenes by way of a process that may fail in any way.
#include "engine/core/checksum.h"
#include "engine/import/mesh_file/mesh_import.h"
#include "engine/save/material_patch.h"
#include "tests/support/mesh_files.h"
#include "tests/support/program.h"
#include "tests/support/scene_promises.h"
#include "tests/unit/engine/load_support.h"

#include <fstream>
#include <set>
#include <thread>

namespace touchstone::mesh_file_test {
namespace {

using test::Bytes;
using test::contains;
namespace fs = std::filesystem;

class MeshFiles : public testing::Test {
  protected:
    fs::path file(const std::string& name, const Bytes& bytes) {
        const fs::path path = scratch_ / name;
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return path;
    }
    Error refused(const std::string& name, const Bytes& bytes) {
        return test::errorOf([&] { return loadScene(file(name, bytes)); });
    }
    /// The error of a reader that is a program of the shell.
    Error refusedBy(const std::string& script, const ProcessLimits& limits = {}) {
        const fs::path program = file("reader", test::bytesOf("#!/bin/sh\n" + script));
        fs::permissions(program, fs::perms::owner_all);
        const LoadOptions options;
        ImportContext context("model.stl", options);
        return test::errorOf([&] {
            return meshAsGlb(context, test::tetrahedronBinaryStl(), MeshFormat::Stl, {program, limits});
        });
    }
    test::ScratchFolder scratch_;
};

void expectTetrahedron(const Scene& scene, const std::string& name) {
    EXPECT_EQ(scene.triangleCount(), 4u) << name;
    EXPECT_EQ(scene.bounds.low, glm::dvec3(0.0)) << name;
    EXPECT_EQ(scene.bounds.high, glm::dvec3(1.0)) << name;
    EXPECT_EQ(test::brokenPromise(scene), std::nullopt) << name;
    EXPECT_TRUE(test::warns(scene, "units", "its numbers are taken as metres"))
        << name << test::warningsOf(scene);
    // Wound to the outside: the signed volume is 1/6.
    double volume = 0.0;
    for (const Mesh& mesh : scene.meshes)
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const auto corner = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[i + k]]); };
            volume += glm::dot(corner(0), glm::cross(corner(1), corner(2))) / 6.0;
        }
    EXPECT_NEAR(volume, 1.0 / 6.0, 1e-12) << name;
}

TEST_F(MeshFiles, EveryFormatGivesTheTetrahedron) {
    const std::pair<const char*, Bytes> files[] = {
        {"a.obj", test::tetrahedronObj()},
        {"a.stl", test::tetrahedronAsciiStl()},
        {"b.STL", test::tetrahedronBinaryStl()},
        {"solid.stl", test::tetrahedronBinaryStl("solid, it says")},
        {"a.ply", test::tetrahedronAsciiPly()},
        {"b.ply", test::tetrahedronBinaryPly()},
        {"no name of a mesh", test::tetrahedronBinaryStl()},
        {"wrong.glb", test::tetrahedronAsciiPly()}};
    for (const auto& [name, bytes] : files) {
        const ScenePtr scene = loadScene(file(name, bytes));
        expectTetrahedron(*scene, name);
        EXPECT_EQ(scene->path, scratch_ / name);
        EXPECT_EQ(scene->file, stampOf(bytes)) << "of the file itself";
    }
    expectTetrahedron(*loadSceneFromMemory(test::tetrahedronObj(), "."), "from memory");
}

TEST_F(MeshFiles, KeepWhatTheyHave) {
    const ScenePtr obj = loadScene(file("a.obj", test::tetrahedronObj()));
    std::set<std::string> names;
    for (const Mesh& mesh : obj->meshes) {
        const Material& material = obj->materials[static_cast<size_t>(mesh.material)];
        names.insert(material.name);
        EXPECT_EQ(material.metallic, 0.0f);
        EXPECT_FALSE(material.roughnessStated) << "nothing is invented that would be felt";
        EXPECT_TRUE(mesh.normalsFromFile);
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            if (mesh.positions[v] == glm::vec3(0.0f, 1.0f, 0.0f)) {
                EXPECT_EQ(mesh.normals[v], glm::vec3(0.0f, 1.0f, 0.0f));
                EXPECT_EQ(mesh.uv0[v], glm::vec2(0.0f, 0.75f)) << "glTF counts v from the top";
            }
    }
    EXPECT_EQ(names, (std::set<std::string>{"cork", "steel"})) << "though their library is not read";
    const ScenePtr stl = loadScene(file("a.stl", test::tetrahedronAsciiStl()));
    EXPECT_FALSE(stl->meshes.at(0).normalsFromFile) << "those of the facets follow from the corners";
    EXPECT_TRUE(loadScene(file("a.ply", test::tetrahedronAsciiPly()))->meshes.at(0).colors.size() > 0);
}

TEST_F(MeshFiles, AreSavedAsGlbWithTheirMaterials) {
    const fs::path source = file("a.obj", test::tetrahedronObj()), target = scratch_ / "new.glb";
    const MaterialPatches patches{{0, {{"stiffness", 321.0}}}};
    const FileStamp stamp = stampOf(test::tetrahedronObj());
    const Error error = test::errorOf([&] { return saveMaterials(source, stamp, patches, source); });
    EXPECT_TRUE(contains(error.remedy(), "new .glb")) << error.what();
    const FileStamp saved = saveMaterials(source, stamp, patches, target);
    EXPECT_EQ(test::readFile(source),
              std::string(reinterpret_cast<const char*>(test::tetrahedronObj().data()),
                          test::tetrahedronObj().size()));
    const ScenePtr again = loadScene(target);
    EXPECT_EQ(again->file, saved);
    EXPECT_EQ(again->triangleCount(), 4u);
    EXPECT_EQ(again->materials.at(0).haptic.stiffness.value, 321.0f);
    EXPECT_EQ(again->materials.at(1).haptic.stiffness.value, std::nullopt);
    LoadOptions edited;
    edited.edits = textOf(patches);
    EXPECT_EQ(loadScene(source, edited)->materials.at(0).haptic.stiffness.value, 321.0f);
}

TEST_F(MeshFiles, BadOnesAreRefusedWithAReason) {
    Bytes cut = test::tetrahedronBinaryStl();
    cut.resize(150);
    Bytes lying = test::tetrahedronBinaryStl();
    std::fill_n(lying.begin() + 80, 4, uint8_t{0x7f});
    Bytes nan = test::tetrahedronBinaryStl();
    std::fill_n(nan.begin() + 84 + 12, 4, uint8_t{0xff});
    const std::pair<const char*, Bytes> files[] = {
        {"empty.stl", {}},
        {"cut.stl", cut},
        {"lying.stl", lying},
        {"nan.stl", nan},
        {"words.obj", test::bytesOf("there was once a mesh\n")},
        {"empty.obj", test::bytesOf("# nothing\n")},
        {"points.obj", test::bytesOf("v 0 0 0\nv 1 0 0\nv 0 1 0\n")},
        {"beyond.obj", test::bytesOf("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4000000000\n")},
        {"lying.ply", test::tetrahedronBinaryPly("1000000000")},
        {"many.ply", test::tetrahedronBinaryPly("99999999999999999999")},
        {"points.ply",
         test::bytesOf("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                       "property float z\nend_header\n0 0 0\n")},
        {"none.ply", test::bytesOf("ply\n")}};
    for (const auto& [name, bytes] : files) {
        const Error error = refused(name, bytes);
        EXPECT_FALSE(error.problem().empty()) << name;
        EXPECT_FALSE(contains(error.problem(), "crashed")) << error.what();
        EXPECT_FALSE(error.remedy().empty()) << error.what();
    }
    // The library crashes on text that says it is binary (assimp 5.2.5); whatever it does, we say what is
    // wrong.
    EXPECT_FALSE(refused("confused.ply",
                         test::bytesOf(test::plyHeader("binary_little_endian") + "0 0 0 0 0 0\n3 0 1 2\n"))
                     .problem()
                     .empty());
    EXPECT_TRUE(contains(refused("points.obj", test::bytesOf("v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2\n")).problem(),
                         "it holds no triangles"));
    EXPECT_TRUE(contains(refused("none.ply", test::bytesOf("ply\n")).problem(), "its header has no end"));
    EXPECT_TRUE(contains(refused("nan.stl", nan).problem(), "not a finite number"));
    EXPECT_TRUE(contains(refused("picture.stl", test::bytesOf("\x89PNG\r\n")).problem(), "a PNG picture"));
}

TEST_F(MeshFiles, HugeOnesAreRefusedBeforeTheyAreRead) {
    for (const char* name : {"huge.stl", "huge.ply", "huge.obj"}) {
        const fs::path huge = file(name, {});
        fs::resize_file(huge, uint64_t{4'000'000'000}); // sparse
        const Error error = test::errorOf([&] { return loadScene(huge); });
        EXPECT_TRUE(contains(error.problem(), "limit for")) << error.what();
    }
}

TEST_F(MeshFiles, AReaderThatFailsIsAnError) {
    EXPECT_TRUE(contains(refusedBy("echo 'no such shape'; exit 1").problem(), "no such shape"));
    EXPECT_TRUE(contains(refusedBy("exit 3").problem(), "status 3"));
    EXPECT_TRUE(contains(refusedBy("kill -SEGV $$").problem(), "crashed"));
    EXPECT_TRUE(contains(refusedBy("kill -KILL $$").problem(), "ended the reader"));
    EXPECT_TRUE(contains(refusedBy("exit 0").problem(), "damaged answer"));
    EXPECT_TRUE(contains(refusedBy("echo TMF1garbagegarbagegarbage").problem(), "damaged answer"));
    EXPECT_TRUE(contains(refusedBy("exec cat /dev/zero").problem(), "expand far beyond"));
    EXPECT_TRUE(contains(refusedBy("exec sleep 1000", {.seconds = 1}).problem(), "longer than 1 s"));
    EXPECT_TRUE(
        contains(refusedBy("while :; do :; done", {.processorSeconds = 1}).problem(), "processor time"));
    EXPECT_TRUE(contains(refusedBy("sleep 1000 & exit 4").problem(), "status 4"))
        << "not held up by its own child";
    const LoadOptions options;
    ImportContext context("model.stl", options);
    const Error missing = test::errorOf([&] {
        return meshAsGlb(context, test::tetrahedronBinaryStl(), MeshFormat::Stl,
                         {scratch_ / "no program", {}});
    });
    EXPECT_TRUE(contains(missing.problem(), "cannot be started")) << missing.what();
}

TEST_F(MeshFiles, AReaderThatHangsIsCancelled) {
    const fs::path program = file("reader", test::bytesOf("#!/bin/sh\nexec sleep 1000\n"));
    fs::permissions(program, fs::perms::owner_all);
    std::atomic<bool> cancel{false};
    LoadOptions options;
    options.cancel = &cancel;
    ImportContext context("model.stl", options);
    std::thread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        cancel = true;
    });
    EXPECT_THROW((void)meshAsGlb(context, test::tetrahedronBinaryStl(), MeshFormat::Stl, {program, {}}),
                 Cancelled);
    later.join();
}

TEST_F(MeshFiles, TheReaderHasNoFilesAndNoMemoryBeyondItsLimit) {
    // With 96 MiB the library's own data still fit, but no mesh of a million vertices does.
    std::string text;
    for (int i = 0; i < 1'000'000; ++i)
        text += "v 0 0 " + std::to_string(i) + "\n";
    text += "f 1 2 3\n";
    MeshReader reader = installedMeshReader(text.size());
    if (kMaxMemory > (uint64_t{1} << 62))
        GTEST_SKIP() << "a sanitizer has no limit of memory";
    reader.limits.memory = 32u << 20;
    const LoadOptions options;
    ImportContext context("model.obj", options);
    const Error error =
        test::errorOf([&] { return meshAsGlb(context, test::bytesOf(text), MeshFormat::Obj, reader); });
    EXPECT_TRUE(contains(error.problem(), "memory") || contains(error.problem(), "alloc")) << error.what();
}

} // namespace
} // namespace touchstone::mesh_file_test
