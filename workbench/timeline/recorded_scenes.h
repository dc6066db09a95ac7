#pragma once
// The scene files of a recording: their current location, and whether they have changed.

#include "haptics/recording/replayer.h"

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace touchstone {

/// The scene's file: at its recorded path, or beside the recording; nullopt where it is in neither.
[[nodiscard]] std::optional<std::filesystem::path> findRecordedScene(const std::filesystem::path& recording,
                                                                     const SceneIdentity& scene);

/// A scene of the recording and the state of its file.
struct FoundScene {
    RecordedScene recorded;
    std::filesystem::path path;
    bool sameFile = false, sameFelt = false;
    ReplayScene scene;
    /// "has changed since it was touched …"; empty: unchanged.
    [[nodiscard]] std::string change() const;
};

/// Loads and compiles it as recorded, with the edits of that time. Any thread; throws Error.
[[nodiscard]] FoundScene loadRecordedScene(const RecordedScene& recorded, const std::filesystem::path& path,
                                           const std::atomic<bool>* cancel = nullptr);

/// Scenes of one recording, each loaded at first use. Any thread.
class RecordedSceneShelf {
  public:
    explicit RecordedSceneShelf(std::filesystem::path recording) : recording_(std::move(recording)) {}

    /// Throws Error where the file is missing or cannot be loaded; the next call tries again.
    [[nodiscard]] FoundScene get(const RecordedScene& recorded);

  private:
    std::filesystem::path recording_;
    std::mutex mutex_; // held while loading, so that other callers wait
    std::map<uint32_t, FoundScene> loaded_;
};

} // namespace touchstone
