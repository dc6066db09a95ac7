#include "server/scene_loading.h"

#include "server/access.h"

#include <chrono>
#include <utility>

namespace touchstone::server {

namespace {

constexpr size_t kMostBytes = size_t{16} << 20; // of a scene in a message

} // namespace

void SceneLoading::begin(const std::string& file, uint64_t client) {
    start([file] { return std::make_unique<ts::Scene>(file, TS_FIT_WORKSPACE); }, file, client);
}

void SceneLoading::begin(const Json& message, const std::string& root, uint64_t client) {
    if (loading_.valid())
        throw Refusal("a scene is being loaded");
    if (!message.contains("bytes")) {
        const std::string file = fileBelow(root, member<std::string>(message, "scene"));
        if (file.empty())
            throw Refusal("'scene' names no file below the root");
        begin(file, client);
        return;
    }
    auto bytes = std::make_shared<std::string>(decodedBase64(member<std::string>(message, "bytes")));
    if (bytes->size() > kMostBytes)
        throw Refusal("'bytes' holds more than 16 MiB");
    start([bytes] { return std::make_unique<ts::Scene>(ts::Scene::fromMemory(*bytes, TS_FIT_WORKSPACE)); },
          "", client);
}

void SceneLoading::start(std::function<std::unique_ptr<ts::Scene>()> make, std::string file,
                         uint64_t client) {
    loading_ =
        std::async(std::launch::async, [make = std::move(make), file = std::move(file), client]() -> Loaded {
            Loaded loaded{nullptr, {}, {}, file, client};
            try {
                loaded.scene = make();
                loaded.triangles = loaded.scene->triangles();
            } catch (const ts::Error& error) {
                loaded.scene = nullptr;
                loaded.error = error.what();
            }
            return loaded;
        });
}

std::optional<SceneLoading::Loaded> SceneLoading::take() {
    if (!loading_.valid() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    return loading_.get();
}

} // namespace touchstone::server
