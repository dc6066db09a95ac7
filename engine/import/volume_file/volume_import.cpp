#include "engine/import/volume_file/volume_import.h"

#include "engine/core/input_file.h"
#include "engine/import/volume_file/flat_volume_format.h"
#include "engine/process/helper_program.h"
#include "engine/process/mapped_file.h"
#include "engine/process/process_answer.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

namespace touchstone {

namespace {

constexpr const char* kExportVolumeAgain = "export the volume again, as .nrrd for example";
constexpr const char* kNoMemory = "close other programs, or resample the volume";

/// The reader's line of text, which may hold anything.
std::string lineOf(std::span<const uint8_t> bytes) {
    constexpr size_t kLongest = 400;
    std::string text(bytes.begin(),
                     bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), kLongest)));
    text.resize(std::min(text.find('\n'), text.size()));
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, ' ');
    return text;
}

/// The file that a header names: its bytes as they are, since the name is no URI and need not be text.
std::filesystem::path dataFileIn(const ImportContext& context, const std::filesystem::path& folder,
                                 std::span<const uint8_t> answer) {
    constexpr size_t kLongest = 1024;
    const auto end = std::find(answer.begin(), answer.end(), uint8_t{'\n'});
    const std::string name(answer.begin(), end);
    const auto refuse = [&](const char* why) {
        context.fail("data file",
                     "the name '" + lineOf(answer.first(std::min<size_t>(name.size(), 60))) + "' " + why,
                     "put the file into the header's folder and name it by a relative path");
    };
    if (name.empty() || name.size() > kLongest)
        refuse("is empty or longer than 1024 bytes");
    if (std::ranges::any_of(name, [](unsigned char c) { return c < ' ' || c == 0x7f; }))
        refuse("holds a control character");
    if (name.find('\\') != std::string::npos)
        refuse("has backslashes: folders are divided by /");
    const std::filesystem::path path(name);
    if (path.is_absolute())
        refuse("is absolute");
    if (std::ranges::find(path, "..") != path.end())
        refuse("leaves the header's folder");
    return folder / path;
}

[[noreturn]] void failOf(const ImportContext& context, const ProcessAnswer& answer, const std::string& line,
                         const std::string& name, const VolumeReader& reader) {
    using enum ProcessAnswer::End;
    const auto fail = [&](const std::string& problem, const std::string& remedy) {
        context.fail("", problem, remedy);
    };
    switch (answer.end) {
    case Exited:
        if (answer.status == 1 && !line.empty())
            fail("cannot be read as " + name + ": " + line, kExportVolumeAgain);
        fail("the reader of volumes ended with status " + std::to_string(answer.status), kExportVolumeAgain);
        break;
    case Killed:
        if (answer.status == SIGXCPU)
            fail("reading it took more than " + std::to_string(reader.limits.processorSeconds) +
                     " s of processor time",
                 kExportVolumeAgain);
        if (answer.status == SIGKILL)
            fail("the system ended the reader of volumes, probably for want of memory", kNoMemory);
        fail("the reader of volumes crashed on it (signal " + std::to_string(answer.status) + ")",
             kExportVolumeAgain);
        break;
    case TooSlow:
        fail("reading it took longer than " + std::to_string(reader.limits.seconds) + " s",
             kExportVolumeAgain);
        break;
    case TooLong:
        fail("its values take more than the " + std::to_string(reader.mostBytes >> 20) + " MiB that fit",
             kExportVolumeAgain);
        break;
    case Stopped:
        throw Cancelled();
    case NotStarted:
        break;
    }
    fail("the program that reads volumes cannot be started: " + reader.program.string(),
         "build it (ninja " + reader.program.filename().string() + ") and leave it beside touchstone");
    std::abort(); // fail throws
}

/// What one start of the reader gave.
struct Answer {
    ProcessAnswer process;
    MappedFile output;
};

Answer ask(const ImportContext& context, const VolumeReader& reader, std::vector<std::string> arguments,
           const FileDescriptor& input) {
    const FileDescriptor output(memfd_create("touchstone", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (output.get() < 0)
        context.fail("", "there is not enough memory for it", kNoMemory);
    ProcessLimits limits = reader.limits;
    limits.fileSize = reader.mostBytes + (uint64_t{1} << 16);
    arguments.insert(arguments.begin(), reader.program.filename().string());
    Answer answer;
    answer.process = askProcessInto(output, reader.program.string(), arguments, limits, input,
                                    [&] { return context.progress().cancelled(); });
    // Nobody can change it from here on.
    if (fcntl(output.get(), F_ADD_SEALS, F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE) != 0)
        context.fail("", "its values can still be changed by another process", "open it again");
    answer.output = MappedFile(output);
    return answer;
}

FileDescriptor opened(const std::filesystem::path& path, const std::string& shownAs) {
    requireFile(path, shownAs, "give a file");
    FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0)
        throw Error(shownAs, "", std::string("cannot be read: ") + std::strerror(errno),
                    "check its permissions");
    return file;
}

/// Values of 1 to 8 bytes, or of text some 25 characters for a float, become 1 to 4 bytes: a file of many
/// more is not read, nor waited for.
void checkFileSize(const ImportContext& context, const FileDescriptor& file, const VolumeReader& reader) {
    constexpr uint64_t kHeader = uint64_t{1} << 20;
    const uint64_t most = 8 * reader.mostBytes + kHeader;
    struct stat facts {};
    if (fstat(file.get(), &facts) != 0 || static_cast<uint64_t>(facts.st_size) <= most)
        return;
    context.fail("",
                 "its file has " + std::to_string(facts.st_size >> 20) + " MiB, and at most " +
                     std::to_string(most >> 20) + " MiB are read",
                 "crop or resample the volume: its values may take " +
                     std::to_string(reader.mostBytes >> 20) + " MiB");
}

/// Size, and the hash by which recordings know a file (haptics/recording/scene_identity.cpp): of blocks of 1
/// MiB, as many of them full as there are, in however many pieces the system gives them.
FileStamp stampOfFile(const FileDescriptor& file, const Progress& progress) {
    std::vector<std::byte> block(size_t{1} << 20);
    FileStamp stamp;
    Hash64 hash;
    for (bool more = true; more;) {
        size_t filled = 0;
        while (filled < block.size()) {
            progress.stopIfCancelled();
            const ssize_t got = pread(file.get(), block.data() + filled, block.size() - filled,
                                      static_cast<off_t>(stamp.size + filled));
            if (got < 0 && errno == EINTR)
                continue;
            if (got <= 0)
                break;
            filled += static_cast<size_t>(got);
        }
        more = filled == block.size();
        if (filled > 0)
            hash.addBytes(std::span(block).first(filled));
        stamp.size += filled;
    }
    stamp.hash = hash.value();
    return stamp;
}

FlatVolumeHead headOf(const ImportContext& context, std::span<const uint8_t> answer) {
    const auto fail = [&](const char* problem) {
        context.fail("", std::string("the reader of volumes gave a damaged answer: ") + problem,
                     kExportVolumeAgain);
    };
    FlatVolumeHead head;
    if (answer.size() < sizeof head)
        fail("it is cut off");
    std::memcpy(&head, answer.data(), sizeof head);
    if (head.magic != kFlatVolumeMagic || head.type >= kVolumeTypes || head.notes > kAllVolumeNotes)
        fail("it begins with something else");
    uint64_t voxels = 1;
    for (const uint32_t size : head.size) {
        if (size < 2 || size > kMostVolumeAxis)
            fail("impossible sizes");
        voxels *= size; // 48 bits
    }
    if (answer.size() - sizeof head != voxels * bytesOf(static_cast<VolumeType>(head.type)))
        fail("its values are cut off");
    head.fileType[sizeof head.fileType - 1] = '\0';
    return head;
}

/// Places that no surface could be built from are refused.
void checkPlace(const ImportContext& context, const VolumeFacts& facts) {
    double sizes = 1.0;
    bool finite = std::isfinite(glm::length(facts.origin)) && std::isfinite(facts.offset) &&
                  std::isfinite(facts.scale) && facts.scale != 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(facts.axes[axis]);
        finite = finite && std::isfinite(length) && length > 1e-12 && length < 1e6;
        sizes *= length;
    }
    constexpr double kFlat = 1e-3; // of a right angle's volume
    if (!finite)
        context.fail("", "its voxels have a size, a place or a scale of values that is no usable number",
                     kExportVolumeAgain);
    if (!(glm::determinant(facts.axes) > kFlat * sizes))
        context.fail("", "its axes are not three directions: they lie in a plane", kExportVolumeAgain);
}

VolumeFacts factsOf(const FlatVolumeHead& head, VolumeFormat format) {
    VolumeFacts facts;
    facts.type = static_cast<VolumeType>(head.type);
    for (int axis = 0; axis < 3; ++axis) {
        facts.size[axis] = static_cast<int>(head.size[axis]);
        facts.origin[axis] = head.origin[axis];
        for (int part = 0; part < 3; ++part)
            facts.axes[axis][part] = head.axes[axis][part];
    }
    facts.scale = head.scale;
    facts.offset = head.offset;
    if (std::isfinite(head.iso))
        facts.statedIso = head.iso;
    facts.format = nameOf(format);
    facts.fileType = head.fileType;
    if ((head.notes & kNoUnit) != 0)
        facts.notes.emplace_back("states no unit of length: its numbers are taken as millimetres");
    if ((head.notes & kNoOrientation) != 0)
        facts.notes.emplace_back("states no orientation: its axes are taken as the scene's, y upwards");
    if ((head.notes & kSeveralGrids) != 0)
        facts.notes.emplace_back("holds several grids: the first is felt");
    return facts;
}

} // namespace

VolumeReader installedVolumeReader(VolumeFormat format, uint64_t bytes) {
    VolumeReader reader;
    reader.program =
        helperProgram(format == VolumeFormat::Vdb ? "touchstone_vdb_reader" : "touchstone_volume_reader");
    reader.limits.processorSeconds = 10 + static_cast<unsigned>(bytes / 4'000'000);
    reader.limits.seconds = 10 * reader.limits.processorSeconds;
    reader.limits.memory = std::max(kMaxMemory, uint64_t{4} << 30);
    reader.limits.openFiles = 16;
    return reader;
}

std::shared_ptr<const Volume> readVolume(const ImportContext& context, const std::filesystem::path& path,
                                         VolumeFormat format, const VolumeReader& reader) {
    const std::string name = nameOf(format);
    const FileDescriptor file = opened(path, context.file());
    checkFileSize(context, file, reader);
    const std::vector<std::string> arguments{wordOf(format), std::to_string(reader.mostBytes)};
    const EstimatedProgress estimate(context.progress().part(0.0, 0.13), "reading the volume", 0.5);
    Answer answer = ask(context, reader, arguments, file);
    const auto exited = [&](int status) {
        return answer.process.end == ProcessAnswer::End::Exited && answer.process.status == status;
    };
    if (exited(kDetachedData)) {
        const std::filesystem::path data = dataFileIn(context, path.parent_path(), answer.output.bytes());
        std::string header(kMostVolumeHeader, ' ');
        header.resize(
            static_cast<size_t>(std::max<ssize_t>(pread(file.get(), header.data(), header.size(), 0), 0)));
        if (header.find('\0') != std::string_view::npos)
            context.fail("", "its header holds a zero byte", kExportVolumeAgain);
        std::vector<std::string> again = arguments;
        again.emplace_back(header);
        const FileDescriptor values = opened(data, data.string());
        checkFileSize(context, values, reader);
        answer = ask(context, reader, again, values);
    }
    if (!exited(0))
        failOf(context, answer.process, lineOf(answer.output.bytes()), name, reader);
    const auto owner = std::make_shared<const MappedFile>(std::move(answer.output));
    const FlatVolumeHead head = headOf(context, owner->bytes());
    VolumeFacts facts = factsOf(head, format);
    checkPlace(context, facts);
    facts.file = stampOfFile(file, context.progress());
    return std::make_shared<const Volume>(std::move(facts), owner->bytes().subspan(sizeof head), owner,
                                          context.file(), context.progress());
}

} // namespace touchstone
