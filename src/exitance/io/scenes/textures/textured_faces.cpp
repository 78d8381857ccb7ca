#include "exitance/io/scenes/textures/textured_faces.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/scene/material_name.hpp"

namespace exitance {
namespace {

constexpr int step = 2;  ///< Of the 256 of a code.

/// Twice the area of a polygon as a vector.
double area_of(const SceneDescription& d, const SceneDescription::Face& face) {
    Vec3 sum;
    for (std::size_t i = 2; i < face.corners.size(); ++i)
        sum = sum + cross(d.points[face.corners[i - 1]] - d.points[face.corners[0]],
                          d.points[face.corners[i]] - d.points[face.corners[0]]);
    return 0.5 * norm(sum);
}

}  // namespace

Spectrum relative(const TextureArea& picture, std::span<const Vec2> outline, TextureArea::Wrap wrap_s,
                  TextureArea::Wrap wrap_t) {
    const TextureArea::Colour part = picture.mean(outline, wrap_s, wrap_t), whole = picture.mean();
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) {
        // With one band a colour is its mean.
        const auto value = [&](const TextureArea::Colour& c) {
            return bands == 1 ? (c[0] + c[1] + c[2]) / 3 : c[b * 3 / bands];
        };
        out[b] = value(whole) > 0 ? value(part) / value(whole) : 0;
    }
    return out;
}

void TexturedFaces::show(std::size_t face, const ShownColour& colour) {
    const Material& material = out_->materials[out_->faces[face].material];
    const double brightest = std::max(max(material.exitance), 1e-300);
    Spectrum reflectance = material.reflectance * colour.reflectance;
    for (double& v : reflectance.value) v = std::min(v, whitest_);
    const Spectrum exitance = material.exitance * colour.exitance;
    Key key = {static_cast<int>(out_->faces[face].material)};
    bool differs = false;
    const auto add = [&](double shown, double whole) {
        differs |= std::abs(srgb_code(shown) - srgb_code(whole)) > step;
        key.push_back(srgb_code(shown) / step);
    };
    for (std::size_t b = 0; b < bands; ++b) add(reflectance[b], material.reflectance[b]);
    for (std::size_t b = 0; b < bands; ++b) add(exitance[b] / brightest, material.exitance[b] / brightest);
    if (!differs) return;
    Sum& sum = sums_[key];
    const double area = area_of(*out_, out_->faces[face]);
    sum.reflectance += area * reflectance, sum.exitance += area * exitance;
    sum.area += area;
    sum.faces.push_back(face);
}

std::size_t TexturedFaces::finish() {
    std::size_t count = 0;
    for (const auto& [key, sum] : sums_) {
        if (!(sum.area > 0)) continue;  // no light either
        Material material = out_->materials[static_cast<std::size_t>(key[0])];
        material.reflectance = sum.reflectance / sum.area, material.exitance = sum.exitance / sum.area;
        material.name = name_with_colour(
            material.name, material.emits() ? material.exitance / max(material.exitance) : material.reflectance);
        for (const std::size_t f : sum.faces)
            out_->faces[f].material = static_cast<std::uint32_t>(out_->materials.size());
        out_->materials.push_back(std::move(material));
        count += sum.faces.size();
    }
    sums_.clear();
    return count;
}

}  // namespace exitance
