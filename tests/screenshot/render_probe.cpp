// Draws the 64,800-triangle torus, for what must be seen from outside the process: bit-identity over thread
// counts, and frame times.
//   render_probe pixels FILE            raw RGBA8 of one 320x180 frame
//   render_probe png FILE WIDTH HEIGHT [MODEL [PIXELS]]   one picture, as bench draws it
//   render_probe open MODEL             what taking a model in takes, step by step
//   render_probe bench FRAMES WIDTH HEIGHT [MODEL [PIXELS]]   of the torus or another model, with the probe's
//   shadow, by
//       simplified meshes that differ by so many PIXELS
#include "engine/load/scene_loader.h"
#include "renderer/picture_file.h"
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

    double allowedError = 0.0;

    explicit Probe(ScenePtr shown = torusScene(), double error = 0.0)
        : scene(std::move(shown)), allowedError(error) {
        renderer.beginScene(prepareScene(scene, {.coarsest = error > 0.0 ? PrepareOptions{}.coarsest : 0u}));
        while (!renderer.continueScene(1.0)) {
        }
    }
    void draw(int width, int height, double turn) {
        const double aspect = static_cast<double>(width) / height;
        OrbitCamera camera = cameraFor(*scene, aspect);
        camera.orbit(turn, 0.0);
        View view = viewOf(camera, {}, aspect);
        view.allowedError = allowedError;
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

void bench(int frames, int width, int height, ScenePtr scene, double error) {
    Probe probe(std::move(scene), error);
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
    std::printf("%s, %dx%d, %llu triangles, %llu drawn, LP_NUM_THREADS=%s: %.2f ms a frame in flight, %.2f "
                "ms alone, device "
                "clock %.2f ms, CPU time %.2f ms\n",
                probe.gpu->name().c_str(), width, height,
                static_cast<unsigned long long>(probe.renderer.statistics().triangles),
                static_cast<unsigned long long>(probe.renderer.statistics().drawnTriangles),
                threads != nullptr ? threads : "unset", inFlight, alone, device, cpu);
}

/// What a window goes through while it takes a model in: processor time of all threads, for the machine may
/// do other things.
void open(const ScenePtr& scene) {
    const auto milliseconds = [] { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    Probe probe(torusScene(24, 12));
    probe.draw(800, 448, 0.0);
    probe.gpu->waitIdle();
    const double start = milliseconds();
    std::shared_ptr<const PreparedScene> prepared = prepareScene(scene);
    const double preparing = milliseconds() - start;
    double longest = 0.0;
    int steps = 0;
    probe.renderer.beginScene(std::move(prepared));
    for (bool done = false; !done; ++steps) {
        const double before = milliseconds();
        done = probe.renderer.continueScene(0.008);
        longest = std::max(longest, milliseconds() - before);
    }
    probe.scene = scene;
    probe.allowedError = 0.4;
    const double before = milliseconds();
    probe.draw(800, 448, 0.0);
    probe.gpu->waitIdle();
    std::printf("%zu triangles: prepared in %.0f ms, uploaded in %d steps, the longest %.1f ms, first frame "
                "%.1f ms, all in processor time; "
                "%.1f MB on the device\n",
                scene->triangleCount(), preparing, steps, longest, milliseconds() - before,
                1e-6 * static_cast<double>(probe.renderer.statistics().deviceBytes));
}

int run(const std::vector<std::string>& arguments) {
    useLavapipe();
    const auto number = [&](size_t i) { return std::atoi(arguments[i].c_str()); };
    const auto sceneOf = [&](size_t i) {
        return arguments.size() <= i || arguments[i] == "torus" ? ScenePtr(torusScene())
                                                                : loadScene(arguments[i]);
    };
    const auto errorOf = [&](size_t i) {
        return arguments.size() > i ? std::atof(arguments[i].c_str()) : 0.0;
    };
    if (arguments.size() == 2 && arguments[0] == "pixels") {
        writePixels(arguments[1].c_str());
    } else if (arguments.size() >= 4 && arguments.size() <= 6 && arguments[0] == "png") {
        Probe probe(sceneOf(4), errorOf(5));
        probe.draw(number(2), number(3), 0.0);
        writePicture(arguments[1], probe.renderer.readPixels());
    } else if (arguments.size() >= 4 && arguments.size() <= 6 && arguments[0] == "bench") {
        bench(number(1), number(2), number(3), sceneOf(4), errorOf(5));
    } else if (arguments.size() == 2 && arguments[0] == "open") {
        open(loadScene(arguments[1]));
    } else {
        std::fprintf(stderr, "usage: render_probe pixels FILE | png FILE WIDTH HEIGHT [MODEL [PIXELS]] | "
                             "bench FRAMES WIDTH HEIGHT [MODEL [PIXELS]] | open MODEL\n");
        return 2;
    }
    return 0;
}

} // namespace
} // namespace touchstone::test

int main(int argc, char** argv) {
    return touchstone::test::run({argv + 1, argv + argc});
}
