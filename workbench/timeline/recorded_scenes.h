#pragma once
// The files that a recording touched: where they are now, and whether they are still the same.

#include "haptics/recording/replayer.h"

#include <atomic>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace touchstone {

/// The scene's file: where it was, or beside the recording; nothing where it is neither.
[[nodiscard]] std::optional<std::filesystem::path> findRecordedScene(const std::filesystem::path& recording,
                                                                     const SceneIdentity& scene);

/// A scene of the recording and what became of its file.
struct FoundScene {
    RecordedScene recorded;
    std::filesystem::path path;
    bool sameFile = false, sameFelt = false;
    ReplayScene scene;
    /// "has changed since it was touched …"; empty: it has not.
    [[nodiscard]] std::string change() const;
};

/// Loads and compiles it as it was touched, with what was edited then. Any thread; throws Error.
[[nodiscard]] FoundScene loadRecordedScene(const RecordedScene& recorded, const std::filesystem::path& path,
                                           const std::atomic<bool>* cancel = nullptr);

/// Scenes of one recording, each loaded when it is first asked for. Any thread.
class RecordedSceneShelf {
  public:
    explicit RecordedSceneShelf(std::filesystem::path recording) : recording_(std::move(recording)) {}

    /// Throws Error where the file is not there or cannot be loaded; the next call tries again.
    [[nodiscard]] FoundScene get(const RecordedScene& recorded);

  private:
    std::filesystem::path recording_;
    std::mutex mutex_; // while one is loaded the others wait for it
    std::map<uint32_t, FoundScene> loaded_;
};

} // namespace touchstone
