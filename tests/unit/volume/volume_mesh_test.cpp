// What the eye sees of a volume.
#include "engine/load/scene_loader.h"
#include "engine/volume/volume_mesh.h"
#include "tests/unit/volume/made_volume.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_scheduler_observer.h>

#include <atomic>
#include <map>

namespace touchstone {
namespace {

/// m^3.
double enclosed(const SurfaceMesh& mesh) {
    double volume = 0.0;
    for (size_t i = 0; i < mesh.corners.size(); i += 3)
        volume += glm::dot(glm::dvec3(mesh.positions[mesh.corners[i]]),
                           glm::cross(glm::dvec3(mesh.positions[mesh.corners[i + 1]]),
                                      glm::dvec3(mesh.positions[mesh.corners[i + 2]]))) /
                  6.0;
    return volume;
}

/// That are not passed as often in one direction as in the other.
int openEdges(const SurfaceMesh& mesh) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t i = 0; i < mesh.corners.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = mesh.corners[i + k], b = mesh.corners[i + (k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    int open = 0;
    for (const auto& [edge, balance] : edges)
        open += balance != 0 ? 1 : 0;
    return open;
}

TEST(VolumeMesh, LiesOnTheSphereAndFacesOutwards) {
    const auto volume = test::madeVolume("ball", glm::ivec3(48), "float");
    const SurfaceMesh mesh = meshOfVolume(*volume, 50.0, "ball");
    const double radius = 0.2 * assets::kBallRadius, voxel = 0.2 / 48;
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(glm::length(glm::dvec3(mesh.positions[i])), radius, 0.1 * voxel);
        EXPECT_GT(glm::dot(glm::normalize(mesh.positions[i]), mesh.normals[i]), 0.98f);
    }
    const double ball = 4.0 / 3.0 * 3.14159265 * radius * radius * radius;
    EXPECT_NEAR(enclosed(mesh), ball, 0.01 * ball);
}

TEST(VolumeMesh, IsClosedWhereTheVolumeEnds) {
    const auto volume = test::madeVolume("gyroid", {32, 40, 24}, "uint8");
    const SurfaceMesh mesh = meshOfVolume(*volume, 100.0, "gyroid");
    EXPECT_EQ(openEdges(mesh), 0);
    const Bounds box = volume->bounds();
    for (const glm::vec3& p : mesh.positions) {
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(glm::dvec3(p), box.low - 1e-7)));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::dvec3(p), box.high + 1e-7)));
    }
}

TEST(VolumeMesh, NoiseIsDrawnFromFewerVoxelsOrRefused) {
    const auto volume = test::noise({60, 52, 44});
    const auto faces = [](const SurfaceMesh& mesh) { return mesh.corners.size() / 6; };
    const SurfaceMesh all = meshOfVolume(*volume, 128.0, "noise");
    EXPECT_EQ(all.stride, 1);
    EXPECT_GT(faces(all), volume->voxels()) << "half of three edges a voxel";
    for (const uint64_t most : {volume->voxels(), volume->voxels() / 4, volume->voxels() / 20}) {
        const SurfaceMesh mesh = meshOfVolume(*volume, 128.0, "noise", {}, most);
        std::printf("at most %llu faces: %zu from every voxel number %d\n",
                    static_cast<unsigned long long>(most), faces(mesh), mesh.stride);
        EXPECT_GT(mesh.stride, 1);
        EXPECT_LE(faces(mesh), most);
        EXPECT_GT(faces(mesh), 0u);
    }
    try {
        (void)meshOfVolume(*volume, 128.0, "noise", {}, 1000);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(error.problem().find("the value 128 has more than 1000 faces"), std::string::npos)
            << error.what();
    }
}

TEST(VolumeMesh, TwoSlicesAreASlab) {
    // A disc of 20 mm in two, three and four slices of 1 mm, across each axis, from every voxel and from
    // fewer.
    for (int axis = 0; axis < 3; ++axis)
        for (const int slices : {2, 3, 4})
            for (const uint64_t most : {kMostSurfaceFaces, uint64_t{2000}}) {
                glm::ivec3 size(50);
                size[axis] = slices;
                std::vector<float> values;
                for (int i = 0; i < size.x * size.y * size.z; ++i) {
                    glm::dvec3 at(i % size.x, i / size.x % size.y, i / (size.x * size.y));
                    at[axis] = 24.5;
                    values.push_back(static_cast<float>(20.0 - glm::length(at - 24.5)));
                }
                const SurfaceMesh mesh = meshOfVolume(*test::volumeOf(size, values), 0.0, "slab", {}, most);
                EXPECT_EQ(mesh.stride > 1, most < kMostSurfaceFaces);
                EXPECT_EQ(openEdges(mesh), 0);
                const double full = 3.14159265 * 400.0 * (slices - 1);
                EXPECT_NEAR(1e9 * enclosed(mesh), full, 0.03 * full)
                    << axis << " " << slices << " " << mesh.stride;
            }
}

/// Threads that came to help in the arena of the thread that made it.
class Helpers : public tbb::task_scheduler_observer {
  public:
    Helpers() { observe(true); }
    ~Helpers() override { observe(false); }
    void on_scheduler_entry(bool worker) override { count_ += worker ? 1 : 0; }
    [[nodiscard]] int count() const { return count_.load(); }

  private:
    std::atomic<int> count_{0};
};

TEST(VolumeMesh, LeavesTheCoresOfTheDefaultArenaAlone) {
    const auto volume = test::madeVolume("gyroid", glm::ivec3(96), "float");
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    const Helpers helpers;
    const SurfaceMesh mesh = meshOfVolume(*volume, 100.0, "gyroid");
    EXPECT_EQ(helpers.count(), 0);
    EXPECT_GT(mesh.corners.size(), 10'000u);
}

} // namespace
} // namespace touchstone
