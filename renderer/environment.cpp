#include "renderer/environment.h"

#include "engine/core/error.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

glm::dvec3 directionAt(double u, double v) {
    const double turn = glm::two_pi<double>() * (u - 0.5), fall = glm::pi<double>() * v;
    return {std::sin(fall) * std::sin(turn), std::cos(fall), -std::sin(fall) * std::cos(turn)};
}

/// The panorama and its mip levels.
class Pyramid {
  public:
    explicit Pyramid(Panorama base) {
        levels_.push_back(std::move(base));
        while (levels_.back().width >= 8 && levels_.back().height >= 4)
            levels_.push_back(halved(levels_.back()));
    }

    /// Radiance around a unit direction, trilinear. `level` may be out of range.
    [[nodiscard]] glm::vec3 at(const glm::dvec3& direction, double level) const {
        const auto last = static_cast<double>(levels_.size() - 1);
        const double inside = std::clamp(level, 0.0, last);
        const auto low = static_cast<size_t>(inside);
        const auto share = static_cast<float>(inside - static_cast<double>(low));
        const glm::dvec2 uv(0.5 + std::atan2(direction.x, -direction.z) / glm::two_pi<double>(),
                            std::acos(std::clamp(direction.y, -1.0, 1.0)) / glm::pi<double>());
        const glm::vec3 sharp = bilinear(levels_[low], uv);
        return share > 0.0f ? glm::mix(sharp, bilinear(levels_[low + 1], uv), share) : sharp;
    }

    [[nodiscard]] double texelSolidAngle() const {
        return 4.0 * glm::pi<double>() / (static_cast<double>(levels_[0].width) * levels_[0].height);
    }

  private:
    static Panorama halved(const Panorama& from) {
        Panorama to{from.width / 2, from.height / 2, {}};
        to.texels.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height));
        const auto texel = [&](int x, int y) {
            return from
                .texels[static_cast<size_t>(y) * static_cast<size_t>(from.width) + static_cast<size_t>(x)];
        };
        size_t i = 0;
        for (int y = 0; y < to.height; ++y)
            for (int x = 0; x < to.width; ++x)
                to.texels[i++] = 0.25f * (texel(2 * x, 2 * y) + texel(2 * x + 1, 2 * y) +
                                          texel(2 * x, 2 * y + 1) + texel(2 * x + 1, 2 * y + 1));
        return to;
    }

    static glm::vec3 bilinear(const Panorama& map, const glm::dvec2& uv) {
        const double x = uv.x * map.width - 0.5,
                     y = std::clamp(uv.y * map.height - 0.5, 0.0, map.height - 1.0);
        const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(y);
        const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
        const int y1 = std::min(y0 + 1, map.height - 1);
        const auto texel = [&](int column, int row) {
            const int wrapped = (column + map.width) % map.width;
            return map.texels[static_cast<size_t>(row) * static_cast<size_t>(map.width) +
                              static_cast<size_t>(wrapped)];
        };
        return glm::mix(glm::mix(texel(x0, y0), texel(x0 + 1, y0), fx),
                        glm::mix(texel(x0, y1), texel(x0 + 1, y1), fx), fy);
    }

    std::vector<Panorama> levels_;
};

/// Projection on the nine real spherical harmonics, and the mean luminance.
struct Harmonics {
    std::array<glm::dvec3, 9> c{};
    double mean = 0.0;
};

Harmonics project(const Panorama& map) {
    Harmonics sum;
    for (int j = 0; j < map.height; ++j) {
        // The exact solid angle of a texel of this row.
        const double top = std::cos(glm::pi<double>() * j / map.height),
                     bottom = std::cos(glm::pi<double>() * (j + 1) / map.height);
        const double weight = glm::two_pi<double>() / map.width * (top - bottom);
        for (int i = 0; i < map.width; ++i) {
            const glm::dvec3 n = directionAt((i + 0.5) / map.width, (j + 0.5) / map.height);
            const glm::dvec3 light =
                weight * glm::dvec3(map.texels[static_cast<size_t>(j) * static_cast<size_t>(map.width) +
                                               static_cast<size_t>(i)]);
            const std::array<double, 9> y{0.282095,
                                          0.488603 * n.x,
                                          0.488603 * n.y,
                                          0.488603 * n.z,
                                          1.092548 * n.x * n.y,
                                          1.092548 * n.y * n.z,
                                          1.092548 * n.z * n.x,
                                          0.546274 * (n.x * n.x - n.y * n.y),
                                          0.315392 * (3.0 * n.z * n.z - 1.0)};
            for (size_t k = 0; k < 9; ++k)
                sum.c[k] += y[k] * light;
            sum.mean += glm::dot(light, glm::dvec3(0.2126, 0.7152, 0.0722)) / (4.0 * glm::pi<double>());
        }
    }
    return sum;
}

/// Irradiance / pi: the cosine lobe scales degrees 0, 1, 2 by 1, 2/3, 1/4; z² is 1 - x² - y².
std::array<glm::dvec3, 9> polynomial(const Harmonics& h) {
    const double one = 2.0 / 3.0 * 0.488603, two = 0.25 * 1.092548;
    const glm::dvec3 across = 0.25 * 0.546274 * h.c[7], along = 0.25 * 0.315392 * h.c[8];
    return {0.282095 * h.c[0] + 2.0 * along,
            one * h.c[1],
            one * h.c[2],
            one * h.c[3],
            two * h.c[4],
            two * h.c[5],
            two * h.c[6],
            across - 3.0 * along,
            -across - 3.0 * along};
}

/// One direction of the lobe about the z axis, with the pyramid level that matches its solid angle.
struct LobeSample {
    glm::dvec3 direction;
    double level = 0.0;
};

/// GGX half vectors for a viewer along the normal (Karis, "Real shading in Unreal Engine 4", 2013), read from
/// coarser levels where they are sparse (Křivánek and Colbert, "Real-time shading with filtered importance
/// sampling", 2008).
/// `count` pairs.
std::vector<LobeSample> lobeSamples(double roughness, uint32_t count, double texelSolidAngle) {
    std::vector<LobeSample> samples;
    const double a2 = std::pow(roughness, 4.0);
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t bits = i; // bit reversal: van der Corput's sequence
        bits = (bits << 16) | (bits >> 16);
        bits = ((bits & 0x55555555u) << 1) | ((bits & 0xAAAAAAAAu) >> 1);
        bits = ((bits & 0x33333333u) << 2) | ((bits & 0xCCCCCCCCu) >> 2);
        bits = ((bits & 0x0F0F0F0Fu) << 4) | ((bits & 0xF0F0F0F0u) >> 4);
        bits = ((bits & 0x00FF00FFu) << 8) | ((bits & 0xFF00FF00u) >> 8);
        const double u = (i + 0.5) / count, turn = glm::two_pi<double>() * bits / 4294967296.0;
        const double nh = std::sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u)), across = std::sqrt(1.0 - nh * nh);
        const glm::dvec3 h(across * std::cos(turn), across * std::sin(turn), nh);
        const glm::dvec3 l = 2.0 * nh * h - glm::dvec3(0.0, 0.0, 1.0);
        if (l.z <= 0.0)
            continue;
        const double d = nh * nh * (a2 - 1.0) + 1.0;
        const double density = a2 / (glm::pi<double>() * d * d) / 4.0;
        const double level = 0.5 * std::log2(0.5 / (count * density * texelSolidAngle)) + 1.0;
        samples.push_back({l, level});
        samples.push_back({{-l.x, -l.y, l.z}, level}); // in pairs the samples are symmetric
    }
    return samples;
}

glm::vec3 blurred(const Pyramid& pyramid, const std::vector<LobeSample>& samples, const glm::dvec3& n) {
    const glm::dvec3 side = glm::normalize(
        glm::cross(std::abs(n.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0), n));
    const glm::dvec3 other = glm::cross(n, side);
    glm::vec3 sum(0.0f);
    float weight = 0.0f;
    for (const LobeSample& sample : samples) {
        const glm::dvec3& l = sample.direction;
        const auto cosine = static_cast<float>(l.z);
        sum += cosine * pyramid.at(l.x * side + l.y * other + l.z * n, sample.level);
        weight += cosine;
    }
    return sum / weight;
}

} // namespace

glm::dvec3 cubeDirection(int face, double s, double t) {
    const double a = 2.0 * s - 1.0, b = 2.0 * t - 1.0;
    const std::array<glm::dvec3, 6> directions{glm::dvec3(1.0, -b, -a), glm::dvec3(-1.0, -b, a),
                                               glm::dvec3(a, 1.0, b),   glm::dvec3(a, -1.0, -b),
                                               glm::dvec3(a, -b, 1.0),  glm::dvec3(-a, -b, -1.0)};
    return glm::normalize(directions[static_cast<size_t>(face)]);
}

std::shared_ptr<const Environment> prefilter(const Panorama& panorama, const std::atomic<bool>* cancel) {
    const Harmonics harmonics = project(panorama);
    if (!(harmonics.mean > 0.0) || !std::isfinite(harmonics.mean))
        return nullptr;
    const double scale = Environment::kMeanRadiance / harmonics.mean;
    auto environment = std::make_shared<Environment>();
    environment->irradiance = polynomial(harmonics);
    for (glm::dvec3& k : environment->irradiance)
        k *= scale;
    const Pyramid pyramid(panorama);
    for (int level = 0; level < Environment::kLevels; ++level) {
        const int side = Environment::kSide >> level;
        const std::vector<LobeSample> samples =
            level == 0 ? std::vector<LobeSample>{}
                       : lobeSamples(static_cast<double>(level) / (Environment::kLevels - 1),
                                     8u << std::min(level, 5), pyramid.texelSolidAngle());
        std::vector<uint16_t>& texels = environment->levels[static_cast<size_t>(level)];
        texels.reserve(size_t{24} * static_cast<size_t>(side) * static_cast<size_t>(side));
        // A texel of the cube is about as wide as this many texels of the panorama.
        const double sharpest = std::log2(std::max(1.0, panorama.width / (4.0 * side)));
        for (int face = 0; face < 6; ++face)
            for (int y = 0; y < side; ++y) {
                if (cancel != nullptr && cancel->load(std::memory_order_relaxed))
                    return nullptr;
                for (int x = 0; x < side; ++x) {
                    const glm::dvec3 n = cubeDirection(face, (x + 0.5) / side, (y + 0.5) / side);
                    const glm::vec3 light =
                        level == 0 ? pyramid.at(n, sharpest) : blurred(pyramid, samples, n);
                    for (int c = 0; c < 3; ++c)
                        texels.push_back(
                            glm::packHalf1x16(std::min(static_cast<float>(scale) * light[c], 60000.0f)));
                    texels.push_back(glm::packHalf1x16(1.0f));
                }
            }
    }
    return environment;
}

std::shared_ptr<const Environment> loadEnvironment(const std::filesystem::path& file,
                                                   const std::atomic<bool>* cancel) {
    const Panorama panorama = readPanorama(file);
    auto environment = prefilter(panorama, cancel);
    if (!environment && (cancel == nullptr || !cancel->load(std::memory_order_relaxed)))
        throw Error(file.string(), "", "the environment is black", "choose a panorama with some light in it");
    return environment;
}

} // namespace touchstone
