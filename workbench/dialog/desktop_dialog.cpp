#include "workbench/dialog/desktop_dialog.h"

#include "engine/time/seconds_now.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <string_view>
#include <system_error>

namespace touchstone {

namespace {

constexpr double kSeen = 0.3;         // s: nobody cancels a dialog sooner
constexpr int kNoPortal = 3;          // status of touchstone_file_portal (ChooserAnswer::End::Absent)
constexpr uint64_t kMaxAnswer = 8192; // bytes

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

std::filesystem::path inPath(const std::string& program) {
    const std::string all = variable("PATH");
    for (size_t at = 0; at <= all.size();) {
        const size_t end = std::min(all.find(':', at), all.size());
        const std::filesystem::path file = std::filesystem::path(all.substr(at, end - at)) / program;
        std::error_code problem;
        if (file.is_absolute() && std::filesystem::is_regular_file(file, problem) &&
            access(file.c_str(), X_OK) == 0)
            return file;
        at = end + 1;
    }
    return {};
}

/// The program beside this one that asks the portal; nothing in a session without a bus, which no portal is
/// on.
std::filesystem::path portalProgram() {
    std::error_code problem;
    const std::string runtime = variable("XDG_RUNTIME_DIR");
    if (variable("DBUS_SESSION_BUS_ADDRESS").empty() &&
        (runtime.empty() || !std::filesystem::is_socket(runtime + "/bus", problem)))
        return {};
    const std::filesystem::path file =
        std::filesystem::read_symlink("/proc/self/exe", problem).parent_path() / "touchstone_file_portal";
    return access(file.c_str(), X_OK) == 0 ? file : std::filesystem::path();
}

/// "*.glb *.GLB *.gltf *.GLTF": the dialogs distinguish cases.
std::string patternsOf(const FileKind& kind) {
    std::string patterns;
    for (const std::string_view ending : kind.endings) {
        std::string upper(ending);
        std::ranges::transform(upper, upper.begin(),
                               [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        patterns += (patterns.empty() ? "*" : " *") + std::string(ending) + " *" + upper;
    }
    return patterns.empty() ? "*" : patterns;
}

const char* titleOf(const FileRequest& request) {
    return request.saves() ? "Save as - Touchstone" : "Open - Touchstone";
}

std::string startOf(const FileRequest& request) {
    // A folder ends in a separator, or the dialogs begin in the one above.
    return (request.folder / request.name).string();
}

} // namespace

std::vector<DialogProgram> installedDialogs() {
    using enum DialogProgram::Kind;
    const std::string wanted = variable("TOUCHSTONE_FILE_DIALOG");
    const bool kde = variable("XDG_CURRENT_DESKTOP").find("KDE") != std::string::npos;
    const DialogProgram::Kind order[] = {Portal, kde ? Kdialog : Zenity, kde ? Zenity : Kdialog};
    std::vector<DialogProgram> found;
    for (const DialogProgram::Kind kind : order) {
        const char* name = kind == Portal ? "portal" : kind == Zenity ? "zenity" : "kdialog";
        if (!wanted.empty() && wanted != name)
            continue;
        if (const std::filesystem::path file = kind == Portal ? portalProgram() : inPath(name); !file.empty())
            found.push_back({kind, file});
    }
    return found;
}

std::vector<std::string> dialogArguments(DialogProgram::Kind kind, const FileRequest& request) {
    std::vector<std::string> arguments;
    const auto withPatterns = [](const FileKind& each) {
        return std::string(each.name) + " | " + patternsOf(each);
    };
    if (kind == DialogProgram::Kind::Portal) {
        arguments = {"touchstone_file_portal", request.saves() ? "save" : "open", titleOf(request),
                     request.folder.string(), request.name};
        if (!request.saves())
            std::ranges::transform(kFileKinds, std::back_inserter(arguments), withPatterns);
        return arguments;
    }
    if (kind == DialogProgram::Kind::Zenity) {
        arguments = {"zenity",         "--file-selection", "--title",
                     titleOf(request), "--filename",       startOf(request)};
        if (request.saves())
            arguments.insert(arguments.end(), {"--save", "--confirm-overwrite"});
        else
            for (const FileKind& each : kFileKinds)
                arguments.insert(arguments.end(), {"--file-filter", withPatterns(each)});
        return arguments;
    }
    arguments = {"kdialog", "--title", titleOf(request),
                 request.saves() ? "--getsavefilename" : "--getopenfilename", startOf(request)};
    if (!request.saves()) {
        std::string filters;
        for (const FileKind& each : kFileKinds)
            filters += (filters.empty() ? "" : "\n") + std::string(each.name) + " (" + patternsOf(each) + ")";
        arguments.push_back(filters);
    }
    return arguments;
}

DialogAnswer answerOf(const ProcessAnswer& answer, double seconds) {
    using enum ProcessAnswer::End;
    if (answer.end == Stopped)
        return {};
    if (answer.end == NotStarted)
        return {{}, "The desktop's file dialog could not be started."};
    if (answer.end == Exited && answer.status == kNoPortal)
        return {{}, "There is no desktop portal that shows a file dialog.", true};
    if (answer.end != Exited || answer.status > 1 || (answer.status == 1 && seconds < kSeen))
        return {{}, "The desktop's file dialog ended without an answer."};
    if (answer.status == 1)
        return {};
    std::string text(answer.output.begin(), answer.output.end());
    if (text.ends_with('\n'))
        text.pop_back();
    const std::filesystem::path path(text);
    if (text.find('\n') != std::string::npos || text.find('\0') != std::string::npos || !path.is_absolute())
        return {{}, "The desktop's file dialog gave an answer that is no file."};
    return {path, {}};
}

void DesktopDialog::open(const DialogProgram& program, const FileRequest& request) {
    job_.start([program, arguments = dialogArguments(program.kind, request)](JobProgress& progress) {
        // A person may take as long as they like. Of memory a toolkit needs more than a mesh.
        const ProcessLimits limits{.processorSeconds = 3600,
                                   .seconds = std::numeric_limits<unsigned>::max(),
                                   .memory = std::numeric_limits<uint64_t>::max()};
        const double begin = secondsNow();
        const ProcessAnswer answer = askProcess(program.file.string(), arguments, limits, FileDescriptor(),
                                                kMaxAnswer, [&] { return progress.cancelled().load(); });
        return answerOf(answer, secondsNow() - begin);
    });
}

} // namespace touchstone
