#include "exitance/discontinuity/weak_light.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/direct/source_point.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_exact_emitters = 8,
                      max_exact_regions = 1000;  // exact light is cheap up to these numbers of emitters and regions
constexpr std::size_t quad = 4;                  // number of corners; triangles repeat the last one

}  // namespace

bool WeakLight::pays(const DirectLight& direct) {
    return direct.emitters().size() > max_exact_emitters &&
           direct.occluders().scene().regions().size() > max_exact_regions && PossibleSources::suits(direct);
}

WeakLight::WeakLight(const DirectLight& direct, const RayTracer& tracer, const Asked& asked, const StopRequest& stop)
    : direct_(&direct), tracer_(&tracer), regions_(direct.occluders().scene().regions().size()) {
    for (std::uint32_t e = 0; e < direct.emitters().size(); ++e) {
        first_of_emitter_.push_back(static_cast<std::uint32_t>(sources_.size()));
        for (const PieceId piece : direct.emitters()[e].pieces) {
            const std::span<const Point> corners = direct.occluders().corners(piece);
            const double area = norm(area_vector(corners));
            const ScrambledSobol at(hash(static_cast<std::uint64_t>(Stream::direct), piece.value));
            Emitting& source = sources_.emplace_back();
            source.name = {e, piece};
            for (std::uint32_t i = 0; i < max_rays; ++i)
                source.places.push_back(uniform_on(corners, area, at(i, 0), at(i, 1)));
        }
    }
    const PossibleSources possible(direct, asked.negligible, stop);
    parallel_for(regions_.size(), 64, [&](std::size_t r) { choose(RegionId(r), possible.of(RegionId(r)), asked); });
}

void WeakLight::choose(RegionId r, std::span<const PossibleSources::Source> from, const Asked& asked) {
    const Scene& scene = direct_->occluders().scene();
    const double w = mean(light_weight(scene.material(r)));
    const double larger = std::sqrt(std::max(1.0, asked.area / scene.regions()[r].area));
    const double noise = std::min(asked.noise * larger, std::max(asked.noise, asked.max_noise)) / w;
    double sum = 0;
    std::size_t weak = 0;
    const bool is_exact = asked.exact && asked.exact->size() > 0 && (*asked.exact)[r];
    const double max_bound_sum = is_exact ? -1 : 2 * noise * std::sqrt(static_cast<double>(max_rays));
    while (weak < from.size() && sum + from[weak].bound <= max_bound_sum) sum += from[weak++].bound;
    const double rays = noise > 0 ? sum * sum / (4 * noise * noise) : 0;
    OfRegion& out = regions_[r];
    for (std::size_t i = 0; i < from.size(); ++i) {
        const auto& [name, bound] = from[i];
        if (i >= weak) {
            out.strong.push_back(name), out.bounds.push_back(bound);
            continue;
        }
        const double share = rays * bound / sum;
        const PieceId first = *direct_->emitters()[name.emitter].pieces.begin();
        const std::uint32_t number = first_of_emitter_[name.emitter] + (name.piece.value - first.value);
        RandomStream lot(static_cast<std::uint64_t>(name.piece.value), Stream::direct, r.value);
        if (share < 1 && lot.uniform() >= share) continue;
        // Powers of two keep the Sobol points evenly distributed.
        const auto count = static_cast<std::uint32_t>(std::bit_ceil(static_cast<unsigned>(std::ceil(share))));
        out.weak.push_back({number, std::min(count, max_rays), static_cast<float>(1 / std::min(1.0, share))});
    }
    // Sort by emitter, the order that all other lists of sources have.
    std::vector<std::size_t> order(out.strong.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return out.strong[a].piece < out.strong[b].piece; });
    const OfRegion unsorted = out;
    for (std::size_t i = 0; i < order.size(); ++i)
        out.strong[i] = unsorted.strong[order[i]], out.bounds[i] = unsorted.bounds[order[i]];
}

double WeakLight::bound(RegionId r, std::uint32_t emitter) const {
    double sum = 0;
    for (std::size_t i = 0; i < regions_[r].strong.size(); ++i)
        if (regions_[r].strong[i].emitter == emitter) sum += regions_[r].bounds[i];
    return std::min(sum, mean(direct_->emitters()[emitter].exitance));
}

Spectrum WeakLight::irradiance(const Point& x, const Normal& n, RegionId r, Workspace& room) const {
    const std::vector<Weak>& weak = regions_[r].weak;
    Spectrum out;
    if (weak.empty()) return out;
    if (room.region_ != r || room.owner_ != this) {
        room.region_ = r, room.owner_ = this;
        room.quads_.clear();
        for (const Weak& w : weak) {
            const std::span<const Point> c = direct_->occluders().corners(sources_[w.source].name.piece);
            room.quads_.add({c[0], c[1], c[2], c[std::min(c.size(), quad) - 1]});
        }
        room.factors_.resize(weak.size());
    }
    const SurfacePoint at = direct_->receiver(x, n, r);
    point_to_quads(at.x, n, room.quads_, room.factors_);
    room.from_.clear(), room.to_.clear(), room.kernels_.clear();
    for (std::size_t k = 0; k < weak.size(); ++k) {
        const Emitting& source = sources_[weak[k].source];
        const DirectLight::Emitter& emitter = direct_->emitters()[source.name.emitter];
        const std::span<const Point> corners = direct_->occluders().corners(source.name.piece);
        double& F = room.factors_[k];
        if (corners.size() > quad) F = point_to_polygon(at.x, n, corners);
        if (F <= 0) continue;
        for (std::uint32_t i = 0; i < weak[k].rays; ++i) {
            const Vec3 d = source.places[i] - at.x;
            const double above = dot(n, d), below = -dot(emitter.plane.n, d), squared = squared_norm(d);
            const bool counts = above > 0 && below > 0;
            room.kernels_.push_back(counts ? above * below / (squared * squared) : 0);
            if (!counts) continue;
            room.from_.push_back({at.x, r}), room.to_.push_back({source.places[i], emitter.region});
        }
    }
    const std::size_t count = room.from_.size();
    if (room.room_for_ < count) room.blocked_ = std::make_unique<bool[]>(room.room_for_ = 2 * count);
    const std::span<bool> blocked(room.blocked_.get(), count);
    tracer_->occluded(room.from_, room.to_, blocked);
    std::size_t next = 0, ray = 0;
    for (std::size_t k = 0; k < weak.size(); ++k) {
        if (room.factors_[k] <= 0) continue;
        double all = 0, arrived = 0;
        for (std::uint32_t i = 0; i < weak[k].rays; ++i) {
            const double kernel = room.kernels_[next++];
            if (kernel <= 0) continue;
            all += kernel;
            if (!blocked[ray++]) arrived += kernel;
        }
        if (arrived > 0)
            out += (static_cast<double>(weak[k].weight) * room.factors_[k] * arrived / all) *
                   direct_->emitters()[sources_[weak[k].source].name.emitter].exitance;
    }
    return out;
}

Spectrum WeakLight::irradiance(const ReceiverLight& strong, const Point& x, Workspace& room) const {
    constexpr std::uint32_t max_listed_candidates = 24;  // testing this many costs as much as a search of the tree
    const SurfacePoint at = direct_->receiver(x, strong.n, strong.own);
    Spectrum out = irradiance(x, strong.n, strong.own, room);
    room.exact.factors.resize(strong.open.size());
    point_to_quads(at.x, strong.n, strong.open, room.exact.factors);
    for (std::size_t i = 0; i < room.exact.factors.size(); ++i) out += room.exact.factors[i] * strong.open_light[i];
    for (const ReceiverLight::Source& source : strong.sources) {
        if (source.in_batch) continue;
        const auto candidates = std::span(strong.candidates).subspan(source.first, source.count);
        const double F = source.count > max_listed_candidates
                             ? visible_form_factor(direct_->occluders(), at, source.piece, room.exact)
                             : visible_form_factor(direct_->occluders(), at, source.piece, candidates, room.exact);
        out += F * direct_->emitters()[source.emitter].exitance;
    }
    return out;
}

}  // namespace exitance
