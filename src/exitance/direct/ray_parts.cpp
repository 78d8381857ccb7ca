// The parts of the light at a place that rays estimate one by one, and their estimates.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "exitance/base/polygon.hpp"
#include "exitance/direct/ray_light.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t min_rays_of_part = 4;

/// Share of the unoccluded light above which a source is sampled by rays of its own. Chosen: half of it takes 2.4
/// times as many rays and twice it 1.5 times, measured by `exitance solve carpet.obj --error 0.1` (carpet u=12 v=13
/// cuts=1 books=0).
constexpr double strong_share = 1.0 / 8;

/// Light through openings, as a share of the allowed error, that is left to the sky's own rays. Derived from its part
/// of the variance, a sixteenth.
constexpr double little = 0.25;

}  // namespace

Spectrum RayLight::Part::light() const {
    Spectrum all, arrived;
    for (const Block& b : blocks) all += b.all, arrived += b.arrived;
    if (counts_weights()) return arrived / static_cast<double>(rays);
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) out[b] = all[b] > 0 ? open[b] * arrived[b] / all[b] : 0;
    return out;
}

/// Variance of the mean over bands, from the spread of eighths of the rays, each of which is stratified (of quarters,
/// if there are few rays), and from the light of features that no ray may have met, W/m^2.
double RayLight::Part::variance(double missed) const {
    std::array<double, 8> all{}, arrived{};
    const std::size_t count = std::min<std::size_t>(all.size(), blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const std::size_t q = count * i / blocks.size();
        all[q] += mean(blocks[i].all), arrived[q] += mean(blocks[i].arrived);
    }
    const double L = mean(open), n = rays, groups = static_cast<double>(count);
    const double whole = std::accumulate(all.begin(), all.end(), 0.0);
    const double part = std::accumulate(arrived.begin(), arrived.end(), 0.0);
    if (!(whole > 0)) return std::pow(half_hidden * L, 2) / (counts_weights() ? n * n : 1);
    double squares = 0;
    for (std::size_t q = 0; q < count; ++q)
        squares += std::pow(counts_weights() ? arrived[q] - part / groups : arrived[q] - part / whole * all[q], 2);
    const double scale = counts_weights() ? 1 / n : L / whole;
    return groups / (groups - 1) * squares * scale * scale + missed * missed;
}

std::uint64_t RayLight::Part::sequence() const {
    switch (kind) {
        case Kind::sky:
            return 0;
        case Kind::openings:
            return ~std::uint64_t{0};
        case Kind::others:
            return by_term ? 1 : 2;
        case Kind::piece:
            break;
    }
    return source.piece.value + 2ull;
}

const SkyOpenings& RayLight::openings() const {
    std::call_once(searched_, [this] {
        std::vector<SunDisc> suns;
        for (const DistantDisc& disc : discs_) suns.push_back({&disc.seen, direct_->occluders().middle()});
        openings_ = std::make_unique<const SkyOpenings>(direct_->occluders(), *tracer_, sky_, suns);
    });
    return *openings_;
}

/// Returns the variance of a part. If no ray to the sky or to a sun has arrived, the variance is estimated from the
/// light that equally many rays miss at the places of SkyOpenings in the same part of the scene.
double RayLight::variance(const Part& part) const {
    const bool is_sky = part.kind == Part::Kind::sky, is_sun = part.kind == Part::Kind::piece && part.is_sun;
    const bool finds_nothing = std::all_of(part.blocks.begin(), part.blocks.end(),
                                           [](const Part::Block& block) { return !(max(block.arrived) > 0); });
    double missed = half_hidden * mean(part.open) / part.rays;
    if (finds_nothing && is_sun)
        missed = half_hidden * mean(part.open) * openings().hidden_sun(part.scene_part, part.rays);
    if (finds_nothing && is_sky)
        missed = std::min(
            missed, part.unaimed + half_hidden * mean(part.open) * openings().hidden_sky(part.scene_part, part.rays));
    return part.variance(missed);
}

/// Unoccluded light of a piece of an emitter.
Spectrum RayLight::open_light(const SurfacePoint& at, const DirectLight::SourceName& source, Workspace& room) const {
    const DirectLight::Emitter& emitter = direct_->emitters()[source.emitter];
    if (!direct_->shines_on(emitter, at.region)) return {};
    return visible_form_factor(direct_->occluders(), at, source.piece, {}, room.exact, emitter.radiance) *
           emitter.exitance;
}

void RayLight::add_discs(const SurfacePoint& at, Workspace& room) const {
    if (discs_.empty()) return;
    if (room.disc_light_.empty() || !(room.disc_normal_ == at.n)) {
        room.disc_normal_ = at.n, room.disc_light_.clear();
        for (const DistantDisc& disc : discs_) room.disc_light_.push_back(open_light(at, disc.name, room));
    }
    for (std::size_t i = 0; i < discs_.size(); ++i)
        if (max(room.disc_light_[i]) > 0)
            room.parts_.push_back({.kind = Part::Kind::piece,
                                   .source = discs_[i].name,
                                   .open = room.disc_light_[i],
                                   .seen = &discs_[i].seen,
                                   .scene_part = sky_.empty() ? 0 : openings().part_at(at.x),
                                   .is_sun = true,
                                   .from = direct_->occluders().middle()});
}

void RayLight::add_piece(const SurfacePoint& at, const DirectLight::SourceName& source, Workspace& room) const {
    const Spectrum open = open_light(at, source, room);
    if (!(max(open) > 0)) return;
    const std::span<const Point> corners = direct_->occluders().corners(source.piece);
    const Normal& n = direct_->emitters()[source.emitter].plane.n;
    room.parts_.push_back({.kind = Part::Kind::piece,
                           .source = source,
                           .open = open,
                           .seen = &room.seen_.emplace_back(corners, n, norm(area_vector(corners)), at.x),
                           .from = at.x});
}

/// Adds the light of the sky through openings, after the sky itself, unless it is too little to matter.
void RayLight::add_openings(const SurfacePoint& at, const LightAccuracy& accuracy, Workspace& room) const {
    const double unaimed = openings().choose(at.x, at.n, room.cells_) * mean(room.aim_.open);
    Spectrum light;
    for (const PortalCell& cell : room.cells_) {
        const Vec3 w = normalized(cell.corner + 0.5 * (cell.u + cell.v) - at.x);
        light += PortalAim::form_factor(cell, at.x, at.n) * direct_->scene().distant().radiosity(w, false);
    }
    if (mean(light) + unaimed <= little * accuracy.allowed(min_share * mean(room.aim_.open)))
        room.cells_.clear();
    else
        room.parts_.back().unaimed = unaimed;
    room.parts_.back().scene_part = openings().part_at(at.x);
    room.portals_.set(room.cells_, at.x, at.n);
    if (!room.cells_.empty()) room.parts_.push_back({.kind = Part::Kind::openings, .open = light});
}

/// Finds the parts of the light at a receiver and the numbers of their first rays. Returns the unoccluded light, mean
/// over bands.
double RayLight::find_parts(const SurfacePoint& at, const LightAccuracy& accuracy, Workspace& room) const {
    room.parts_.clear(), room.seen_.clear();
    if (!sky_.empty() && !direct_->occluders().enclosure().holds(at.region)) {
        sky_.aim(at.n, room.aim_);
        if (room.aim_.weight[0] > 0) {
            room.parts_.push_back({.kind = Part::Kind::sky, .open = room.aim_.open});
            add_openings(at, accuracy, room);
        }
    }
    add_discs(at, room);
    tree_.cut(at, accuracy.relative / 2, accuracy.absolute / 2, room.cut_);
    double total = 0, chance = 0;
    for (const Part& part : room.parts_) total += mean(part.open);
    total += room.cut_.light;
    room.chance_before_.assign(1, 0);
    Spectrum others;
    for (const EmitterTree::Term& term : room.cut_.terms) {
        const EmitterTree::Node& node = tree_.nodes()[term.node];
        const bool is_strong = node.is_leaf() && term.light > strong_share * total;
        if (is_strong) add_piece(at, tree_.sources()[node.first].name, room);
        // A cluster is chosen in proportion to its light plus the bound of that light's error.
        const double own = is_strong ? 0 : term.light + term.error;
        chance += own;
        room.chance_before_.push_back(chance);
        others += own * node.colour;
    }
    if (chance > 0) room.parts_.push_back({.kind = Part::Kind::others, .open = others});
    double open = 0;
    for (const Part& part : room.parts_) open += mean(part.open);
    if (!(open > 0)) return 0;
    const double pilot = std::clamp(0.5 * rays_for(accuracy, open), 1.0 * min_pilot, 1.0 * max_pilot);
    for (Part& part : room.parts_)
        part.block = power_of_two(pilot * mean(part.open) / open, min_rays_of_part, max_pilot) / 4;
    return open;
}

}  // namespace exitance
