#include "workbench/screen/gui_pixels.h"

#include "workbench/screen/style.h"

#include <glm/glm.hpp>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

constexpr float kLargestScale = 16.0f; ///< a larger font does not fit into the atlas

/// The font atlas: coverage, 8 bit.
struct Atlas {
    const unsigned char* texels = nullptr;
    int width = 0, height = 0;

    /// Bilinear, clamped to the edge; 0..1.
    [[nodiscard]] float at(const glm::vec2& uv) const {
        const glm::vec2 p = uv * glm::vec2(width, height) - 0.5f, low = glm::floor(p), t = p - low;
        const auto texel = [&](int x, int y) {
            const auto column = static_cast<size_t>(std::clamp(static_cast<int>(low.x) + x, 0, width - 1)),
                       row = static_cast<size_t>(std::clamp(static_cast<int>(low.y) + y, 0, height - 1));
            return static_cast<float>(texels[row * static_cast<size_t>(width) + column]);
        };
        return glm::mix(glm::mix(texel(0, 0), texel(1, 0), t.x), glm::mix(texel(0, 1), texel(1, 1), t.x),
                        t.y) /
               255.0f;
    }
};

struct Corner {
    glm::vec2 place, uv;
    glm::vec4 color; ///< 0..255, straight alpha
};

Corner cornerOf(const ImDrawVert& vertex) {
    const ImU32 c = vertex.col;
    const auto channel = [c](int shift) { return static_cast<float>(c >> shift & 0xff); };
    return {{vertex.pos.x, vertex.pos.y},
            {vertex.uv.x, vertex.uv.y},
            {channel(IM_COL32_R_SHIFT), channel(IM_COL32_G_SHIFT), channel(IM_COL32_B_SHIFT),
             channel(IM_COL32_A_SHIFT)}};
}

/// Twice the signed area of a, b, p.
double area(const glm::vec2& a, const glm::vec2& b, const glm::dvec2& p) {
    return (static_cast<double>(b.x) - static_cast<double>(a.x)) * (p.y - static_cast<double>(a.y)) -
           (static_cast<double>(b.y) - static_cast<double>(a.y)) * (p.x - static_cast<double>(a.x));
}

void blend(const glm::vec4& color, std::byte* pixel) {
    const float alpha = color.w / 255.0f;
    for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::byte>(
            std::lround(glm::mix(static_cast<float>(std::to_integer<int>(pixel[c])), color[c], alpha)));
}

/// Fills the pixels whose centres lie inside. A centre on an edge belongs to the triangle for which the edge
/// is a left or an upper one, so that of two triangles that share it exactly one fills it.
void fill(std::array<Corner, 3> t, const ImVec4& clip, const Atlas& atlas, PixelData& picture) {
    const auto exact = [](const glm::vec2& v) { return glm::dvec2(v); };
    double whole = area(t[0].place, t[1].place, exact(t[2].place));
    if (whole < 0.0) {
        std::swap(t[1], t[2]);
        whole = -whole;
    }
    if (!(whole > 0.0))
        return;
    const glm::vec2 low = glm::max(glm::min(glm::min(t[0].place, t[1].place), t[2].place), {clip.x, clip.y}),
                    high = glm::min(glm::max(glm::max(t[0].place, t[1].place), t[2].place), {clip.z, clip.w});
    const auto first = [](float edge) { return std::max(0, static_cast<int>(std::ceil(edge - 0.5f))); };
    const int right = std::min(picture.width, first(high.x)), lower = std::min(picture.height, first(high.y));
    std::array<bool, 3> owned{}; // the edge opposite of each corner
    for (size_t i = 0; i < 3; ++i) {
        const glm::vec2 along = t[(i + 2) % 3].place - t[(i + 1) % 3].place;
        owned[i] = along.y < 0.0f || (along.y == 0.0f && along.x > 0.0f);
    }
    for (int y = first(low.y); y < lower; ++y)
        for (int x = first(low.x); x < right; ++x) {
            const glm::dvec2 centre(x + 0.5, y + 0.5);
            std::array<double, 3> part{};
            bool inside = true;
            for (size_t i = 0; i < 3 && inside; ++i) {
                part[i] = area(t[(i + 1) % 3].place, t[(i + 2) % 3].place, centre);
                inside = part[i] > 0.0 || (part[i] == 0.0 && owned[i]);
            }
            if (!inside)
                continue;
            Corner here{{}, {}, glm::vec4(0.0f)};
            for (size_t i = 0; i < 3; ++i) {
                const auto share = static_cast<float>(part[i] / whole);
                here.uv += share * t[i].uv;
                here.color += share * t[i].color;
            }
            here.color.w *= atlas.at(here.uv);
            blend(here.color, picture.bytes.data() + 4 * (static_cast<ptrdiff_t>(y) * picture.width + x));
        }
}

void fill(const ImDrawData& data, const Atlas& atlas, PixelData& picture) {
    for (int l = 0; l < data.CmdListsCount; ++l) {
        const ImDrawList& list = *data.CmdLists[l];
        for (const ImDrawCmd& command : list.CmdBuffer)
            for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
                const auto corner = [&](unsigned k) {
                    const auto index = static_cast<int>(command.IdxOffset + i + k);
                    return cornerOf(
                        list.VtxBuffer[static_cast<int>(command.VtxOffset + list.IdxBuffer[index])]);
                };
                fill({corner(0), corner(1), corner(2)}, command.ClipRect, atlas, picture);
            }
    }
}

/// A context of its own, current during its life.
class OwnContext {
  public:
    OwnContext() : before_(ImGui::GetCurrentContext()), own_(ImGui::CreateContext()) {
        ImGui::SetCurrentContext(own_);
    }
    ~OwnContext() {
        ImGui::DestroyContext(own_);
        ImGui::SetCurrentContext(before_);
    }
    OwnContext(const OwnContext&) = delete;
    OwnContext& operator=(const OwnContext&) = delete;

  private:
    ImGuiContext *before_, *own_;
};

} // namespace

void drawGui(PixelData& picture, float scale, const std::function<void()>& draw) {
    const OwnContext context;
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(static_cast<float>(picture.width), static_cast<float>(picture.height));
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    applyStyle(std::min(scale, kLargestScale));
    Atlas atlas;
    unsigned char* texels = nullptr;
    io.Fonts->GetTexDataAsAlpha8(&texels, &atlas.width, &atlas.height);
    atlas.texels = texels;
    ImGui::NewFrame();
    draw();
    ImGui::Render();
    fill(*ImGui::GetDrawData(), atlas, picture);
}

} // namespace touchstone
