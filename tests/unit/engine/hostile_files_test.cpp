// Files that the official validator was tested with, most of them wrong in one way. The table says what we
// make of each and why: a fault in geometry is refused, with its place; what is wrong elsewhere (looks,
// images, animations, names) is left out or mended, and told. None of them shows a triangle, so that all that
// load say "nothing to touch". What the validator's own report calls an error or a warning is refused or told
// here too.
#include "tests/support/shared_files.h"
#include "tests/unit/engine/load_support.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

namespace touchstone::hostile_files_test {
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
    {"animation_data/invalid_input_values.gltf", Outcome::Warned, "animations[0].samplers[0].input", "1 times are negative; what is before 0 is not", "played from 0 on, without the keys that do not ascend"},
    {"animation_data/quaternion_cubic_non_unit_values.gltf", Outcome::Warned, "animations[0].samplers[0].input", "times are not after the one before; their keys", "keys that do not ascend are skipped; a rotation of the others is normalised"},
    {"animation_data/quaternion_non_unit_values.gltf", Outcome::Warned, "animations[0].samplers[0].input", "times are not after the one before; their keys", "keys that do not ascend are skipped; a rotation of the others is normalised"},
    {"buffer/custom_property.gltf", Outcome::Warned, "buffers[0].customProperty", "is not a property of glTF; it is ignored", "a property that nobody knows"},
    {"buffer/data_uri.glb", Outcome::Loads, "", "", "valid"},
    {"buffer/empty_array.gltf", Outcome::Warned, "buffers", "is empty: the specification asks for at least on", "nothing is missing"},
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
    {"buffer/zero_bytelength.gltf", Outcome::Warned, "buffers[0]", "has no bytes", "nothing reads it"},
    {"camera/custom_property.gltf", Outcome::Warned, "cameras[0].customProperty", "is not a property of glTF; it is ignored", "a property that nobody knows"},
    {"camera/empty_array.gltf", Outcome::Warned, "cameras", "is empty: the specification asks for at least on", "nothing is missing"},
    {"camera/empty_objects.gltf", Outcome::Warned, "cameras[0]", "property 'type' is missing; it is left out", "a camera without a lens: the model still loads"},
    {"camera/extra_type.gltf", Outcome::Warned, "cameras[0]", "has both a perspective and an orthographic lens", "its type chooses"},
    {"camera/infinite_znear.gltf", Outcome::Refused, "", "the JSON holds a number beyond all that computers", "a number that no double holds makes the JSON unreadable"},
    {"camera/orthographic_xy.gltf", Outcome::Warned, "cameras[0].orthographic.ymag", "is 0: the picture would have no area", "a camera without a picture: the model still loads"},
    {"camera/orthographic_z.gltf", Outcome::Warned, "cameras[0].orthographic.zfar", "is not beyond znear", "a camera that sees nothing: the model still loads"},
    {"camera/perspective_yfov.gltf", Outcome::Warned, "cameras[0].perspective.yfov", "is out of range, it must be below pi", "a camera that no picture has: the model still loads"},
    {"camera/perspective_z.gltf", Outcome::Warned, "cameras[0].perspective.zfar", "is not beyond znear", "a camera that sees nothing: the model still loads"},
    {"camera/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"image/buffer_view_bytestride.gltf", Outcome::Warned, "images[0].bufferView", "has a byteStride, which the buffer view of an im", "the image is read all the same; its buffer is declared without bytes"},
    {"image/custom_property.gltf", Outcome::Warned, "images[0].customProperty", "is not a property of glTF; it is ignored", "a property that nobody knows"},
    {"image/data_uri.glb", Outcome::Loads, "", "", "valid"},
    {"image/empty_array.gltf", Outcome::Warned, "images", "is empty: the specification asks for at least on", "nothing is missing"},
    {"image/empty_object.gltf", Outcome::Warned, "images[0]", "the image cannot be used: it has neither a uri n", "an image without data: the model still loads"},
    {"image/invalid_data_uri.gltf", Outcome::Warned, "images[0]", "the image cannot be used: the data URI is malfor", "an image without data: the model still loads"},
    {"image/invalid_data_uri_mime_type.gltf", Outcome::Warned, "images[0]", "is declared as image/gif but holds png", "the data decode: the content counts, not its label"},
    {"image/invalid_image_data.gltf", Outcome::Warned, "images[0]", "the image cannot be used: JPEG error: Prematur", "broken image data: the model still loads"},
    {"image/invalid_object.gltf", Outcome::Warned, "images[0]", "should be an object but is an array; it is left ", "an image without data: the model still loads"},
    {"image/invalid_uri_scheme.gltf", Outcome::Warned, "images[0]", "the image cannot be used: the URI \":\" has a sche", "an image that is not read: the model still loads"},
    {"image/missing_mime_type_buffer_view.gltf", Outcome::Warned, "images[0]", "has a bufferView but no mimeType", "the content counts, not its label"},
    {"image/not_found.gltf", Outcome::Warned, "images[0]", "the image cannot be used: \"not_found.png\": the", "a missing image: the model still loads"},
    {"image/npot.gltf", Outcome::Loads, "", "", "valid"},
    {"image/png_eos.gltf", Outcome::Warned, "images[0]", "the image cannot be used: Read error: hit end", "broken image data: the model still loads"},
    {"image/unrecognized_format.gltf", Outcome::Warned, "images[0]", "the image cannot be used: its format is not kn", "broken image data: the model still loads"},
    {"image/unresolved_buffer_view.gltf", Outcome::Warned, "images[0].bufferView", "refers to bufferViews[0], but there are 0 of the", "an image without data: the model still loads"},
    {"image/valid.glb", Outcome::Loads, "", "", "valid"},
    {"image/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"material/alpha_modes.gltf", Outcome::Loads, "", "", "valid"},
    {"material/custom_property.gltf", Outcome::Warned, "textures[0]", "has no image that can be read; drawn and felt", "valid but for a property that nobody knows; its texture has no image"},
    {"material/empty_array.gltf", Outcome::Warned, "materials", "is empty: the specification asks for at least on", "nothing is missing"},
    {"material/empty_object.gltf", Outcome::Loads, "", "", "valid"},
    {"material/multiple_extensions.gltf", Outcome::Warned, "materials[0].extensions.KHR_materials_unlit", "is drawn, and KHR_materials_clearcoat is not", "extensions that exclude each other"},
    {"material/unresolved_basecolor.gltf", Outcome::Warned, "materials[0].pbrMetallicRoughness.baseColorTexture.index", "refers to textures[0], but there are 0 of them; ", "drawn and felt without the texture"},
    {"material/unresolved_emissive.gltf", Outcome::Warned, "materials[0].emissiveTexture.index", "refers to textures[0], but there are 0 of them; ", "drawn and felt without the texture"},
    {"material/unresolved_mr.gltf", Outcome::Warned, "materials[0].pbrMetallicRoughness.metallicRoughnessTexture.index", "refers to textures[0], but there are 0 of them; ", "drawn and felt without the texture"},
    {"material/unresolved_normal.gltf", Outcome::Warned, "materials[0].normalTexture.index", "refers to textures[0], but there are 0 of them; ", "drawn and felt without the texture"},
    {"material/unresolved_occlusion.gltf", Outcome::Warned, "materials[0].occlusionTexture.index", "refers to textures[0], but there are 0 of them; ", "drawn and felt without the texture"},
    {"material/valid.gltf", Outcome::Warned, "textures[0]", "has no image that can be read; drawn and felt", "valid; but textures without image and UV sets beyond the second are not shown"},
    {"mesh_data/colors_non_clamped.gltf", Outcome::Warned, "meshes[0].primitives[0].attributes.COLOR_0", "2 colours are outside 0..1 and were clamped", "neither geometry nor structure; clamped"},
    {"mesh_data/index_buffer_degenerate_triangle.gltf", Outcome::Warned, "meshes[0].primitives[0]", "3 triangles use a vertex twice and were droppe", "an information in the report, no error"},
    {"mesh_data/index_buffer_oob.gltf", Outcome::Refused, "meshes[0].primitives[0].indices", "index 5 exceeds 3, the last vertex", "geometry"},
    {"mesh_data/index_buffer_primitive_restart.gltf", Outcome::Warned, "meshes[0].primitives[0].indices", "index 2 is 255, the primitive-restart value, whi", "there is a vertex of that number"},
    {"mesh_data/joints_no_weights.gltf", Outcome::Refused, "bufferViews[0]", "reaches to byte 32 of a buffer of 16 bytes", "geometry"},
    {"mesh_data/joints_weights_complex.gltf", Outcome::Refused, "meshes[0].primitives[0].attributes.JOINTS_1", "vertex 1 follows joint 9.0, but skins[0] has 9", "geometry: the vertex weighs on a joint that does not exist"},
    {"mesh_data/normals_tangents_non_unit_invalid_sign.gltf", Outcome::Warned, "meshes[0].primitives[0].attributes.TANGENT", "1 have a w that is neither 1 nor -1; all are com", "the shape is the same; tangents are generated"},
    {"root/custom_property.gltf", Outcome::Warned, "customProperty", "is not a property of glTF; it is ignored", "a property that nobody knows"},
    {"root/custom_property_escaped_name.gltf", Outcome::Warned, "asset/customProperty", "is not a property of glTF; it is ignored", "a property that nobody knows"},
    {"root/duplicate_extension_entry.gltf", Outcome::Warned, "extensionsRequired", "KHR_materials_unlit is named twice", "naming an extension twice changes nothing"},
    {"root/empty_object.gltf", Outcome::Refused, "root", "property 'asset' is missing", "structure"},
    {"root/extensions_non_objects.gltf", Outcome::Warned, "extensions.KHR_invalid1", "should be an object", "extensions that nobody knows are not read"},
    {"root/extensions_undeclared_wrong_pointer.gltf", Outcome::Warned, "extensions", "EXT_undeclared_extension is used but not named i", "an extension that nobody knows is not read"},
    {"root/extras_non_object.gltf", Outcome::Loads, "", "", "valid"},
    {"root/invalid_array_elements.gltf", Outcome::Warned, "samplers[0]", "should be an object but is a string; it is left ", "looks are left out"},
    {"root/invalid_collection_type.gltf", Outcome::Warned, "samplers", "should be an array but is an object; it is ignor", "looks are left out"},
    {"root/invalid_extension_name.gltf", Outcome::Warned, "extensionsUsed", "_extension is not supported: what it adds is lef", "an extension that nobody knows is not read"},
    {"root/named_objects.gltf", Outcome::Warned, "meshes[0].primitives[0]", "its buffer is declared without data: the mesh", "valid; its buffer is declared without bytes"},
    {"root/undefined_used_extensions.gltf", Outcome::Refused, "extensionsRequired", "the file needs the extension KHR_extension, wh", "demands an extension that we do not have"},
    {"root/unused_objects.gltf", Outcome::Warned, "meshes[0].primitives[0]", "its buffer is declared without data: the mesh", "valid; its buffer is declared without bytes"},
    {"root/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"scene/custom_property.gltf", Outcome::Warned, "scenes[0].customProperty", "is not a property of glTF; it is ignored", "a property that nobody knows"},
    {"scene/empty_array.gltf", Outcome::Warned, "scenes", "is empty: the specification asks for at least on", "as without scenes, all nodes are shown"},
    {"scene/empty_nodes_array.gltf", Outcome::Warned, "scenes[0].nodes", "is empty: the specification asks for at least on", "a scene that shows nothing"},
    {"scene/non_root_node.gltf", Outcome::Warned, "scenes[0].nodes[0]", "nodes[1] is not a root: it is a child of nodes[0", "it is shown where its parent puts it"},
    {"scene/unresolved_child_node.gltf", Outcome::Refused, "nodes[0].children[0]", "refers to nodes[5], but there is 1 of them", "structure"},
    {"scene/unresolved_default_scene.gltf", Outcome::Refused, "scene", "refers to scenes[0], but there are 0 of them", "structure"},
    {"scene/unresolved_node.gltf", Outcome::Refused, "scenes[0].nodes[0]", "refers to nodes[0], but there are 0 of them", "structure"},
    {"scene/valid.gltf", Outcome::Loads, "", "", "valid"},
    {"skin_data/invalid_ibm.gltf", Outcome::Loads, "", "", "no node shows a mesh with the skin"},
    {"tinygltf/issue-416.gltf", Outcome::Refused, "asset.version", "glTF version \"\" is not supported", "no report; its version is empty and its URI malformed"},
};
// clang-format on

void PrintTo(const HostileFile& file, std::ostream* out) {
    *out << file.path;
}

constexpr long kMemoryLimitKilobytes = 1l << 20; // 1 GiB
constexpr unsigned kHangSeconds = 120; // an alarm for a loader that never returns, not a measure of speed

/// Of this process, with which a child begins.
long residentKilobytes() {
    long pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

/// Loads in a child, so that a crash is a failed test and peak memory is what the child takes.
/// Returns 0 loaded, 1 refused; anything else is a crash, a hang or a foreign exception.
int loadInChild(const std::filesystem::path& path, long& peakKilobytes) {
    const long before = residentKilobytes();
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
    peakKilobytes = usage.ru_maxrss - before;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

/// Messages of the validator about what does not show in what we draw or feel, nor can.
struct Exempt {
    const char* code;    ///< empty: any
    const char* pointer; ///< what the message's pointer begins with
    const char* why;
};
constexpr Exempt kExempt[] = {
    {"", "/cameras", "cameras are not used"},
    {"ACCESSOR_INVALID_IBM", "/skins", "no node wears the skin"},
    {"DATA_URI_GLB", "", "where the bytes are"},
    {"BUFFER_GLB_CHUNK_TOO_BIG", "", "padding"},
    {"INVALID_EXTENSION_NAME_FORMAT", "", "a name"},
    {"MATERIAL_ALPHA_CUTOFF_INVALID_MODE", "", "the mode says that the value is not used"},
};

struct Complaint {
    std::string code, pointer, message;
};

/// The errors and warnings of the report beside `path`, but for the exempt ones; none without a report.
std::vector<Complaint> complaintsOf(const std::filesystem::path& path) {
    std::ifstream stream(path.string() + ".report.json");
    std::vector<Complaint> complaints;
    if (!stream)
        return complaints;
    const nlohmann::json report = nlohmann::json::parse(stream);
    constexpr int kWarning = 1; // 0 error, 1 warning, 2 information, 3 hint
    for (const nlohmann::json& each : report.at("issues").at("messages")) {
        const Complaint complaint{each.at("code"), each.value("pointer", ""), each.at("message")};
        const bool exempt = std::ranges::any_of(kExempt, [&](const Exempt& e) {
            return (*e.code == '\0' || complaint.code == e.code) && complaint.pointer.starts_with(e.pointer);
        });
        if (each.at("severity") <= kWarning && !exempt)
            complaints.push_back(complaint);
    }
    return complaints;
}

/// "/accessors/0/min" is about "accessors".
std::string arrayOf(const std::string& pointer) {
    const std::string rest = pointer.substr(std::min<size_t>(1, pointer.size()));
    std::string name = rest.substr(0, rest.find('/'));
    if (const size_t slash = name.find("~1"); slash != std::string::npos)
        name.replace(slash, 2, "/");
    return name;
}

/// What the official validator calls an error or a warning is told in the same place.
void expectComplaintsTold(const std::filesystem::path& path, const Scene& scene) {
    for (const Complaint& complaint : complaintsOf(path)) {
        const std::string array = arrayOf(complaint.pointer);
        EXPECT_TRUE(std::ranges::any_of(scene.warnings,
                                        [&](const Warning& warning) {
                                            return !warning.place.empty() && warning.place.starts_with(array);
                                        }))
            << complaint.code << " " << complaint.pointer << ": " << complaint.message << "\nwarnings:\n"
            << test::warningsOf(scene);
    }
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
        EXPECT_TRUE(test::warns(*scene, expected.place, expected.says)) << test::warningsOf(*scene);
    else
        EXPECT_EQ(scene->warnings.size(), 1u) << test::warningsOf(*scene);
    expectComplaintsTold(path, *scene);
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
} // namespace touchstone::hostile_files_test
