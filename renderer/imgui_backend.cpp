#include "renderer/imgui_backend.h"

#include "renderer/gpu_memory.h"
#include "renderer/vulkan_result.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>

#include <algorithm>

namespace touchstone {

namespace {

void checkResult(VkResult result) {
    // Called from C callbacks of a library, within our own call of it.
    if (result < 0)
        throwResult(result, "Dear ImGui");
}

/// True if a key was pressed or released since the last frame.
bool keysChanged(const ImGuiIO& io) {
    const auto held = [](float duration) { return duration >= 0.0f; };
#if IMGUI_VERSION_NUM >= 18700
    return std::any_of(std::begin(io.KeysData), std::end(io.KeysData), [&](const ImGuiKeyData& key) {
        return held(key.DownDuration) != held(key.DownDurationPrev);
    });
#else
    return !std::equal(std::begin(io.KeysDownDuration), std::end(io.KeysDownDuration),
                       std::begin(io.KeysDownDurationPrev),
                       [&](float now, float before) { return held(now) == held(before); });
#endif
}

} // namespace

ImGuiBackend::ImGuiBackend(GLFWwindow* window, const std::function<void()>& setUp) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // no automatic files
    ImGui_ImplGlfw_InitForVulkan(window, true);
#if IMGUI_VERSION_NUM < 18700
    pointer_.emplace(window);
#endif
    if (setUp)
        setUp();
}

ImGuiBackend::~ImGuiBackend() {
    leaveDevice();
    pointer_.reset();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void ImGuiBackend::takeDevice(const Gpu::Impl& gpu, vk::RenderPass pass, vk::DescriptorPool descriptors,
                              uint32_t framesInFlight) {
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = *gpu.instance;
    info.PhysicalDevice = *gpu.physical;
    info.Device = *gpu.device;
    info.QueueFamily = gpu.queueFamily;
    info.Queue = *gpu.queue;
    info.DescriptorPool = descriptors;
    info.MinImageCount = 2;
    info.ImageCount = framesInFlight + 1; // it cycles through this many vertex buffers
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = &checkResult;
    ImGui_ImplVulkan_Init(&info, pass);
#if IMGUI_VERSION_NUM >= 19000
    ImGui_ImplVulkan_CreateFontsTexture();
#else
    runOnce(gpu,
            [](const vk::raii::CommandBuffer& commands) { ImGui_ImplVulkan_CreateFontsTexture(*commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
#endif
}

void ImGuiBackend::leaveDevice() {
    // ImGui's own state: also set after a partial setup that threw.
    if (ImGui::GetIO().BackendRendererUserData != nullptr)
        ImGui_ImplVulkan_Shutdown();
}

void ImGuiBackend::beginFrame() {
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    if (pointer_)
        pointer_->feed();
    ImGui::NewFrame();
}

bool userIsAtPanels(const PixelRect& picture) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || ImGui::IsAnyItemActive() || keysChanged(io))
        return true;
    const bool pressed =
        std::any_of(std::begin(io.MouseDown), std::end(io.MouseDown), [](bool b) { return b; });
    const bool released =
        std::any_of(std::begin(io.MouseReleased), std::end(io.MouseReleased), [](bool b) { return b; });
    const bool moved = io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f;
    if (!pressed && !released && !moved && io.MouseWheel == 0.0f)
        return false;
    const auto outside = [&](const ImVec2& place) {
        const float x = place.x * io.DisplayFramebufferScale.x, y = place.y * io.DisplayFramebufferScale.y;
        return x < static_cast<float>(picture.x) || y < static_cast<float>(picture.y) ||
               x >= static_cast<float>(picture.x + picture.width) ||
               y >= static_cast<float>(picture.y + picture.height);
    };
    return io.WantCaptureMouse || outside(io.MousePos) || outside(io.MousePosPrev);
}

void keepWithin(ImDrawData& data, const PixelRect& area) {
    const ImVec2 scale = data.FramebufferScale, origin = data.DisplayPos;
    const ImVec4 kept(static_cast<float>(area.x) / scale.x + origin.x,
                      static_cast<float>(area.y) / scale.y + origin.y,
                      static_cast<float>(area.x + area.width) / scale.x + origin.x,
                      static_cast<float>(area.y + area.height) / scale.y + origin.y);
    for (int list = 0; list < data.CmdListsCount; ++list)
        for (ImDrawCmd& command : data.CmdLists[list]->CmdBuffer) {
            ImVec4& clip = command.ClipRect;
            clip = ImVec4(std::max(clip.x, kept.x), std::max(clip.y, kept.y), std::min(clip.z, kept.z),
                          std::min(clip.w, kept.w));
            if (!(clip.z > clip.x && clip.w > clip.y)) {
                clip = ImVec4(kept.x, kept.y, kept.x, kept.y);
                command.ElemCount = 0;
            }
        }
}

} // namespace touchstone
