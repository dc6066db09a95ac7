#include "engine/import/mesh_file/mesh_import.h"

#include "engine/import/file/gltf_kind.h"
#include "engine/import/mesh_file/flat_glb.h"
#include "engine/process/helper_program.h"
#include "engine/process/process_answer.h"

#include <signal.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

namespace touchstone {

namespace {

constexpr const char* kOther = "re-export the model, or convert it to .glb";
constexpr const char* kSlow = "it may be damaged: re-export the model, or convert it to .glb";

/// A line of text from the reader, which may hold anything.
std::string printable(std::span<const uint8_t> bytes) {
    constexpr size_t kLongest = 300;
    std::string text(bytes.begin(),
                     bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), kLongest)));
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, ' ');
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
}

[[noreturn]] void failOf(const ImportContext& context, const ProcessAnswer& answer, const std::string& name,
                         const MeshReader& reader) {
    using enum ProcessAnswer::End;
    switch (answer.end) {
    case Exited:
        if (answer.status == 1 && !answer.output.empty())
            context.fail("", "cannot be read as " + name + ": " + printable(answer.output), kOther);
        context.fail("",
                     "the reader of " + name + " files ended with status " + std::to_string(answer.status),
                     kOther);
    case Killed:
        if (answer.status == SIGXCPU)
            context.fail("",
                         "reading it took more than " + std::to_string(reader.limits.processorSeconds) +
                             " s of processor time",
                         kSlow);
        if (answer.status == SIGKILL)
            context.fail("", "the system ended the reader of " + name + " files, probably for want of memory",
                         "close other programs, or simplify the model");
        context.fail("",
                     "the reader of " + name + " files crashed on it (signal " +
                         std::to_string(answer.status) + ")",
                     kOther);
    case TooSlow:
        context.fail("", "reading it took longer than " + std::to_string(reader.limits.seconds) + " s",
                     kSlow);
    case TooLong:
        context.fail("", "its geometry would expand far beyond the file's own data", kOther);
    case Stopped:
        throw Cancelled();
    case NotStarted:
        break;
    }
    context.fail("",
                 "the program that reads " + name + " files cannot be started: " + reader.program.string(),
                 "build it (ninja touchstone_mesh_reader) and leave it beside touchstone");
}

void checkMeshBytes(const std::string& shownAs, uint64_t bytes, MeshFormat format) {
    if (bytes > kMaxMeshFileBytes)
        throw Error(shownAs, "",
                    std::string("is larger than the limit for ") + nameOf(format) + " files, " +
                        std::to_string(kMaxMeshFileBytes >> 20) + " MiB",
                    "simplify the model, or convert it to .glb");
    if (bytes == 0)
        throw Error(shownAs, "", "the file is empty", "copy or re-export the file");
}

} // namespace

MeshReader installedMeshReader(uint64_t bytes) {
    MeshReader reader;
    reader.program = helperProgram("touchstone_mesh_reader");
    reader.limits.processorSeconds = 5 + static_cast<unsigned>(bytes / 1'000'000);
    reader.limits.seconds = 10 * reader.limits.processorSeconds;
    reader.limits.memory = std::max(kMaxMemory, uint64_t{4} << 30);
    reader.limits.fileSize = 0;
    reader.limits.openFiles = 16;
    return reader;
}

std::vector<uint8_t> meshAsGlb(ImportContext& context, std::vector<uint8_t> bytes, MeshFormat format,
                               const MeshReader& reader) {
    const std::string name = nameOf(format);
    checkMeshBytes(context.file(), bytes.size(), format);
    const uint64_t size = bytes.size();
    const uint64_t most = std::min(std::max(kFreeGeometryBytes, kGeometryExpansion * size), kMaxFileBytes);
    const FileDescriptor input = memoryFile(bytes);
    if (input.get() < 0)
        context.fail("", "there is not enough memory for it", "close other programs, or simplify the model");
    bytes = {};
    ProcessAnswer answer;
    {
        constexpr double kTimePerByte = 5e-8; // s
        const EstimatedProgress estimate(context.progress().part(0.05, 0.15), "reading the mesh",
                                         0.05 + kTimePerByte * static_cast<double>(size));
        answer = askProcess(reader.program.string(), {reader.program.filename().string(), endingOf(format)},
                            reader.limits, input, most, [&] { return context.progress().cancelled(); });
    }
    if (answer.end != ProcessAnswer::End::Exited || answer.status != 0)
        failOf(context, answer, name, reader);
    FlatMeshes meshes = readFlatMeshes(answer.output, context.file());
    for (FlatMesh& mesh : meshes.meshes)
        if (mesh.name.empty())
            mesh.name = std::filesystem::path(context.file()).stem().string();
    context.warn("units",
                 name + " states neither a unit nor a material that could be felt: its numbers are taken as "
                        "metres, and the surface has the default material");
    return glbOf(meshes, "Touchstone " TOUCHSTONE_VERSION ", from " + name, context.file());
}

std::optional<MeshFormat> meshFormatOf(const ImportContext& context, std::span<const uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t start = text.find_first_not_of(" \t\r\n");
    if (text.starts_with("glTF") || (start != std::string_view::npos && text[start] == '{'))
        return std::nullopt;
    if (const auto format = meshFormatOf(bytes))
        return format;
    const auto named = meshFormatNamed(context.file());
    if (named)
        refuseOtherFormats(context, bytes);
    return named;
}

std::vector<uint8_t> asGltf(ImportContext& context, std::vector<uint8_t> bytes) {
    const auto format = meshFormatOf(context, bytes);
    if (!format)
        return bytes;
    const MeshReader reader = installedMeshReader(bytes.size());
    return meshAsGlb(context, std::move(bytes), *format, reader);
}

void checkMeshSize(const std::filesystem::path& file) {
    std::error_code problem;
    const auto format = meshFormatNamed(file);
    const uint64_t size = std::filesystem::file_size(file, problem);
    if (format && !problem)
        checkMeshBytes(file.string(), size, *format);
}

} // namespace touchstone
