#include "exitance/direct/distant_sources.hpp"

#include "exitance/base/polygon.hpp"

namespace exitance {
namespace {

std::size_t facet_count(const DistantLight::Dome& dome) {
    DistantLight alone;
    alone.domes.push_back(dome);
    return distant_facets(alone).size();
}

}  // namespace

std::vector<DistantDisc> distant_discs(const DirectLight& direct) {
    std::vector<DistantDisc> out;
    for (std::uint32_t e = 0; e < direct.emitters().size(); ++e) {
        const DirectLight::Emitter& emitter = direct.emitters()[e];
        if (!direct.looks_far(e) || emitter.sky != DirectLight::Emitter::Sky::none) continue;
        const PieceId piece = *emitter.pieces.begin();
        const std::span<const Point> corners = direct.occluders().corners(piece);
        out.push_back({{e, piece},
                       SeenPolygon(corners, emitter.plane.n, norm(area_vector(corners)), direct.occluders().middle())});
    }
    return out;
}

DistantLight kept_domes(const DirectLight& direct) {
    DistantLight out;
    std::vector<std::uint32_t> dome_of;  // dome of each facet, in the order of distant_facets()
    const std::vector<DistantLight::Dome>& domes = direct.occluders().scene().distant().domes;
    for (std::uint32_t i = 0; i < domes.size(); ++i) dome_of.resize(dome_of.size() + facet_count(domes[i]), i);
    std::vector<std::uint8_t> is_kept(domes.size(), 0);
    for (const DirectLight::Emitter& emitter : direct.emitters()) {
        if (emitter.sky != DirectLight::Emitter::Sky::open) continue;
        const PieceId piece = *emitter.pieces.begin();
        is_kept[dome_of[piece.value - direct.occluders().distant_pieces().front().value]] = 1;
    }
    for (std::size_t i = 0; i < domes.size(); ++i)
        if (is_kept[i]) out.domes.push_back(domes[i]);
    return out;
}

}  // namespace exitance
