#include "workbench/screen/picture_controller.h"

#include "engine/time/seconds_now.h"
#include "renderer/picture_file.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <utility>

namespace touchstone {

namespace {

constexpr const char* kNotSaved = "the picture is not saved: ";

SavedNote notSaved(const std::string& why) {
    return {.file = {}, .problem = kNotSaved + why, .at = secondsNow()};
}

SavedNote saved(const std::filesystem::path& folder, const std::string& stem, const PixelData& pixels) {
    try {
        std::filesystem::create_directories(folder);
        const std::filesystem::path file = freePictureName(folder, stem.empty() ? "picture" : stem);
        writePicture(file, pixels);
        return {.file = file, .problem = {}, .at = secondsNow()};
    } catch (const std::exception& error) {
        return notSaved(error.what());
    }
}

} // namespace

void PictureController::save(const std::string& stem, const std::function<PixelData()>& draw) {
    if (part_ || saving_.valid())
        return; // one at a time
    try {
        saving_ = std::async(std::launch::async, saved, folder_, stem, draw());
    } catch (const DeviceLost&) {
        throw;
    } catch (const std::bad_alloc&) {
        note_ = notSaved("there is not enough memory for one of that size");
        failed_ = true;
    } catch (const std::exception& error) {
        note_ = notSaved(error.what());
        failed_ = true;
    }
}

void PictureController::request(WindowTarget& target, const PixelRect& part, const std::string& stem) {
    if (part_ || saving_.valid())
        return;
    part_ = part;
    stem_ = stem;
    target.requestCapture();
}

bool PictureController::update() {
    if (std::exchange(failed_, false))
        return true;
    if (!saving_.valid() || saving_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return false;
    note_ = saving_.get();
    return true;
}

bool PictureController::update(WindowTarget& target) {
    if (part_) {
        if (std::optional<PixelData> pixels = target.takeCapture()) {
            saving_ = std::async(std::launch::async, saved, folder_, stem_, cropped(*pixels, *part_));
            part_.reset();
        } else {
            target.requestCapture(); // no frame yet, captured by another caller, or lost with its device
        }
    }
    return update();
}

PixelData cropped(const PixelData& pixels, const PixelRect& part) {
    const int left = std::clamp(part.x, 0, pixels.width), top = std::clamp(part.y, 0, pixels.height);
    const int right = std::clamp(part.x + part.width, left, pixels.width);
    const int bottom = std::clamp(part.y + part.height, top, pixels.height);
    PixelData result;
    result.width = right - left;
    result.height = bottom - top;
    result.channels = pixels.channels;
    const auto bytes = static_cast<size_t>(pixels.channels);
    for (int y = top; y < bottom; ++y) {
        const auto row =
            pixels.bytes.begin() + static_cast<ptrdiff_t>(bytes * static_cast<size_t>(y * pixels.width));
        result.bytes.insert(result.bytes.end(),
                            row + static_cast<ptrdiff_t>(bytes * static_cast<size_t>(left)),
                            row + static_cast<ptrdiff_t>(bytes * static_cast<size_t>(right)));
    }
    return result;
}

std::filesystem::path freePictureName(const std::filesystem::path& folder, const std::string& stem) {
    for (int number = 1;; ++number) {
        std::filesystem::path file = folder / (stem + "-" + std::to_string(number) + ".png");
        if (!std::filesystem::exists(file))
            return file;
    }
}

} // namespace touchstone
