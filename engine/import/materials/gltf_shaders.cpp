#include "engine/import/materials/gltf_shaders.h"

#include "engine/import/file/gltf_schema.h"
#include "engine/import/file/gltf_uri.h"
#include "engine/import/file/gltf_validation.h"
#include "engine/import/file/json_fields.h"

#include <system_error>
#include <utility>

namespace touchstone {

namespace {

using nlohmann::json;

constexpr const char* kCorrect = "correct the value in the file";

void checkShape(ImportContext& context, const json& shader, const std::string& place) {
    const bool object = shader.is_object();
    const bool text = object && shader.contains("source"), view = object && shader.contains("bufferView");
    if (!(text || view) || (text && !shader["source"].is_string()))
        context.fail(place, "should be an object with a source or a bufferView", kCorrect);
    if (text && view)
        context.fail(place, "has both a source and a bufferView", "keep one of them");
    if (shader.contains("parameters") && !shader["parameters"].is_object())
        context.fail(place + ".parameters", "should be an object of values by name", kCorrect);
    for (const auto& [name, value] : shader.items())
        if (name != "source" && name != "bufferView" && name != "parameters" && name != "persistentTexture" &&
            name != "name" && name != "extensions" && name != "extras")
            context.warn(place + "." + name.substr(0, 40), "is not a known field; felt without it");
}

std::string textFrom(ByteSpan bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// "wood.glsl: line 4: PROBLEM; REMEDY".
std::string message(const Error& error) {
    std::string text = error.file();
    if (!error.place().empty())
        text += ": " + error.place();
    text += ": " + error.problem();
    return error.remedy().empty() ? text : text + "; " + error.remedy();
}

} // namespace

ShaderText ShaderReader::textOf(const json& shader, const std::string& place) const {
    std::string inside = shader.contains("name") && shader["name"].is_string()
                             ? shader["name"].get<std::string>().substr(0, 100)
                             : std::string("program of " + place.substr(0, place.find('.')));
    if (shader.contains("bufferView")) {
        const auto view =
            indexField(context_, shader, "bufferView", place,
                       document_.json.value("bufferViews", json::array()).size(), "bufferViews");
        if (!document_.buffers.hasData(static_cast<size_t>(*view)))
            context_.fail(place + ".bufferView", "its buffer has no data");
        return {std::move(inside), textFrom(document_.buffers.view(static_cast<size_t>(*view))), {}};
    }
    const std::string uri = shader["source"];
    if (isDataUri(uri))
        return {std::move(inside), textFrom(decodeDataUri(context_, place + ".source", uri).bytes), {}};
    std::filesystem::path file = resolveUri(context_, place + ".source", document_.folder, uri);
    const std::string shownAs = uri.substr(0, 200);
    std::error_code problem;
    const uintmax_t size = std::filesystem::file_size(file, problem);
    if (!problem && size > kMaxProgramBytes)
        throw Error(shownAs, "",
                    "has " + std::to_string(size) + " bytes, more than the " +
                        std::to_string(kMaxProgramBytes) + " of a program",
                    "shorten it");
    std::string text = textFrom(readWholeFile(file, shownAs));
    return {shownAs, std::move(text), std::move(file)};
}

const ShaderReader::Outcome& ShaderReader::compiled(const json& shader, const std::string& place) {
    const std::string key = shader.contains("source") ? shader["source"].get<std::string>()
                                                      : "bufferView " + shader["bufferView"].dump();
    if (const auto found = outcomes_.find(key); found != outcomes_.end())
        return found->second;
    if (outcomes_.size() >= kMaxFilePrograms)
        throw Error(context_.file(), place,
                    "the file has more than " + std::to_string(kMaxFilePrograms) + " programs",
                    "share them between materials");
    Outcome outcome;
    try {
        const ShaderText text = textOf(shader, place);
        outcome.program = compileSurfaceProgram(text.name, text.text, text.file, [this] {
            const auto* cancel = context_.options().cancel;
            return cancel != nullptr && cancel->load();
        });
    } catch (const Error& error) {
        context_.stopIfCancelled();
        outcome.flaw = message(error);
    }
    return outcomes_.emplace(key, std::move(outcome)).first->second;
}

ShaderText readShaderText(const std::filesystem::path& path, const json& shader) {
    const LoadOptions options;
    ImportContext context(path.string(), options);
    checkShape(context, shader, "shader");
    GltfFile file = readGltfFile(context, path);
    checkSchema(context, file.json);
    validateGltf(context, file.json);
    const GltfDocument document = makeDocument(context, file);
    return ShaderReader(context, document).textOf(shader, "shader");
}

void ShaderReader::read(const json& shader, const std::string& place, HapticStatement& ours) {
    checkShape(context_, shader, place);
    ours.shader = KeptJson(shader);
    std::string flaw;
    try {
        const Outcome& outcome = compiled(shader, place);
        flaw = outcome.flaw;
        ours.program = outcome.program; // also where values are wrong: they can be corrected
        if (ours.program != nullptr)
            (void)materialProgram(ours.program, shader);
    } catch (const Error& error) {
        flaw = message(error);
    }
    if (!flaw.empty())
        context_.warn(place, flaw + "; the surface is plain");
}

} // namespace touchstone
