#include "haptics/settings/haptic_settings.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace touchstone {

namespace {

constexpr std::array kInfos{
    SettingInfo{"contact", "", "sweep, neighbourhood, rays",
                "how contacts are found; neighbourhood: Ho's walk over the mesh; rays: Zilles' god-object; "
                "both a point without a radius"},
    SettingInfo{"precision", "", "double, single",
                "single: contact=rays finds contacts and solves for the proxy in floats"},
    SettingInfo{"forceShading", "", "off, twoPass, projected, direction, material",
                "interpolated normals: Ruspini's two passes, Ho's projection, Morgenbesser's direction, or "
                "what each material says"},
    SettingInfo{
        "texture", "", "off, law, blinn, minsky",
        "normal and height maps: displacement force law, Blinn's bump normal, Minsky's lateral force"},
    SettingInfo{"friction", "", "off, zilles, ho, elastoplastic",
                "stiction point with static and dynamic coefficients; zilles: sawtooth; ho: two states; "
                "elastoplastic: creeps before it slips"},
    SettingInfo{"proxyRadius", "m", "0 .. 0.05", "radius of the proxy sphere; 0 is the god-object"},
    SettingInfo{"stiffness", "N/m", "0 .. 100000", "0: the material's, else the device's recommendation"},
    SettingInfo{"damping", "N s/m", "-1 .. 1000", "below 0: the material's, else none"},
    SettingInfo{"staticFriction", "", "-1 .. 100", "below 0: the material's"},
    SettingInfo{"dynamicFriction", "", "-1 .. 100", "below 0: the material's; never above the static one"},
    SettingInfo{"shadingTiltLimit", "deg", "0 .. 90", "most that shading tilts the true normal"},
    SettingInfo{"textureTiltLimit", "deg", "0 .. 90", "felt normals are compressed below it; 90: no limit"},
    SettingInfo{"textureStrength", "", "0 .. 1", "scales heights and the normal map's tilt"},
    SettingInfo{"textureFilter", "", "nearest, bilinear, bicubic, mip",
                "how maps are read between texels; mip: bilinear, coarser the faster the stroke; the others "
                "let fine relief buzz"},
    SettingInfo{"textureGradient", "", "central, precomputed, analytic",
                "slope of height maps: differences over a texel, kept for each texel, or the filter's own "
                "derivative"},
    SettingInfo{"iterationBudget", "", "1 .. 1000", "proxy moves a tick; fewer feels sticky"},
    SettingInfo{"passivity", "", "off, observe, control",
                "energy given to the hand: counted, or also damped away where it is more than was taken"},
    SettingInfo{"forceEnabled", "", "off, on", "off: contact goes on, the device gets no force"},
};

constexpr double kDegree = 0.017453292519943295;

template <class Enum, size_t N>
bool setChoice(Enum& field, std::string_view value, const std::array<std::string_view, N>& names) {
    for (size_t i = 0; i < N; ++i)
        if (names[i] == value) {
            field = static_cast<Enum>(i);
            return true;
        }
    return false;
}

bool setNumber(double& field, std::string_view value, double low, double high, double unit = 1.0) {
    double number = 0.0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (error != std::errc{} || end != value.data() + value.size() || !(number >= low && number <= high))
        return false;
    field = number * unit;
    return true;
}

constexpr std::array<std::string_view, 3> kContactNames{"sweep", "neighbourhood", "rays"};
constexpr std::array<std::string_view, 2> kPrecisionNames{"double", "single"};
constexpr std::array<std::string_view, 5> kShadingNames{"off", "twoPass", "projected", "direction",
                                                        "material"};
constexpr std::array<std::string_view, 4> kTextureNames{"off", "law", "blinn", "minsky"};
constexpr std::array<std::string_view, 4> kFilterNames{"nearest", "bilinear", "bicubic", "mip"};
constexpr std::array<std::string_view, 3> kGradientNames{"central", "precomputed", "analytic"};
constexpr std::array<std::string_view, 4> kFrictionNames{"off", "zilles", "ho", "elastoplastic"};
constexpr std::array<std::string_view, 3> kPassivityNames{"off", "observe", "control"};
constexpr std::array<std::string_view, 2> kSwitchNames{"off", "on"};

bool assign(HapticSettings& s, std::string_view name, std::string_view value) {
    if (name == "contact")
        return setChoice(s.contact, value, kContactNames);
    if (name == "precision")
        return setChoice(s.precision, value, kPrecisionNames);
    if (name == "forceShading")
        return setChoice(s.forceShading, value, kShadingNames);
    if (name == "texture")
        return setChoice(s.texture, value, kTextureNames);
    if (name == "friction")
        return setChoice(s.friction, value, kFrictionNames);
    if (name == "passivity")
        return setChoice(s.passivity, value, kPassivityNames);
    if (name == "proxyRadius")
        return setNumber(s.proxyRadius, value, 0.0, 0.05);
    if (name == "stiffness")
        return setNumber(s.stiffness, value, 0.0, 1e5);
    if (name == "damping")
        return setNumber(s.damping, value, -1.0, 1e3);
    if (name == "staticFriction")
        return setNumber(s.staticFriction, value, -1.0, 100.0);
    if (name == "dynamicFriction")
        return setNumber(s.dynamicFriction, value, -1.0, 100.0);
    if (name == "shadingTiltLimit")
        return setNumber(s.shadingTiltLimit, value, 0.0, 90.0, kDegree);
    if (name == "textureTiltLimit")
        return setNumber(s.textureTiltLimit, value, 0.0, 90.0, kDegree);
    if (name == "textureStrength")
        return setNumber(s.textureStrength, value, 0.0, 1.0);
    if (name == "textureFilter")
        return setChoice(s.textureFilter, value, kFilterNames);
    if (name == "textureGradient")
        return setChoice(s.textureGradient, value, kGradientNames);
    if (name == "iterationBudget") {
        double number = 0.0;
        if (!setNumber(number, value, 1.0, 1000.0) || number != std::floor(number))
            return false;
        s.iterationBudget = static_cast<int>(number);
        return true;
    }
    if (name == "forceEnabled") {
        int on = 0;
        if (!setChoice(on, value, kSwitchNames))
            return false;
        s.forceEnabled = on != 0;
        return true;
    }
    return false;
}

std::string text(double number) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
    return {buffer.data(), result.ptr};
}

/// An angle in degrees, in the shorter form where it converts to the same radians.
std::string degrees(double radians) {
    const double exact = radians / kDegree;
    std::array<char, 32> buffer{};
    const auto result =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), exact, std::chars_format::general, 12);
    double rounded = exact;
    std::from_chars(buffer.data(), result.ptr, rounded);
    return text(rounded * kDegree == radians ? rounded : exact);
}

} // namespace

std::span<const SettingInfo> settingInfos() {
    return kInfos;
}

std::string setSetting(HapticSettings& settings, std::string_view name, std::string_view value) {
    for (const SettingInfo& info : kInfos) {
        if (info.name != name)
            continue;
        HapticSettings changed = settings;
        if (!assign(changed, name, value))
            return "'" + std::string(value) + "' is not a value of " + std::string(name) +
                   "; allowed: " + std::string(info.values) +
                   (info.unit.empty() ? "" : " " + std::string(info.unit));
        settings = changed;
        return {};
    }
    std::string known;
    for (const SettingInfo& info : kInfos)
        known += (known.empty() ? "" : ", ") + std::string(info.name);
    return "there is no setting '" + std::string(name) + "'; known: " + known;
}

std::vector<std::string> settingWarnings(const HapticSettings& settings) {
    std::vector<std::string> warnings;
    if (settings.contact != ContactMethod::Sweep && settings.proxyRadius > 0.0)
        warnings.emplace_back("contact=" + settingValue(settings, "contact") +
                              " is a point method: proxyRadius is ignored");
    if (settings.precision == Precision::Single && settings.contact != ContactMethod::Rays)
        warnings.emplace_back("precision=single is of contact=rays only: contact=" +
                              settingValue(settings, "contact") + " stays double");
    if (settings.textureFilter == TextureFilter::Nearest &&
        settings.textureGradient == TextureGradient::Analytic)
        warnings.emplace_back("textureFilter=nearest makes a staircase, whose textureGradient=analytic is "
                              "zero: height maps tilt nothing");
    if (settings.staticFriction >= 0.0 && settings.dynamicFriction > settings.staticFriction)
        warnings.emplace_back("dynamicFriction above staticFriction; clamped to it");
    return warnings;
}

std::string settingValue(const HapticSettings& s, std::string_view name) {
    const auto choice = [](const auto& names, auto value) {
        return std::string(names[static_cast<size_t>(value)]);
    };
    if (name == "contact")
        return choice(kContactNames, s.contact);
    if (name == "precision")
        return choice(kPrecisionNames, s.precision);
    if (name == "forceShading")
        return choice(kShadingNames, s.forceShading);
    if (name == "texture")
        return choice(kTextureNames, s.texture);
    if (name == "friction")
        return choice(kFrictionNames, s.friction);
    if (name == "passivity")
        return choice(kPassivityNames, s.passivity);
    if (name == "proxyRadius")
        return text(s.proxyRadius);
    if (name == "stiffness")
        return text(s.stiffness);
    if (name == "damping")
        return text(s.damping);
    if (name == "staticFriction")
        return text(s.staticFriction);
    if (name == "dynamicFriction")
        return text(s.dynamicFriction);
    if (name == "shadingTiltLimit")
        return degrees(s.shadingTiltLimit);
    if (name == "textureTiltLimit")
        return degrees(s.textureTiltLimit);
    if (name == "textureStrength")
        return text(s.textureStrength);
    if (name == "textureFilter")
        return choice(kFilterNames, s.textureFilter);
    if (name == "textureGradient")
        return choice(kGradientNames, s.textureGradient);
    if (name == "iterationBudget")
        return text(s.iterationBudget);
    if (name == "forceEnabled")
        return choice(kSwitchNames, s.forceEnabled ? 1 : 0);
    return {};
}

} // namespace touchstone
