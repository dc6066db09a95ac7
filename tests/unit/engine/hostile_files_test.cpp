// Files that the official validator was tested with, most of them wrong in one way. The table says what we
// make of each and why: a fault in geometry, images or structure that we use is refused, with its place; what
// we do not use loads, and what is odd about it is told. Image data that are missing or broken never refuse a
// model. None of them shows a triangle, so that all that load say "nothing to touch".
#include "tests/support/shared_files.h"
#include "tests/unit/engine/load_support.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <set>

namespace touchstone {
namespace {

enum class Outcome { Loads, Warned, Refused };

struct HostileFile {
    const char* path;
    Outcome outcome;
    const char* place; ///< of the error or of one of the warnings
    const char* says;  ///< part of its text
    const char* why;
};

// clang-format off
constexpr HostileFile kHostileFiles[] = {
    {"accessor_data/get_elements.gltf", Outcome::Loads, "", "", "valid"},
    {"accessor_data/get_elements_matrix.gltf", Outcome::Loads, "", "", "valid; the last matrix column needs no padding"},
    {"accessor_data/get_elements_sparse.gltf", Outcome::Loads, "", "", "valid"},
    {"accessor_data/invalid_elements_float.gltf", Outcome::Warned, "accessors[0]", "3 of its numbers are not finite", "no mesh reads the accessor; a mesh that did would be refused"},
    {"accessor_data/out_of_range_elements_float.gltf", Outcome::Warned, "accessors[0].min", "does not hold: there are smaller values. It is", "declared bounds are not used; ours are computed"},
    {"accessor_data/out_of_range_elements_sint16.gltf", Outcome::Warned, "accessors[0].min", "does not hold: there are smaller values. It is", "declared bounds are not used; ours are computed"},
    {"accessor_data/out_of_range_elements_sint8.gltf", Outcome::Warned, "accessors[0].min", "does not hold: there are smaller values. It is", "declared bounds are not used; ours are computed"},
    {"accessor_data/out_of_range_elements_uint16.gltf", Outcome::Warned, "accessors[0].min", "does not hold: there are smaller values. It is", "declared bounds are not used; ours are computed"},
    {"accessor_data/out_of_range_elements_uint32.gltf", Outcome::Warned, "accessors[0].min", "does not hold: there are smaller values. It is", "declared bounds are not used; ours are computed"},
    {"accessor_data/out_of_range_elements_uint8.gltf", Outcome::Warned, "accessors[0].min", "does not hold: there are smaller values. It is", "declared bounds are not used; ours are computed"},
    {"animation_data/invalid_input_values.gltf", Outcome::Refused, "animations[0].samplers[0].input", "time 0 is negative", "we play node animations"},
    {"animation_data/quaternion_cubic_non_unit_values.gltf", Outcome::Refused, "animations[0].samplers[0].input", "time 1 is not after the one before it", "we play node animations"},
    {"animation_data/quaternion_non_unit_values.gltf", Outcome::Refused, "animations[0].samplers[0].input", "time 1 is not after the one before it", "we play node animations"},
    {"buffer/custom_property.gltf", Outcome::Loads, "", "", "valid: a buffer may be declared without bytes"},
    {"buffer/data_uri.glb", Outcome::Loads, "", "", "valid"},
    {"buffer/empty_array.gltf", Outcome::Refused, "buffers", "is empty", "buffers are used"},
    {"buffer/empty_object.gltf", Outcome::Refused, "buffers[0]", "property 'byteLength' is missing", "buffers are used"},
    {"buffer/extra_padding.glb", Outcome::Loads, "", "", "valid"},
    {"buffer/invalid_object.gltf", Outcome::Refused, "buffers[0]", "should be an object but is an array", "buffers are used"},
    {"buffer/invalid_uri_data.glb", Outcome::Refused, "buffers[0].uri", "the data URI is malformed: it has no comma bef", "buffers are used"},
    {"buffer/invalid_uri_data.gltf", Outcome::Refused, "buffers[0].uri", "the data URI is malformed: a parameter has no", "buffers are used"},
    {"buffer/invalid_uri_data_bytelength.gltf", Outcome::Refused, "buffers[1]", "property 'byteLength' is missing", "buffers are used"},
    {"buffer/invalid_uri_data_mime.gltf", Outcome::Refused, "buffers[0].uri", "the data URI of a buffer must be application/o", "the report calls the media type of a buffer an error"},
    {"buffer/invalid_uri_scheme.gltf", Outcome::Refused, "buffers[0].uri", "the URI \":\" has a scheme; only files in the mo", "buffers are used"},
    {"buffer/no_bin_chunk.glb", Outcome::Refused, "buffers[0]", "is the GLB's binary chunk, but the file has no", "buffers are used"},
    {"buffer/non_relative_uri.gltf", Outcome::Refused, "buffers[0].uri", "the URI \"http://example.com/buffer.bin\" has a", "only a warning in the report, but nothing outside the folder is read"},
    {"buffer/not_found.gltf", Outcome::Refused, "buffers[0].uri", "the file \"not_found.bin\" is missing", "buffers are used"},
    {"buffer/valid.glb", Outcome::Loads, "", "", "valid"},
    {"buffer/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"buffer/valid_placeholder.glb", Outcome::Loads, "", "", "valid: a buffer may be declared without bytes"},
    {"buffer/wrong_bytelength.glb", Outcome::Refused, "buffers[0]", "has 16 bytes, but byteLength says 17", "buffers are used"},
    {"buffer/zero_bytelength.gltf", Outcome::Refused, "buffers[0].byteLength", "0 is out of range, it must be at least 1", "buffers are used"},
    {"camera/custom_property.gltf", Outcome::Loads, "", "", "cameras are not used"},
    {"camera/empty_array.gltf", Outcome::Warned, "cameras", "is not an array with entries; it is not used h", "cameras are not used"},
    {"camera/empty_objects.gltf", Outcome::Loads, "", "", "cameras are not used"},
    {"camera/extra_type.gltf", Outcome::Loads, "", "", "cameras are not used"},
    {"camera/infinite_znear.gltf", Outcome::Refused, "", "not a glTF file, or a damaged one: number over", "cameras are not used, but a number that no double holds makes the JSON unreadable"},
    {"camera/orthographic_xy.gltf", Outcome::Loads, "", "", "cameras are not used"},
    {"camera/orthographic_z.gltf", Outcome::Loads, "", "", "cameras are not used"},
    {"camera/perspective_yfov.gltf", Outcome::Loads, "", "", "cameras are not used"},
    {"camera/perspective_z.gltf", Outcome::Loads, "", "", "cameras are not used"},
    {"camera/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"image/buffer_view_bytestride.gltf", Outcome::Refused, "images[0].bufferView", "the buffer view of an image must have no byteS", "structure of an image, not its data"},
    {"image/custom_property.gltf", Outcome::Loads, "", "", "valid"},
    {"image/data_uri.glb", Outcome::Loads, "", "", "valid"},
    {"image/empty_array.gltf", Outcome::Refused, "images", "is empty", "structure of an image, not its data"},
    {"image/empty_object.gltf", Outcome::Refused, "images[0]", "has neither a uri nor a bufferView", "structure of an image, not its data"},
    {"image/invalid_data_uri.gltf", Outcome::Refused, "images[0].uri", "the data URI is malformed: its base64 is broke", "a malformed URI is structure, not image data"},
    {"image/invalid_data_uri_mime_type.gltf", Outcome::Warned, "images[0]", "is declared as image/gif but holds png", "the data decode: the content counts, not its label"},
    {"image/invalid_image_data.gltf", Outcome::Warned, "images[0]", "the image cannot be used: JPEG error: Prematur", "broken image data: the model still loads"},
    {"image/invalid_object.gltf", Outcome::Refused, "images[0]", "should be an object but is an array", "structure of an image, not its data"},
    {"image/invalid_uri_scheme.gltf", Outcome::Refused, "images[0].uri", "the URI \":\" has a scheme; only files in the mo", "structure of an image, not its data"},
    {"image/missing_mime_type_buffer_view.gltf", Outcome::Refused, "images[0]", "has a bufferView but no mimeType", "structure of an image, not its data"},
    {"image/not_found.gltf", Outcome::Warned, "images[0]", "the image cannot be used: \"not_found.png\": the", "a missing image: the model still loads"},
    {"image/npot.gltf", Outcome::Loads, "", "", "valid"},
    {"image/png_eos.gltf", Outcome::Warned, "images[0]", "the image cannot be used: Read error: hit end", "broken image data: the model still loads"},
    {"image/unrecognized_format.gltf", Outcome::Warned, "images[0]", "the image cannot be used: its format is not kn", "broken image data: the model still loads"},
    {"image/unresolved_buffer_view.gltf", Outcome::Refused, "images[0].bufferView", "refers to bufferViews[0], but there are 0 of t", "structure of an image, not its data"},
    {"image/valid.glb", Outcome::Loads, "", "", "valid"},
    {"image/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"material/alpha_modes.gltf", Outcome::Loads, "", "", "valid"},
    {"material/custom_property.gltf", Outcome::Warned, "textures[0]", "has no image that can be read; drawn and felt", "valid but for a property that nobody knows; its texture has no image"},
    {"material/empty_array.gltf", Outcome::Refused, "materials", "is empty", "a texture that we would draw or feel"},
    {"material/empty_object.gltf", Outcome::Loads, "", "", "valid"},
    {"material/multiple_extensions.gltf", Outcome::Warned, "materials[0].extensions.KHR_materials_unlit", "is drawn, and KHR_materials_clearcoat is not", "extensions that exclude each other"},
    {"material/unresolved_basecolor.gltf", Outcome::Refused, "materials[0].pbrMetallicRoughness.baseColorTexture.index", "refers to textures[0], but there are 0 of them", "a texture that we would draw or feel"},
    {"material/unresolved_emissive.gltf", Outcome::Refused, "materials[0].emissiveTexture.index", "refers to textures[0], but there are 0 of them", "a texture that we would draw or feel"},
    {"material/unresolved_mr.gltf", Outcome::Refused, "materials[0].pbrMetallicRoughness.metallicRoughnessTexture.index", "refers to textures[0], but there are 0 of them", "a texture that we would draw or feel"},
    {"material/unresolved_normal.gltf", Outcome::Refused, "materials[0].normalTexture.index", "refers to textures[0], but there are 0 of them", "a texture that we would draw or feel"},
    {"material/unresolved_occlusion.gltf", Outcome::Refused, "materials[0].occlusionTexture.index", "refers to textures[0], but there are 0 of them", "a texture that we would draw or feel"},
    {"material/valid.gltf", Outcome::Warned, "textures[0]", "has no image that can be read; drawn and felt", "valid; but textures without image and UV sets beyond the second are not shown"},
    {"mesh_data/colors_non_clamped.gltf", Outcome::Warned, "meshes[0].primitives[0].attributes.COLOR_0", "2 colours are outside 0..1 and were clamped", "neither geometry nor structure; clamped"},
    {"mesh_data/index_buffer_degenerate_triangle.gltf", Outcome::Warned, "meshes[0].primitives[0]", "3 triangles use a vertex twice and were droppe", "an information in the report, no error"},
    {"mesh_data/index_buffer_oob.gltf", Outcome::Refused, "meshes[0].primitives[0].indices", "index 5 exceeds 3, the last vertex", "geometry"},
    {"mesh_data/index_buffer_primitive_restart.gltf", Outcome::Refused, "meshes[0].primitives[0].indices", "index 2 is 255, the primitive-restart value, w", "geometry"},
    {"mesh_data/joints_no_weights.gltf", Outcome::Refused, "bufferViews[0]", "reaches to byte 32 of a buffer of 16 bytes", "geometry"},
    {"mesh_data/joints_weights_complex.gltf", Outcome::Warned, "meshes[0].primitives[0]", "holds points or lines: they are drawn, but cannot be touched", "joints are not used: skins stay in their rest pose; its primitive is points"},
    {"mesh_data/normals_tangents_non_unit_invalid_sign.gltf", Outcome::Refused, "meshes[0].primitives[0].attributes.TANGENT", "vertex 1 has w = 0.0, it must be 1 or -1", "geometry"},
    {"root/custom_property.gltf", Outcome::Loads, "", "", "valid"},
    {"root/custom_property_escaped_name.gltf", Outcome::Loads, "", "", "valid"},
    {"root/duplicate_extension_entry.gltf", Outcome::Warned, "extensionsRequired", "KHR_materials_unlit is named twice", "naming an extension twice changes nothing"},
    {"root/empty_object.gltf", Outcome::Refused, "root", "property 'asset' is missing", "structure"},
    {"root/extensions_non_objects.gltf", Outcome::Loads, "", "", "extensions that nobody knows are not read"},
    {"root/extensions_undeclared_wrong_pointer.gltf", Outcome::Loads, "", "", "an extension that nobody knows is not read"},
    {"root/extras_non_object.gltf", Outcome::Loads, "", "", "valid"},
    {"root/invalid_array_elements.gltf", Outcome::Refused, "samplers[0]", "should be an object but is a string", "structure"},
    {"root/invalid_collection_type.gltf", Outcome::Refused, "samplers", "should be an array but is an object", "structure"},
    {"root/invalid_extension_name.gltf", Outcome::Loads, "", "", "valid"},
    {"root/named_objects.gltf", Outcome::Warned, "meshes[0].primitives[0]", "its buffer is declared without data: the mesh", "valid; its buffer is declared without bytes"},
    {"root/undefined_used_extensions.gltf", Outcome::Refused, "extensionsRequired", "the file needs the extension KHR_extension, wh", "demands an extension that we do not have"},
    {"root/unused_objects.gltf", Outcome::Warned, "meshes[0].primitives[0]", "its buffer is declared without data: the mesh", "valid; its buffer is declared without bytes"},
    {"root/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"scene/custom_property.gltf", Outcome::Loads, "", "", "valid"},
    {"scene/empty_array.gltf", Outcome::Refused, "scenes", "is empty", "structure"},
    {"scene/empty_nodes_array.gltf", Outcome::Refused, "scenes[0].nodes", "is empty", "structure"},
    {"scene/non_root_node.gltf", Outcome::Refused, "scenes[0].nodes[0]", "nodes[1] is not a root: it is a child of nodes", "structure"},
    {"scene/unresolved_child_node.gltf", Outcome::Refused, "nodes[0].children[0]", "refers to nodes[5], but there is 1 of them", "structure"},
    {"scene/unresolved_default_scene.gltf", Outcome::Refused, "scene", "refers to scenes[0], but there are 0 of them", "structure"},
    {"scene/unresolved_node.gltf", Outcome::Refused, "scenes[0].nodes[0]", "refers to nodes[0], but there are 0 of them", "structure"},
    {"scene/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"skin_data/invalid_ibm.gltf", Outcome::Loads, "", "", "skins are not used"},
    {"tinygltf/issue-416.gltf", Outcome::Refused, "asset.version", "glTF version \"\" is not supported", "no report; its version is empty and its URI malformed"},
};
// clang-format on

void PrintTo(const HostileFile& file, std::ostream* out) {
    *out << file.path;
}

constexpr long kMemoryLimitKilobytes = 1l << 20; // 1 GiB
constexpr unsigned kHangSeconds = 120; // an alarm for a loader that never returns, not a measure of speed

/// Loads in a child, so that a crash is a failed test and peak memory is the child's own.
/// Returns 0 loaded, 1 refused; anything else is a crash, a hang or a foreign exception.
int loadInChild(const std::filesystem::path& path, long& peakKilobytes) {
    const pid_t child = fork();
    if (child == 0) {
        alarm(kHangSeconds);
        try {
            (void)loadScene(path);
            _exit(0);
        } catch (const Error&) {
            _exit(1);
        } catch (...) {
            _exit(99);
        }
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    peakKilobytes = usage.ru_maxrss;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

class Hostile : public testing::TestWithParam<HostileFile> {};

TEST_P(Hostile, EndsAsTheTableSays) {
    const auto folder = test::hostileFolder();
    if (!folder)
        GTEST_SKIP() << test::kNoHostileFiles;
    const HostileFile& expected = GetParam();
    const auto path = *folder / expected.path;
    long peak = 0;
    const int ended = loadInChild(path, peak);
    ASSERT_EQ(ended, expected.outcome == Outcome::Refused ? 1 : 0) << expected.why;
    EXPECT_LT(peak, kMemoryLimitKilobytes);

    if (expected.outcome == Outcome::Refused) {
        const Error error = test::errorOf([&] { return loadScene(path); });
        EXPECT_EQ(error.file(), path.string());
        EXPECT_EQ(error.place(), expected.place);
        EXPECT_TRUE(test::contains(error.problem(), expected.says)) << error.what();
        EXPECT_FALSE(error.remedy().empty());
        return;
    }
    const ScenePtr scene = loadScene(path);
    EXPECT_FALSE(scene->touchable());
    EXPECT_TRUE(test::warns(*scene, "", "nothing to touch"));
    if (expected.outcome == Outcome::Warned)
        EXPECT_TRUE(test::warns(*scene, expected.place, expected.says)) << expected.says;
    else
        EXPECT_EQ(scene->warnings.size(), 1u) << scene->warnings[0].message;
}

INSTANTIATE_TEST_SUITE_P(Table, Hostile, testing::ValuesIn(kHostileFiles));

TEST(HostileTable, HasEveryFile) {
    const auto folder = test::hostileFolder();
    if (!folder)
        GTEST_SKIP() << test::kNoHostileFiles;
    std::set<std::string> listed;
    for (const HostileFile& file : kHostileFiles)
        EXPECT_TRUE(listed.insert(file.path).second) << file.path;
    for (const auto& path : test::gltfFilesIn(*folder)) {
        const std::string name = std::filesystem::relative(path, *folder).generic_string();
        EXPECT_TRUE(listed.contains(name)) << name << " is not in the table";
    }
}

} // namespace
} // namespace touchstone
