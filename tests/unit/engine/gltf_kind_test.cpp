// What is not glTF 2.0 gets its name and a way out.
#include "tests/unit/engine/load_support.h"

#include <string_view>

namespace touchstone::gltf_kind_test {
namespace {

using nlohmann::json;
using test::contains;
using test::GltfMaker;
using namespace std::string_view_literals;

Error errorOf(std::string_view text) {
    return test::errorOf([&] { return loadSceneFromMemory({text.begin(), text.end()}, "."); });
}

struct Kind {
    std::string_view bytes;
    const char* says;
    const char* remedy;
};

TEST(GltfKind, OtherFilesAreNamed) {
    const Kind kinds[] = {
        {"version https://git-lfs.github.com/spec/v1\noid sha256:12\nsize 3\n", "a Git LFS pointer",
         "git lfs pull"},
        {"<!DOCTYPE html><html>", "a web page (HTML)", "download the file itself"},
        {"\n  <HTML lang=\"en\">", "a web page (HTML)", "download the file itself"},
        {"\xEF\xBB\xBF<!doctype HTML>", "a web page (HTML)", "download the file itself"},
        {"\x1f\x8b\x08\x00"sv, "a gzip archive", "unpack"},
        {"PK\x03\x04\x14\x00"sv, "a zip archive", "unpack"},
        {"7z\xbc\xaf\x27\x1c", "a 7z archive", "unpack"},
        {"Rar!\x1a", "a RAR archive", "unpack"},
        {"\x28\xb5\x2f\xfd", "a zstd archive", "unpack"},
        {"Kaydara FBX Binary  \x00"sv, "an FBX file", "Blender"},
        {"; FBX 7.3.0 project file\n", "an FBX file", "Blender"},
        {"<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"\">", "a COLLADA file", "Blender"},
        {"<?xml version=\"1.0\"?><svg/>", "an XML file", "open a .gltf"},
        {"BLENDER-v300", "a Blender file", "export"},
        {"\x89PNG\r\n", "a PNG picture", "open a .gltf"},
    };
    for (const Kind& kind : kinds) {
        const Error error = errorOf(kind.bytes);
        EXPECT_TRUE(contains(error.problem(), std::string("is ") + kind.says + ",")) << error.what();
        EXPECT_TRUE(contains(error.problem(), "not a glTF file")) << error.what();
        EXPECT_TRUE(contains(error.remedy(), kind.remedy)) << error.what();
    }
}

TEST(GltfKind, WhatNobodyKnowsIsStillNoGltf) {
    for (const std::string_view text :
         {"x"sv, "v 1"sv, "verse one\nf\n"sv, "\x00\x01\x02"sv, "solid"sv, "   "sv})
        EXPECT_TRUE(contains(errorOf(text).problem(), "not a glTF file")) << errorOf(text).what();
}

TEST(GltfKind, GltfOneIsNamedWithAWayOut) {
    for (const std::string_view text :
         {R"({"asset": {"version": "1.0"}, "buffers": {"a": {"uri": "a.bin"}}})"sv,
          R"({"asset": {"version": "1.1"}})"sv, R"({"asset": {"version": 1.0}})"sv,
          R"({"buffers": {}, "accessors": {"a": {}}})"sv,
          R"({"asset": {"generator": "x"}, "meshes": {"m": {}}})"sv}) {
        const Error error = errorOf(text);
        EXPECT_TRUE(contains(error.problem(), "glTF 1.0")) << error.what();
        EXPECT_TRUE(contains(error.remedy(), "gltf-pipeline")) << error.what();
    }
    std::vector<uint8_t> glb = GltfMaker::square().glb();
    glb[4] = 1;
    const Error error = test::errorOf([&] { return loadSceneFromMemory(glb, "."); });
    EXPECT_TRUE(contains(error.problem(), "glTF 1.0")) << error.what();
    EXPECT_TRUE(contains(error.remedy(), "gltf-pipeline")) << error.what();
}

TEST(GltfKind, ANumberThatNoDoubleHoldsIsNamed) {
    const Error error = errorOf(R"({"asset": {"version": "2.0"}, "cameras": [{"znear": 1e999}]})");
    EXPECT_TRUE(contains(error.problem(), "1e999")) << error.what();
    EXPECT_TRUE(contains(error.problem(), "at byte 5")) << error.what();
    EXPECT_TRUE(contains(error.remedy(), "correct the number")) << error.what();
}

} // namespace
} // namespace touchstone::gltf_kind_test
