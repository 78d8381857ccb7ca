#include "exitance/what_if/daylight/visible_patches.hpp"

#include <algorithm>

#include "exitance/base/clip_convex.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {

VisiblePatches::VisiblePatches(const Occluders& occluders, const SkyPatches& patches) : occluders_(occluders) {
    for (std::size_t i = 0; i < patches.facets().size(); ++i) {
        const std::vector<Vec3>& corners = patches.facets()[i].corners;
        Cone cone{{}, patches.patch_of_facet()[i], patches.patch_of_facet()[i] == 0};
        for (std::size_t k = 0; k < corners.size(); ++k)
            cone.inward.push_back(normalized(cross(corners[k + 1 == corners.size() ? 0 : k + 1], corners[k])));
        cones_.push_back(std::move(cone));
    }
}

/// Clips a convex polygon to a cone, in place; empty if they do not overlap.
void VisiblePatches::clip_to(const Cone& cone, std::vector<Vec3>& polygon, std::vector<Vec3>& rest) {
    for (const Vec3& n : cone.inward)
        if (std::all_of(polygon.begin(), polygon.end(), [&](const Vec3& r) { return dot(n, r) <= 0; }))
            return polygon.clear();
    for (const Vec3& n : cone.inward) {
        clip_convex<Vec3>(
            polygon, [&](const Vec3& r) { return dot(n, r); }, rest);
        polygon.swap(rest);
        if (polygon.size() < 3) return polygon.clear();
    }
}

/// Calls visit(piece, polygon, patch) for the visible part of every facet of a patch, relative to the receiver.
template <class Visit>
void VisiblePatches::for_each_part(const SurfacePoint& at, Workspace& workspace, const Visit& visit) const {
    auto& [visibility, fragments, part, rest] = workspace;
    for (const PieceId piece : occluders_.distant_pieces()) {
        visible_fragments(occluders_, at, piece, {}, visibility, fragments);
        for (const std::vector<Vec3>& fragment : fragments) {
            double lowest = 0;
            for (const Vec3& r : fragment) lowest = std::min(lowest, r.z / norm(r));
            constexpr double rounding = 1e-9;
            for (const Cone& cone : cones_) {
                if (cone.below != (lowest < -rounding)) continue;
                part = fragment;
                clip_to(cone, part, rest);
                if (!part.empty()) visit(piece, part, cone.patch);
            }
        }
    }
}

void VisiblePatches::irradiance(const SurfacePoint& at, Workspace& workspace, std::span<float> out) const {
    const Spectrum weights = luminous_weights();
    std::fill(out.begin(), out.end(), 0.0f);
    for_each_part(at, workspace, [&](PieceId piece, const std::vector<Vec3>& part, std::uint32_t patch) {
        const Spectrum F = transmitted_form_factor(occluders_, at, piece, part, {});
        for (std::size_t b = 0; b < bands; ++b) out[patch] += static_cast<float>(pi * weights[b] * F[b]);
    });
}

void VisiblePatches::irradiance_through(const PaneGroups& groups, const SurfacePoint& at, Workspace& workspace,
                                        std::span<float> out) const {
    const std::size_t rows = groups.count() + 1, columns = out.size() / rows;
    std::vector<Spectrum> F(rows);
    std::fill(out.begin(), out.end(), 0.0f);
    for_each_part(at, workspace, [&](PieceId piece, const std::vector<Vec3>& part, std::uint32_t patch) {
        std::fill(F.begin(), F.end(), Spectrum());
        add_form_factors_through(groups, occluders_, at, piece, part, F);
        for (std::size_t g = 0; g < rows; ++g) out[g * columns + patch] += static_cast<float>(pi * luminous_sum(F[g]));
    });
}

}  // namespace exitance
