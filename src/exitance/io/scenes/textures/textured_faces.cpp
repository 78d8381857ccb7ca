#include "exitance/io/scenes/textures/textured_faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/scene/material_name.hpp"

namespace exitance {
namespace {

constexpr int code_tolerance = 2;  ///< Tolerance of colours, in codes of 256.

/// Area of a polygon.
double area_of(const SceneDescription& d, const SceneDescription::Face& face) {
    Vec3 sum;
    for (std::size_t i = 2; i < face.corners.size(); ++i)
        sum = sum + cross(d.points[face.corners[i - 1]] - d.points[face.corners[0]],
                          d.points[face.corners[i]] - d.points[face.corners[0]]);
    return 0.5 * norm(sum);
}

}  // namespace

ShownPart relative(const TextureArea& picture, std::span<const Vec2> outline, TextureArea::Wrap wrap_s,
                   TextureArea::Wrap wrap_t) {
    const TextureArea::Part part = picture.part(outline, wrap_s, wrap_t);
    const TextureArea::Colour whole = picture.mean();
    ShownPart out;
    for (std::size_t b = 0; b < bands; ++b) {
        // With one band, a colour is replaced by the mean of its channels.
        const auto value = [&](const TextureArea::Colour& c) {
            return bands == 1 ? (c[0] + c[1] + c[2]) / 3 : c[b * 3 / bands];
        };
        const double by = value(whole) > 0 ? 1 / value(whole) : 0;
        out.mean[b] = by * value(part.mean), out.deviation[b] = by * value(part.deviation);
        out.lowest[b] = by * value(part.lowest), out.highest[b] = by * value(part.highest);
    }
    return out;
}

void TexturedFaces::note(Steepest& steepest, const Spectrum& whole, const ShownPart& part,
                         const std::string& material) const {
    bool varies = false;
    for (std::size_t b = 0; b < bands; ++b) {
        const double brightest = std::max(max(whole), 1e-300), mean = whole[b] * part.mean[b];
        const double lowest = whole[b] * part.lowest[b], highest = whole[b] * part.highest[b];
        if (srgb_code(highest / std::max(1.0, brightest)) - srgb_code(lowest / std::max(1.0, brightest)) <=
            code_tolerance)
            continue;
        varies = true;
        const double ratio = mean > 0 ? std::max(highest - mean, mean - lowest) / mean : 0;
        if (ratio > steepest.ratio)
            steepest.ratio = ratio, steepest.lowest = lowest, steepest.highest = highest, steepest.material = material;
    }
    steepest.faces += varies;
}

void TexturedFaces::show(std::size_t face, const ShownColour& colour) {
    const std::uint32_t own = out_->faces[face].material;
    const Material& material = out_->materials[own];
    const double brightest = std::max(max(material.exitance), 1e-300);
    Spectrum reflectance = material.reflectance * colour.reflectance.mean;
    for (double& v : reflectance.value) v = std::min(v, whitest_);
    const Spectrum exitance = material.exitance * colour.exitance.mean;
    note(reflects_, material.reflectance, colour.reflectance, material.name);
    if (material.emits()) note(emits_, material.exitance, colour.exitance, material.name);
    const double area = area_of(*out_, out_->faces[face]);
    const Spectrum deviation = material.reflectance * colour.reflectance.deviation;
    const auto add_squares = [&](Sum& sum) {
        sum.squares += area * (reflectance * reflectance + deviation * deviation), sum.area += area;
    };
    Key key = {static_cast<int>(out_->faces[face].material)};
    bool differs = false;
    const auto add = [&](double shown, double whole) {
        differs |= std::abs(srgb_code(shown) - srgb_code(whole)) > code_tolerance;
        key.push_back(srgb_code(shown) / code_tolerance);
    };
    for (std::size_t b = 0; b < bands; ++b) add(reflectance[b], material.reflectance[b]);
    for (std::size_t b = 0; b < bands; ++b) add(exitance[b] / brightest, material.exitance[b] / brightest);
    if (!differs) {
        Sum& sum = unchanged_[own];
        sum.reflectance += area * reflectance;
        return add_squares(sum);
    }
    Sum& sum = sums_[key];
    sum.reflectance += area * reflectance, sum.exitance += area * exitance;
    add_squares(sum);
    sum.faces.push_back(face);
}

/// Computes the RMS deviation from the material's mean m by E (r - m)^2 = E r^2 - 2 m E r + m^2.
void TexturedFaces::set_deviation(std::size_t material, const Sum& sum, const Spectrum& mean) {
    if (deviation_.size() <= material) deviation_.resize(material + 1);
    constexpr double rounding = 1e-12;  // relative rounding error of the second moment
    for (std::size_t b = 0; b < bands; ++b) {
        const double second = sum.squares[b] / sum.area, first = sum.reflectance[b] / sum.area;
        const double about_mean = second - 2 * mean[b] * first + mean[b] * mean[b];
        deviation_[material][b] = about_mean > rounding * second ? std::sqrt(about_mean) : 0;
    }
}

std::size_t TexturedFaces::finish() {
    std::size_t count = 0;
    for (const auto& [key, sum] : sums_) {
        if (!(sum.area > 0)) continue;  // without area there is no light
        Material material = out_->materials[static_cast<std::size_t>(key[0])];
        material.reflectance = sum.reflectance / sum.area, material.exitance = sum.exitance / sum.area;
        material.name = name_with_colour(
            material.name, material.emits() ? material.exitance / max(material.exitance) : material.reflectance);
        for (const std::size_t f : sum.faces)
            out_->faces[f].material = static_cast<std::uint32_t>(out_->materials.size());
        set_deviation(out_->materials.size(), sum, material.reflectance);
        out_->materials.push_back(std::move(material));
        count += sum.faces.size();
    }
    for (const auto& [material, sum] : unchanged_)
        if (sum.area > 0) set_deviation(material, sum, out_->materials[material].reflectance);
    sums_.clear(), unchanged_.clear();
    return count;
}

std::optional<Finding> TexturedFaces::finding() const {
    if (reflects_.faces == 0 && emits_.faces == 0) return std::nullopt;
    const auto says = [](const Steepest& s, const char* quantity, const char* unit) {
        return fmt::format(
            "{} varies within {}, most in '{}': from {:.3g} to {:.3g}{}; its mean is used, {} by up to "
            "{:.3g}%",
            quantity, s.faces == 1 ? "1 face" : fmt::format("{} faces", s.faces), s.material, s.lowest, s.highest, unit,
            "so that light near such faces may be off", 100 * s.ratio);
    };
    std::string message = reflects_.faces > 0 ? says(reflects_, "reflectance", "") : "";
    if (emits_.faces > 0) message += (message.empty() ? "" : "; ") + says(emits_, "emission", " W/m^2");
    return Finding{Finding::Kind::warning, "", 0, std::move(message),
                   "cut such faces where their picture changes; the error estimate counts the reflectance"};
}

}  // namespace exitance
