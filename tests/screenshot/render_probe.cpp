// Draws the 64,800-triangle torus, for what must be seen from outside the process: bit-identity over thread
// counts, and frame times.
//   render_probe pixels FILE            raw RGBA8 of one 320x180 frame
//   render_probe png FILE WIDTH HEIGHT  one picture
//   render_probe bench FRAMES WIDTH HEIGHT [MODEL]   of the torus or another model, with the probe's shadow
#include "engine/scene/scene_loader.h"
#include "renderer/png.h"
#include "renderer/scene_renderer.h"
#include "tests/screenshot/scenes.h"
#include "tests/support/lavapipe.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <vector>

namespace touchstone::test {
namespace {

struct Probe {
    std::unique_ptr<Gpu> gpu = Gpu::headless();
    SceneRenderer renderer{*gpu};
    ScenePtr scene;

    explicit Probe(ScenePtr shown = torusScene()) : scene(std::move(shown)) { renderer.setScene(scene); }
    void draw(int width, int height, double turn) {
        const double aspect = static_cast<double>(width) / height;
        OrbitCamera camera = cameraFor(*scene, aspect);
        camera.orbit(turn, 0.0);
        View view = viewOf(camera, {}, aspect);
        view.probe = {camera.target + 0.3 * camera.sceneRadius * camera.up(), 0.02 * camera.sceneRadius};
        renderer.render(view, touchOverlay(), width, height);
    }
};

void writePixels(const char* file) {
    Probe probe;
    probe.draw(320, 180, 0.0);
    const PixelData pixels = probe.renderer.readPixels();
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(pixels.bytes.data()),
               static_cast<std::streamsize>(pixels.bytes.size()));
}

void bench(int frames, int width, int height, ScenePtr scene) {
    Probe probe(std::move(scene));
    for (int i = 0; i < 5; ++i)
        probe.draw(width, height, 0.0);
    probe.gpu->waitIdle();
    using Clock = std::chrono::steady_clock;
    // CPU time of all threads: what remains comparable on a machine that does other things.
    const std::clock_t before = std::clock();
    // Throughput: two frames in flight, as in the window.
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < frames; ++i)
        probe.draw(width, height, 0.01 * i);
    probe.gpu->waitIdle();
    const double inFlight = std::chrono::duration<double, std::milli>(Clock::now() - start).count() / frames;
    const double cpu = 1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / frames;
    // Latency: each frame waited for.
    const Clock::time_point second = Clock::now();
    double device = 0.0;
    for (int i = 0; i < frames; ++i) {
        probe.draw(width, height, 0.01 * i);
        probe.gpu->waitIdle();
        device += 1e3 * probe.renderer.statistics().gpuSeconds / frames;
    }
    const double alone = std::chrono::duration<double, std::milli>(Clock::now() - second).count() / frames;
    const char* threads = std::getenv("LP_NUM_THREADS");
    std::printf(
        "%s, %dx%d, %llu triangles, LP_NUM_THREADS=%s: %.2f ms a frame in flight, %.2f ms alone, device "
        "clock %.2f ms, CPU time %.2f ms\n",
        probe.gpu->name().c_str(), width, height,
        static_cast<unsigned long long>(probe.renderer.statistics().triangles),
        threads != nullptr ? threads : "unset", inFlight, alone, device, cpu);
}

int run(const std::vector<std::string>& arguments) {
    useLavapipe();
    const auto number = [&](size_t i) { return std::atoi(arguments[i].c_str()); };
    if (arguments.size() == 2 && arguments[0] == "pixels") {
        writePixels(arguments[1].c_str());
    } else if (arguments.size() == 4 && arguments[0] == "png") {
        Probe probe;
        probe.draw(number(2), number(3), 0.0);
        writePng(arguments[1], probe.renderer.readPixels());
    } else if ((arguments.size() == 4 || arguments.size() == 5) && arguments[0] == "bench") {
        bench(number(1), number(2), number(3),
              arguments.size() == 5 ? loadScene(arguments[4]) : torusScene());
    } else {
        std::fprintf(
            stderr,
            "usage: render_probe pixels FILE | png FILE WIDTH HEIGHT | bench FRAMES WIDTH HEIGHT [MODEL]\n");
        return 2;
    }
    return 0;
}

} // namespace
} // namespace touchstone::test

int main(int argc, char** argv) {
    return touchstone::test::run({argv + 1, argv + argc});
}
