#include "haptics/settings/haptic_settings.h"

#include "engine/core/field_rows.h"
#include "engine/core/member_count.h"

#include <array>
#include <string>

namespace touchstone {

namespace {

using S = HapticSettings;

constexpr std::string_view kContact[]{"sweep", "neighbourhood", "rays", "virtualPoint", "potential"},
    kPrecision[]{"double", "single"},
    kShading[]{"off", "twoPass", "projected", "direction", "material", "singleRound", "bezier"},
    kTexture[]{"off", "law", "blinn", "minsky", "blinnMagnitude"},
    kFilter[]{"nearest", "bilinear", "bicubic", "mip"}, kGradient[]{"central", "precomputed", "analytic"},
    kFriction[]{"off", "zilles", "ho", "elastoplastic", "velocityThreshold", "kim"},
    kPrograms[]{"off", "dual", "central", "noGradient"}, kPassivity[]{"off", "observe", "control"},
    kIntegrator[]{"explicit", "semiImplicit", "implicit"}, kGrasp[]{"off", "button", "touch"};

constexpr double kDegree = 0.017453292519943295;

constexpr std::array kFields{
    wordField<&S::contact>("contact", kContact,
                           "how contacts are found; neighbourhood: Ho's walk over the mesh; rays: Zilles' "
                           "god-object; virtualPoint and potential: Kim's point of a distance field and the "
                           "force it replaces; all but sweep a point without a radius"),
    wordField<&S::precision>("precision", kPrecision,
                             "single: contact=rays finds contacts and solves for the proxy in floats"),
    wordField<&S::forceShading>(
        "forceShading", kShading,
        "interpolated normals: Ruspini's two passes, Ho's projection, Morgenbesser's "
        "direction, the choice of each material, or the two passes once a tick; bezier: two "
        "passes with a quadratic patch of normals"),
    wordField<&S::texture>(
        "texture", kTexture,
        "normal and height maps: displacement force law, Blinn's bump normal, Minsky's lateral force, or "
        "Blinn's normal with a magnitude that follows the bump map"),
    wordField<&S::friction>(
        "friction", kFriction,
        "stiction point with static and dynamic coefficients; zilles: sawtooth; ho: two "
        "states; elastoplastic: creeps before it slips; velocityThreshold: viscous above a speed; kim: the "
        "contact point lags behind the hand, and creeps at rest"),
    wordField<&S::programs>(
        "programs", kPrograms,
        "haptic programs, and where the gradient of a displacement comes from: dual numbers, "
        "central differences (six more runs), or nowhere; off: surfaces are plain"),
    switchField<&S::deformation>("deformation",
                                 "dents under the contact, where a material gives way; off: it is hard"),
    numberField<&S::proxyRadius>("proxyRadius", "m", 0.0, 0.05,
                                 "radius of the proxy sphere; 0 is the god-object"),
    numberField<&S::stiffness>("stiffness", "N/m", 0.0, 1e5,
                               "0: the material's, else the device's recommendation"),
    numberField<&S::damping>("damping", "N s/m", -1.0, 1e3, "below 0: the material's, else none"),
    numberField<&S::staticFriction>("staticFriction", "", -1.0, 100.0, "below 0: the material's"),
    numberField<&S::dynamicFriction>("dynamicFriction", "", -1.0, 100.0,
                                     "below 0: the material's; never above the static one"),
    numberField<&S::frictionThreshold>(
        "frictionThreshold", "m/s", 0.0, 1.0,
        "friction=velocityThreshold: a contact that slides more slowly sticks"),
    numberField<&S::frictionViscosity>(
        "frictionViscosity", "N s/m", 0.0, 1e3,
        "friction=velocityThreshold: friction over speed while sliding, up to the "
        "dynamic limit"),
    numberField<&S::frictionDepth>("frictionDepth", "1/m", 0.0, 1e4,
                                   "friction=kim: growth of friction with the depth of the hand"),
    numberField<&S::forceThreshold>("forceThreshold", "N", 0.0, 100.0,
                                    "contact=virtualPoint and potential: largest force; 0: no threshold"),
    numberField<&S::shadingTiltLimit>("shadingTiltLimit", "deg", 0.0, 90.0,
                                      "most that shading tilts the true normal", kDegree),
    numberField<&S::textureTiltLimit>("textureTiltLimit", "deg", 0.0, 90.0,
                                      "felt normals are compressed below it; 90: no limit", kDegree),
    numberField<&S::textureStrength>("textureStrength", "", 0.0, 1.0,
                                     "scales heights and the normal map's tilt"),
    wordField<&S::textureFilter>("textureFilter", kFilter,
                                 "how maps are read between texels; mip: bilinear, coarser the faster the "
                                 "stroke; the others let fine bump height buzz"),
    wordField<&S::textureGradient>(
        "textureGradient", kGradient,
        "slope of height maps: differences over a texel, kept for each texel, or the "
        "filter's own derivative"),
    numberField<&S::iterationBudget>("iterationBudget", "", 1.0, 1000.0,
                                     "proxy moves a tick; fewer feels sticky"),
    wordField<&S::passivity>(
        "passivity", kPassivity,
        "energy given to the hand: counted, or also damped away where it is more than was taken"),
    numberField<&S::animationSpeed>("animationSpeed", "", -100.0, 100.0,
                                    "seconds of the scene's animation in one second; 0: it stands still"),
    numberField<&S::animationOffset>("animationOffset", "s", -1e9, 1e9, "time of the animation at the start"),
    wordField<&S::integrator>(
        "integrator", kIntegrator,
        "motion of rigid bodies: explicit Euler, which gains energy; semi-implicit, which keeps it; "
        "implicit in springs and touch, which loses it"),
    numberField<&S::gravity>("gravity", "m/s^2", 0.0, 100.0, "pulls rigid bodies down; 0: none"),
    wordField<&S::grasp>(
        "grasp", kGrasp,
        "the hand takes hold of the body that it touches: while the device's first button is "
        "down, or as soon as it touches one"),
    numberField<&S::forceScale>("forceScale", "", 0.0, 1.0,
                                "fraction of the contact's force that the device gets"),
    switchField<&S::forceEnabled>("forceEnabled", "off: contact goes on, the device gets no force"),
};
static_assert(kFields.size() == memberCount<S>(), "a setting is missing from the table");

const StructField<S>* find(std::string_view name) {
    return findField(settingFields(), name);
}

} // namespace

std::span<const StructField<HapticSettings>> settingFields() {
    return kFields;
}

std::string setSetting(HapticSettings& settings, std::string_view name, std::string_view value) {
    const StructField<S>* field = find(name);
    if (field == nullptr)
        return "there is no setting '" + std::string(name) + "'; known: " + fieldNames(settingFields());
    double number = 0.0;
    if (!readValue(*field, value, number))
        return refusedValue(*field, value);
    field->set(settings, number);
    return {};
}

std::string settingValue(const HapticSettings& settings, std::string_view name) {
    const StructField<S>* field = find(name);
    return field != nullptr ? writtenValue(*field, field->get(settings)) : std::string();
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

} // namespace touchstone
