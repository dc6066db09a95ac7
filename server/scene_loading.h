#pragma once
// A scene that is read beside the network's thread.

#include "server/messages.h"
#include "touchstone/touchstone.hpp"

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchstone::server {

/// One scene at a time, fitted to the workspace.
class SceneLoading {
  public:
    struct Loaded {
        std::unique_ptr<ts::Scene> scene; ///< null: `error`
        std::string error;
        std::vector<float> triangles; ///< ts_scene_triangles
        std::string file;             ///< empty: a scene in memory
        uint64_t client = 0;          ///< that has asked for it; 0: none
    };
    void begin(const std::string& file, uint64_t client);
    /// `scene`, a file below `root`, or `bytes`. Throws Refusal.
    void begin(const Json& message, const std::string& root, uint64_t client);
    /// What has been loaded, once.
    [[nodiscard]] std::optional<Loaded> take();

  private:
    void start(std::function<std::unique_ptr<ts::Scene>()> make, std::string file, uint64_t client);

    std::future<Loaded> loading_;
};

} // namespace touchstone::server
