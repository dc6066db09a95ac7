// Cameras of the file: where their nodes place them, and what a broken one costs.

#include "tests/unit/engine/load_support.h"

#include <cmath>
#include <limits>

namespace touchstone::gltf_cameras_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;
using test::warns;

json perspective() {
    return {{"type", "perspective"},
            {"name", "portrait"},
            {"perspective", {{"yfov", 0.7}, {"aspectRatio", 1.5}, {"znear", 0.01}, {"zfar", 20.0}}}};
}
json orthographic() {
    return {{"type", "orthographic"},
            {"orthographic", {{"xmag", 0.9}, {"ymag", 0.6}, {"znear", 0.0}, {"zfar", 5.0}}}};
}

/// The square, and a node of the shown scene for each camera.
GltfMaker withCameras(const std::vector<json>& cameras) {
    GltfMaker maker = GltfMaker::square();
    for (const json& camera : cameras) {
        const size_t index = maker.append("cameras", camera);
        const size_t node =
            maker.append("nodes", {{"camera", index}, {"name", "stand" + std::to_string(index)}});
        maker.json["scenes"][0]["nodes"].push_back(node);
    }
    return maker;
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_NEAR(glm::distance(a, b), 0.0, 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(GltfCameras, BothKindsAreReadWithTheirLenses) {
    const ScenePtr scene = load(withCameras({perspective(), orthographic()}));
    EXPECT_TRUE(scene->warnings.empty()) << test::warningsOf(*scene);
    ASSERT_EQ(scene->cameras.size(), 2u);
    const SceneCamera &first = scene->cameras[0], &second = scene->cameras[1];
    EXPECT_EQ(first.name, "portrait");
    EXPECT_EQ(first.nodeName, "stand0");
    EXPECT_EQ(first.index, 0);
    EXPECT_FALSE(first.orthographic);
    EXPECT_EQ(first.fovY, 0.7);
    EXPECT_EQ(first.aspect, 1.5);
    EXPECT_EQ(first.nearPlane, 0.01);
    EXPECT_EQ(first.farPlane, 20.0);
    EXPECT_EQ(first.eye, glm::dvec3(0.0));
    EXPECT_EQ(first.axes, glm::dmat3(1.0));
    EXPECT_EQ(second.name, "");
    EXPECT_EQ(second.index, 1);
    EXPECT_TRUE(second.orthographic);
    EXPECT_EQ(second.halfHeight, 0.6);
    EXPECT_NEAR(second.aspect, 1.5, 1e-15);
    EXPECT_EQ(second.nearPlane, 0.0);
    EXPECT_EQ(second.farPlane, 5.0);
}

TEST(GltfCameras, WithoutAFarPlaneOrShapeTheLensHasNone) {
    json lens = perspective();
    lens["perspective"].erase("zfar");
    lens["perspective"].erase("aspectRatio");
    const ScenePtr scene = load(withCameras({lens}));
    ASSERT_EQ(scene->cameras.size(), 1u);
    EXPECT_EQ(scene->cameras[0].farPlane, std::numeric_limits<double>::infinity());
    EXPECT_EQ(scene->cameras[0].aspect, 0.0);
}

/// Through a parent that turns and scales: the place as for meshes, the axes without the scale, lengths with
/// it.
TEST(GltfCameras, FollowTheirNodes) {
    GltfMaker maker = withCameras({orthographic()});
    const size_t node = maker.json["nodes"].size() - 1;
    maker.json["nodes"][node]["translation"] = {0, 0, 2};
    const size_t parent = maker.append("nodes", {{"children", {node}},
                                                 {"translation", {1, 2, 3}},
                                                 {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
                                                 {"scale", {10, 10, 10}}});
    maker.json["scenes"][0]["nodes"] = {0, parent};
    const ScenePtr scene = load(maker);
    ASSERT_EQ(scene->cameras.size(), 1u);
    const SceneCamera& camera = scene->cameras[0];
    expectNear(camera.eye, {21.0, 2.0, 3.0}); // +z turned to +x
    expectNear(camera.axes[0], {0.0, 0.0, -1.0});
    expectNear(camera.axes[1], {0.0, 1.0, 0.0});
    expectNear(camera.axes[2], {1.0, 0.0, 0.0});
    EXPECT_NEAR(camera.halfHeight, 6.0, 1e-12);
    EXPECT_NEAR(camera.farPlane, 50.0, 1e-12);
}

/// A mirrored or sheared node still gives a rotation that looks where the node does.
TEST(GltfCameras, ObliqueAxesBecomeARotation) {
    for (const json& change : {json{{"scale", {-1, 1, 1}}}, json{{"scale", {2, 0.1, 7}}},
                               json{{"matrix", {1, 0, 0, 0, 0.4, 1, 0.3, 0, 0, 0, 1, 0, 7, 8, 9, 1}}}}) {
        GltfMaker maker = withCameras({perspective()});
        maker.json["nodes"].back().update(change);
        const ScenePtr scene = load(maker);
        ASSERT_EQ(scene->cameras.size(), 1u) << change;
        const glm::dmat3& axes = scene->cameras[0].axes;
        EXPECT_NEAR(glm::determinant(axes), 1.0, 1e-12) << change;
        expectNear(axes[2], {0.0, 0.0, 1.0});
        EXPECT_GT(axes[1].y, 0.9) << change;
    }
}

TEST(GltfCameras, ABrokenLensCostsTheCameraAndAWarning) {
    struct Flaw {
        json change; ///< merged into the lens
        const char *where, *why;
    };
    for (const Flaw& flaw : {Flaw{{{"yfov", 0.0}}, "perspective.yfov", "above 0"},
                             Flaw{{{"yfov", -1.0}}, "perspective.yfov", "above 0"},
                             Flaw{{{"yfov", 3.2}}, "perspective.yfov", "below pi"},
                             Flaw{{{"yfov", "wide"}}, "perspective.yfov", "should be a number"},
                             Flaw{{{"aspectRatio", 0.0}}, "perspective.aspectRatio", "above 0"},
                             Flaw{{{"znear", 0.0}}, "perspective.znear", "above 0"},
                             Flaw{{{"zfar", 0.01}}, "perspective.zfar", "not beyond znear"}}) {
        json broken = perspective();
        broken["perspective"].update(flaw.change);
        const ScenePtr scene = load(withCameras({broken, perspective()}));
        ASSERT_EQ(scene->cameras.size(), 1u) << flaw.change;
        EXPECT_EQ(scene->cameras[0].index, 1) << flaw.change;
        EXPECT_TRUE(warns(*scene, std::string("cameras[0].") + flaw.where, flaw.why))
            << test::warningsOf(*scene);
        EXPECT_EQ(scene->triangleCount(), 2u);
    }
    for (const Flaw& flaw : {Flaw{{{"xmag", 0.0}}, "orthographic.xmag", "no area"},
                             Flaw{{{"ymag", 0}}, "orthographic.ymag", "no area"},
                             Flaw{{{"znear", -0.1}}, "orthographic.znear", "at least 0"},
                             Flaw{{{"zfar", 0.0}}, "orthographic.zfar", "not beyond znear"}}) {
        json broken = orthographic();
        broken["orthographic"].update(flaw.change);
        const ScenePtr scene = load(withCameras({broken}));
        EXPECT_TRUE(scene->cameras.empty()) << flaw.change;
        EXPECT_TRUE(warns(*scene, std::string("cameras[0].") + flaw.where, flaw.why))
            << test::warningsOf(*scene);
    }
}

TEST(GltfCameras, ALensThatIsMissingOrOfNoKindIsLeftOut) {
    for (const json& broken :
         {json::object(), json{{"type", "perspective"}}, json{{"type", "fisheye"}}, json{{"type", 3}},
          json{{"type", "perspective"}, {"orthographic", orthographic()["orthographic"]}}, json("a camera"),
          json{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}}}},
          json{{"type", "orthographic"}, {"orthographic", {{"xmag", 1.0}, {"ymag", 1.0}, {"znear", 1.0}}}}}) {
        const ScenePtr scene = load(withCameras({broken, perspective()}));
        EXPECT_EQ(scene->cameras.size(), 1u) << broken;
        EXPECT_TRUE(warns(*scene, "cameras[0]", "")) << broken;
    }
    GltfMaker maker = withCameras({perspective()});
    maker.json["cameras"] = "none";
    EXPECT_MENDED(maker, "cameras", "should be an array");
    maker.json["cameras"] = json::array();
    EXPECT_MENDED(maker, "cameras", "is empty");
    EXPECT_TRUE(load(maker)->cameras.empty());
}

TEST(GltfCameras, ANodeWithoutPlaceOrWithAMissingCameraHasNone) {
    GltfMaker maker = withCameras({perspective()});
    maker.json["nodes"].back()["scale"] = {1, 1, 0};
    EXPECT_MENDED(maker, "nodes[1]", "no place or direction");
    EXPECT_TRUE(load(maker)->cameras.empty());
    maker.json["nodes"].back() = {{"camera", 7}};
    EXPECT_MENDED(maker, "nodes[1].camera", "refers to cameras[7]");
    EXPECT_TRUE(load(maker)->cameras.empty());
    json doubled = perspective();
    doubled["orthographic"] = orthographic()["orthographic"];
    EXPECT_MENDED(withCameras({doubled}), "cameras[0]", "its type says perspective");
    json negative = orthographic();
    negative["orthographic"]["ymag"] = -0.6;
    EXPECT_MENDED(withCameras({negative}), "cameras[0].orthographic.ymag", "magnitude");
    EXPECT_EQ(load(withCameras({negative}))->cameras.at(0).halfHeight, 0.6);
}

/// One camera may stand in several places; a scene that is not shown places none.
TEST(GltfCameras, AreThoseThatTheShownScenePlaces) {
    GltfMaker maker = withCameras({perspective()});
    maker.json["scenes"][0]["nodes"].push_back(
        maker.append("nodes", {{"camera", 0}, {"name", "other"}, {"translation", {1, 0, 0}}}));
    ASSERT_EQ(load(maker)->cameras.size(), 2u);
    EXPECT_EQ(load(maker)->cameras[1].nodeName, "other");
    maker.json["scenes"][0]["nodes"] = {0};
    EXPECT_TRUE(load(maker)->cameras.empty());
}

} // namespace
} // namespace touchstone::gltf_cameras_test
