#include "workbench/gallery/thumbnail_maker.h"

#include "engine/import/file/image_decode.h"
#include "engine/process/process_answer.h"
#include "workbench/gallery/file_note.h"

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// The PNG file's pixels; empty where it does not have our size.
PixelData readPicture(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::vector<uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
    if (bytes.empty())
        return {};
    DecodedImage image = decodeImage(bytes, false, [](uint64_t) { return true; });
    const PixelData& pixels = image.pixels;
    const bool ours = image.problem.empty() && pixels.width == ThumbnailMaker::kWidth &&
                      pixels.height == ThumbnailMaker::kHeight && pixels.channels == 4 &&
                      pixels.type == ComponentType::U8;
    return ours ? std::move(image.pixels) : PixelData{};
}

/// The fate of the file from the end of the process, where there is no picture.
ThumbnailFate fateOf(const ProcessAnswer& answer) {
    using End = ProcessAnswer::End;
    // Killed by the system for lack of a resource; other signals are the process's own fault.
    const bool starved = answer.end == End::Killed && (answer.status == SIGKILL || answer.status == SIGXCPU);
    const bool ownFault =
        answer.end == End::Exited || answer.end == End::TooLong || (answer.end == End::Killed && !starved);
    return ownFault ? ThumbnailFate::Broken : ThumbnailFate::None;
}

} // namespace

ThumbnailMaker::ThumbnailMaker(std::filesystem::path program, ThumbnailCache cache,
                               const ProcessLimits& limits)
    : program_(std::move(program)), cache_(std::move(cache)), limits_(limits),
      worker_([this](const std::stop_token& stop) { work(stop); }) {}

ThumbnailMaker::~ThumbnailMaker() {
    worker_.request_stop();
    wanted_.notify_all();
}

void ThumbnailMaker::request(const std::filesystem::path& file) {
    {
        const std::lock_guard lock(mutex_);
        requests_.push_back(file);
    }
    wanted_.notify_all();
}

void ThumbnailMaker::cancel() {
    const std::lock_guard lock(mutex_);
    requests_.clear();
    done_.clear();
    ++cancels_;
}

std::optional<Thumbnail> ThumbnailMaker::take() {
    const std::lock_guard lock(mutex_);
    if (done_.empty())
        return std::nullopt;
    Thumbnail first = std::move(done_.front());
    done_.pop_front();
    return first;
}

void ThumbnailMaker::work(const std::stop_token& stop) {
    // For this thread and its children. If refused, drawing competes with the window.
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
    for (;;) {
        Task task;
        {
            std::unique_lock lock(mutex_);
            if (!wanted_.wait(lock, stop, [this] { return !requests_.empty(); }))
                return;
            task = {std::move(requests_.front()), stop, cancels_};
            requests_.pop_front();
        }
        Thumbnail made;
        try {
            made = make(task);
        } catch (const std::exception&) { // out of memory: no picture for this file
            made.file = task.file;
            made.fate = ThumbnailFate::None;
        }
        const std::lock_guard lock(mutex_);
        if (task.cancels == cancels_)
            done_.push_back(std::move(made));
    }
}

Thumbnail ThumbnailMaker::make(const Task& task) const {
    Thumbnail made;
    made.file = task.file;
    const std::filesystem::path picture = cache_.pictureOf(task.file);
    if (picture.empty()) {
        made.fate = ThumbnailFate::Missing;
        return made;
    }
    made.note = fileNote(task.file);
    made.picture = readPicture(picture);
    if (made.picture.bytes.empty() && cache_.makeRoom()) {
        made.fate = draw(task, picture);
        made.picture = readPicture(picture);
    }
    if (!made.picture.bytes.empty())
        made.fate = ThumbnailFate::Drawn;
    else if (made.fate != ThumbnailFate::None && !cache_.takes(picture))
        made.fate = ThumbnailFate::None; // possibly a disk error
    return made;
}

ThumbnailFate ThumbnailMaker::draw(const Task& task, const std::filesystem::path& picture) const {
    const std::string size = std::to_string(kWidth) + "x" + std::to_string(kHeight);
    // Absolute, so that no name is parsed as an option.
    const std::vector<std::string> arguments{
        "touchstone", "render",        std::filesystem::absolute(task.file).string(), "--size", size,
        "--out",      picture.string()};
    return fateOf(askProcessInto(FileDescriptor(), program_.string(), arguments, limits_, FileDescriptor(),
                                 [&] { return task.stop.stop_requested() || task.cancels != cancels_; }));
}

} // namespace touchstone
