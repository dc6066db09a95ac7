#include "engine/import/materials/gltf_document.h"

#include "engine/import/materials/gltf_mpeg.h"

namespace touchstone {
namespace {

using nlohmann::json;

void stripExtras(json& value) {
    if (value.is_object()) {
        value.erase("extras");
        value.erase("extensions");
    }
    if (value.is_structured())
        for (json& child : value)
            stripExtras(child);
}

bool readNoImage(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                 void*) {
    return true;
}

/// No file is there and none is written. tinygltf 2.9 has one function more than 2.5, and without it takes
/// none.
template <class Callbacks>
Callbacks noFiles(Callbacks callbacks) {
    callbacks.FileExists = [](const std::string&, void*) { return false; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) {
        return false;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                                  void*) { return false; };
    if constexpr (requires { callbacks.GetFileSizeInBytes; })
        callbacks.GetFileSizeInBytes = [](size_t*, std::string*, const std::string&, void*) { return false; };
    return callbacks;
}

tinygltf::Model typedModel(const ImportContext& context, const json& gltf) {
    json core = json::object();
    for (const char* name : {"asset", "bufferViews", "accessors", "samplers", "textures", "materials",
                             "meshes", "nodes", "scenes", "scene", "animations"}) {
        const auto found = gltf.find(name);
        if (found != gltf.end())
            core[name] = *found;
    }
    stripExtras(core);
    // tinygltf refuses index accessors without a buffer view, which Draco and sparse accessors may have: it
    // gets the primitives without indices, which are restored in the model below.
    if (core.contains("meshes"))
        for (json& mesh : core["meshes"])
            if (mesh.contains("primitives"))
                for (json& primitive : mesh["primitives"])
                    primitive.erase("indices");
    // It also refuses strides that are no multiple of four, which the import reads with a warning: they are
    // restored below too.
    if (core.contains("bufferViews"))
        for (json& view : core["bufferViews"])
            view.erase("byteStride");
    const std::string text = core.dump();
    core = nullptr;

    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(readNoImage, nullptr);
    reader.SetFsCallbacks(noFiles(tinygltf::FsCallbacks{}));

    tinygltf::Model model;
    std::string error, warning;
    if (!reader.LoadASCIIFromString(&model, &error, &warning, text.c_str(),
                                    static_cast<unsigned>(text.size()), ""))
        context.fail("", error.empty() ? "is no valid glTF" : error);
    for (size_t v = 0; v < model.bufferViews.size(); ++v)
        model.bufferViews[v].byteStride = gltf["bufferViews"][v].value("byteStride", size_t{0});
    for (size_t m = 0; m < model.meshes.size(); ++m)
        for (size_t p = 0; p < model.meshes[m].primitives.size(); ++p)
            model.meshes[m].primitives[p].indices = gltf["meshes"][m]["primitives"][p].value("indices", -1);
    return model;
}

} // namespace

GltfDocument makeDocument(ImportContext& context, const GltfFile& file) {
    BufferStore buffers(context, file);
    return {file.json, typedModel(context, file.json), std::move(buffers), findMpegMaterials(context, file),
            file.folder};
}

} // namespace touchstone
