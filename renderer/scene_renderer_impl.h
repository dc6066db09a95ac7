#pragma once
// Implementation of SceneRenderer; for renderer/ only.

#include "renderer/deformed_meshes.h"
#include "renderer/frame_slot.h"
#include "renderer/frustum.h"
#include "renderer/gpu_scene.h"
#include "renderer/kept_picture.h"
#include "renderer/overlay_geometry.h"
#include "renderer/pipelines.h"
#include "renderer/scene_renderer.h"
#include "shaders/shared/scene_types.h"

#include <array>
#include <memory>
#include <vector>

namespace touchstone {

/// What of a scene is drawn: a whole picture; what a kept one consists of; or what is drawn over that in each
/// frame.
enum class Part : uint8_t { All, Resting, Live };

/// One instance in one frame.
struct DrawItem {
    int instance = 0;
    uint32_t firstIndex = 0, indexCount = 0; ///< of triangles; or lines or points of the mesh's strokes
    uint32_t features = 0;
    bool bothSides = false; ///< of its triangles are drawn
    /// Of transmissive items: side to draw. All: one or both, in one draw.
    enum class Sides : uint8_t { All, Far, Near } sides = Sides::All;
    double distance = 0.0;
    glm::dvec3 centre{0.0}; ///< of a ball around it, eye frame
    double radius = -1.0;   ///< < 0: unknown, as of lines and points, whose width is one of pixels
    double edge = 0.0;      ///< mean length of its triangles' edges at its distance, pixels
    bool mirrored = false;
    shared::ObjectConstants constants;
};

struct SceneRenderer::Impl {
    explicit Impl(Gpu& owner);
    ~Impl();

    /// The image of an eye's last frame, for the window; valid until its next render.
    [[nodiscard]] const FrameSlot* lastFrame(Eye eye) const { return last_[static_cast<size_t>(eye)]; }

    void clear();
    void beginScene(std::shared_ptr<const PreparedScene> prepared);
    [[nodiscard]] bool continueScene(double seconds);
    void abandon() { coming_.reset(); }
    void warmUpOverlays();
    void compileLater() { cold_.clear(); } ///< of the new scene: when it is first drawn
    void render(const View& view, const Overlay& overlay, int width, int height, Eye eye);
    [[nodiscard]] PictureState renderKept(const View& view, const Overlay& overlay, const glm::ivec2& coarse,
                                          const glm::ivec2& full);
    void setMaterialColors(std::vector<glm::vec3> colors);
    void setMeshVertices(int mesh, const DrawnVertices& vertices);
    void setPrograms(const std::vector<MaterialProgram>& programs);
    void setTexels(const PersistentTexels& texels) {
        if (scene_ && scene_->setTexels(texels))
            ++content_;
    }
    [[nodiscard]] std::string programProblem(const std::shared_ptr<const SurfaceProgram>& program) const {
        return pipelines_.programProblem(program);
    }
    void setEnvironment(std::shared_ptr<const Environment> environment);
    void reshape(int mesh, const ReshapedMesh& reshaped);
    [[nodiscard]] PixelData readPixels();
    /// The last frame of the main eye was no frame of a window: its time does not count.
    void forgetTime() {
        for (FrameSlot& slot : rings_[static_cast<size_t>(Eye::Main)].slots)
            slot.timed = slot.timed && &slot != lastFrame(Eye::Main);
    }
    [[nodiscard]] FalseColorScale falseColorScale() const {
        return scene_ && scene_->scale() != nullptr ? *scene_->scale() : FalseColorScale{};
    }

    Gpu::Impl& gpu;
    std::vector<glm::dmat4> poses;
    uint64_t sceneNumber = 0;
    SceneRenderer::Statistics statistics;

    [[nodiscard]] const Scene* scene() const { return scene_ ? &scene_->scene() : nullptr; }

  private:
    /// A pipeline to compile before it is needed: for an instance of the coming scene, in a frame or in a
    /// kept picture.
    struct Cold {
        enum class Kind : uint8_t { Frame, Kept };
        int instance = 0;
        Kind kind = Kind::Frame;
    };
    void warmUp(const Cold& cold);
    void warmUpKept();
    void drawWarm(const Overlay& overlay, const KeptPicture* kept);
    [[nodiscard]] std::vector<FrameSlot*> allSlots();
    void submit(const FrameSlot& slot) const;
    [[nodiscard]] vk::Extent2D allowedExtent(int width, int height) const;
    /// A whole frame, or what is drawn over a complete kept picture.
    void drawFrame(FrameRing& ring, const View& view, const Overlay& overlay, vk::Extent2D extent, Eye eye,
                   const KeptPicture* kept);
    /// One step of the kept picture, unless the last one is still being drawn.
    void advanceKept();
    void drawStep(KeptPicture& kept, const std::vector<DrawItem>& draws);
    /// Draws on from kept.place; returns the work done.
    [[nodiscard]] double drawOn(KeptPicture& kept, const std::vector<DrawItem>& draws);
    [[nodiscard]] bool showsProgram(const DrawItem& item, ViewMode mode) const;
    void castShadow(const FrameSlot& slot, const View& view, const KeptPicture& kept);
    void collectDraws(const View& view, const glm::dvec3& eye, vk::Extent2D extent, Part part,
                      std::vector<DrawItem>& draws) const;
    void writeUniforms(FrameSlot& slot, const View& view, const glm::dvec3& eye, const Overlay& overlay,
                       vk::Extent2D extent);
    void writeOverlay(FrameSlot& slot, const OverlayDraw& draw);
    void record(FrameSlot& slot, const View& view, const Overlay& overlay, const OverlayDraw& draw,
                const KeptPicture* kept);
    void beginFresh(const FrameSlot& slot) const;
    /// `over`: a picture that has the background.
    void drawScene(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet, ViewMode mode,
                   bool over);
    void bindScene(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet, ViewMode mode);
    void bindMeshes(const vk::raii::CommandBuffer& commands, ViewMode mode) const;
    void drawItem(const vk::raii::CommandBuffer& commands, const DrawItem& item, ViewMode mode,
                  bool keepsLight = false);
    void drawBackground(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet,
                        bool keepsLight = false);
    /// The edges of what drawScene drew last.
    void drawWireframe(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet);
    void drawOverlay(const vk::raii::CommandBuffer& commands, const FrameSlot& slot, const OverlayDraw& draw,
                     bool showHidden);

    Pipelines pipelines_;
    std::unique_ptr<GpuScene> scene_, coming_;
    GpuEnvironment environment_;
    GpuBuffer shapeVertices_, shapeIndices_;
    ShapeMeshes shapes_;
    std::array<FrameRing, 2> rings_; ///< of each Eye
    FrameRing rest_;                 ///< of the main one over the kept picture, in the size of that picture
    std::array<const FrameSlot*, 2> last_{}; ///< drawn for each Eye
    FrameSlot warm_;                         ///< for frames that compile pipelines and are not shown
    KeptPicture kept_, warmKept_;
    MovingInstances moving_;
    DeformedMeshes deformed_;
    std::vector<uint64_t> revisions_; ///< of the instances' vertices
    uint64_t content_ = 0;            ///< PictureKey::content
    std::vector<Cold> cold_;          ///< of `coming_`, not used yet
    std::vector<glm::vec3> materialColors_;
    std::vector<DrawItem> draws_;     ///< a member, to reuse its memory between frames
    std::vector<DrawItem> keptDraws_; ///< of the picture being refined
};

[[nodiscard]] glm::dvec3 eyeOf(const View& view);       ///< workspace
[[nodiscard]] glm::dmat4 clipFromEye(const View& view); ///< the eye frame has the workspace's axes

} // namespace touchstone
