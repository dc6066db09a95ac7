#include "workbench/gallery/thumbnail_maker.h"

#include "engine/scene/import/image_decode.h"
#include "workbench/gallery/file_note.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// Starts it without standard streams; -1 where that fails.
pid_t start(const std::vector<std::string>& arguments) {
    std::vector<char*> raw;
    for (const std::string& argument : arguments)
        raw.push_back(const_cast<char*>(argument.c_str())); // exec promises not to write
    raw.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
    pid_t child = -1;
    const int failed = posix_spawn(&child, raw[0], &actions, nullptr, raw.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return failed == 0 ? child : -1;
}

/// The PNG file's pixels; none where it is not one of our size.
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

} // namespace

ThumbnailMaker::ThumbnailMaker(std::filesystem::path program, ThumbnailCache cache)
    : program_(std::move(program)), cache_(std::move(cache)),
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
    // Of this thread and of what it starts. Where it is refused, drawing merely competes with the window.
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
    for (;;) {
        std::filesystem::path file;
        {
            std::unique_lock lock(mutex_);
            if (!wanted_.wait(lock, stop, [this] { return !requests_.empty(); }))
                return;
            file = std::move(requests_.front());
            requests_.pop_front();
        }
        Thumbnail made;
        try {
            made = make(file, stop);
        } catch (const std::exception&) { // no memory: a file without a picture
            made.file = file;
        }
        const std::lock_guard lock(mutex_);
        done_.push_back(std::move(made));
    }
}

Thumbnail ThumbnailMaker::make(const std::filesystem::path& file, const std::stop_token& stop) const {
    Thumbnail made;
    made.file = file;
    const std::filesystem::path picture = cache_.pictureOf(file);
    if (picture.empty()) {
        made.missing = true;
        return made;
    }
    made.note = fileNote(file);
    made.picture = readPicture(picture);
    if (made.picture.bytes.empty() && cache_.makeRoom() && draw(file, picture, stop))
        made.picture = readPicture(picture);
    return made;
}

bool ThumbnailMaker::draw(const std::filesystem::path& file, const std::filesystem::path& picture,
                          const std::stop_token& stop) const {
    const std::string size = std::to_string(kWidth) + "x" + std::to_string(kHeight);
    // Absolute, so that no name is taken for an option.
    const pid_t child = start({program_.string(), "render", std::filesystem::absolute(file).string(),
                               "--size", size, "--out", picture.string()});
    if (child < 0)
        return false;
    const rlimit processor{kMostSeconds, kMostSeconds};
    prlimit(child, RLIMIT_CPU, &processor, nullptr);
    const rlimit noCore{0, 0};
    prlimit(child, RLIMIT_CORE, &noCore, nullptr);
    for (;;) {
        int status = 0;
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended != 0)
            return ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
        if (stop.stop_requested()) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

} // namespace touchstone
