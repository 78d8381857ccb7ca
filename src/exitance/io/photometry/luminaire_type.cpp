#include "exitance/io/photometry/luminaire_type.hpp"

#include <cmath>
#include <filesystem>

namespace exitance {
namespace {

/// Value of the first of some keywords that the file has and that is not "none"; else empty.
std::string value_of(const Photometry& p, std::initializer_list<const char*> keys) {
    for (const char* key : keys)
        for (const auto& [name, value] : p.keywords)
            if (name == key && !value.empty() && value != "none") return value;
    return {};
}

std::vector<double> curve_towards(const Photometry& p, const Vec3& towards, double factor) {
    std::vector<double> out;
    for (int angle = -IntensityCurves::last; angle <= IntensityCurves::last; ++angle) {
        const double a = angle * degree;
        out.push_back(factor * p.intensity({std::sin(a) * towards.x, std::sin(a) * towards.y, -std::cos(a)}));
    }
    return out;
}

}  // namespace

IntensityCurves intensity_curves(const Photometry& p) {
    const double factor = p.lamp_lumens ? 1000 / *p.lamp_lumens : 1;  // derived from the unit, cd per 1000 lm
    return {curve_towards(p, {1, 0, 0}, factor), curve_towards(p, {0, 1, 0}, factor), p.lamp_lumens.has_value()};
}

LuminaireType luminaire_type_of(const Photometry& p) {
    const std::string maker = value_of(p, {"company", "MANUFAC"}),
                      product = value_of(p, {"luminaire", "LUMINAIRE", "luminaire number", "LUMCAT"});
    LuminaireType out;
    out.file = std::filesystem::path(p.file).filename().string();
    out.name = maker.empty() || product.starts_with(maker) ? product : maker + " " + product;
    if (product.empty()) out.name = std::filesystem::path(out.file).stem().string();
    out.flux = p.flux(), out.watts = p.watts, out.curves = intensity_curves(p);
    return out;
}

}  // namespace exitance
