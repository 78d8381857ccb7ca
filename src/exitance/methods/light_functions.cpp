#include "exitance/methods/light_functions.hpp"

#include <cmath>

#include "exitance/core/parallel.hpp"
#include "exitance/solve/conserving_transport.hpp"

namespace exitance {

ElementFunction dark(const Stage& stage) {
    ElementFunction out;
    for (const auto& [region, patch] : stage.pieces) out.tree.add_root(region, patch);
    out.first_value.resize(out.tree.size(), 0);
    out.values.assign(4, {});
    return out;
}

namespace {

/// Direct light as projected, on every leaf.
ElementFunction as_function(const DirectProjection& direct) {
    ElementFunction out;
    out.tree = direct.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (ElementId e : out.tree.leaves()) {
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (const Spectrum& corner : direct.fit[e].corners) out.add_value(corner);
    }
    return out;
}

}  // namespace

ElementFunction constant_on_leaves(const GlobalLight& light) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        out.first_value[light.numbering.leaves[i]] = static_cast<std::uint32_t>(out.values.size());
        for (int corner = 0; corner < 4; ++corner) out.add_value(light.indirect[i]);
    }
    return out;
}

ElementFunction polynomials_on_leaves(const GlobalLight& light) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        for (int corner = 0; corner < out.tree.patch(e).corner_count(); ++corner)
            out.add_value(light.indirect_corners[i][static_cast<std::size_t>(corner)]);
    }
    return out;
}

ElementFunction gathered_light(const Scene& scene, const DirectProjection& direct, const GlobalLight& light,
                               const Spectrum& c) {
    ElementFunction out;
    out.tree = light.tree;
    out.first_value.resize(out.tree.size(), 0);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const Material& material = scene.material(out.tree.region(e));
        out.first_value[e] = static_cast<std::uint32_t>(out.values.size());
        const Spectrum mean = light.direct_share * light.direct[i];
        for (std::size_t k = 0; k < 4; ++k) {
            const Spectrum& E_dir = light.on_projection            ? direct.fit[e].corners[k]
                                    : light.direct_corners.empty() ? light.direct[i]
                                                                   : light.direct_corners[i][k];
            const Spectrum& E_ind = light.indirect_corners.empty() ? light.indirect[i] : light.indirect_corners[i][k];
            out.add_value(material.reflectance * (E_dir - light.direct_share * E_dir + mean + E_ind) +
                          c * material.exitance);
        }
    }
    return out;
}

DeliveredLight::DeliveredLight(const Scene& scene, const ElementFunction& indirect, const DirectProjection& direct,
                               const Spectrum& direct_weight, const Spectrum& c)
    : scene_(scene),
      indirect_(indirect, scene.regions().size()),
      direct_(as_function(direct), scene.regions().size()),
      direct_weight_(direct_weight),
      c_(c) {}

void DeliveredLight::read(std::span<const HitPoint> hits, std::span<Spectrum> values) const {
    constexpr std::size_t together = 64;
    std::array<Spectrum, together> direct;
    indirect_.read(hits, values);
    for (std::size_t first = 0; first < hits.size(); first += together) {
        const std::size_t count = std::min(together, hits.size() - first);
        direct_.read(hits.subspan(first, count), std::span(direct).first(count));
        for (std::size_t i = 0; i < count; ++i) {
            const Material& material = scene_.material(hits[first + i].region);
            Spectrum& b = values[first + i];
            b = material.reflectance * (b + direct_weight_ * direct[i]) + c_ * material.exitance;
        }
    }
}

void keep_flux(ElementFunction& gathered, const ElementFunction& from, std::span<const double> kept) {
    const auto flux = [](const ElementFunction& f, std::span<const double> share) {
        const std::vector<ElementId> leaves = f.tree.leaves();
        EXI_ASSERT(share.empty() || share.size() == leaves.size());
        // A linear or bilinear function has its mean at the centre of its element.
        return parallel_sum<Spectrum>(leaves.size(), [&](std::size_t i) {
            return (share.empty() ? 1 : share[i]) * f.tree.area(leaves[i]) *
                   f.at({leaves[i], f.tree.centre(leaves[i])});
        });
    };
    const Spectrum arriving = flux(from, kept);
    if (!is_kept(arriving, flux(from, {}))) return;
    const Spectrum scale = conserving_scale(arriving, flux(gathered, {}));
    for (std::array<float, bands>& value : gathered.values)
        for (std::size_t b = 0; b < bands; ++b) value[b] = static_cast<float>(scale[b] * value[b]);
}

double rms_standard_error(const Stage& stage, const GlobalLight& light) {
    double sum = 0;
    for (std::size_t i = 0; i < light.standard_error.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        const Spectrum& rho = stage.scene.material(light.tree.region(e)).reflectance;
        sum += light.tree.area(e) * squared(rho * light.standard_error[i]) / static_cast<double>(bands);
    }
    return std::sqrt(sum / stage.area);
}

}  // namespace exitance
