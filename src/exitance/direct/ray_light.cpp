#include "exitance/direct/ray_light.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "exitance/base/polygon.hpp"
#include "exitance/base/random.hpp"
#include "exitance/visibility/glazed_part.hpp"
#include "exitance/visibility/window_view.hpp"

namespace exitance {
namespace {

/// Share of the unoccluded light above which a source is sampled by rays of its own.
constexpr double strong_share = 1.0 / 8;

/// Standard deviation of one ray to a half-hidden source, relative to its unoccluded light. Also the uncertainty of
/// features smaller than the light of one ray, as a share of that light.
constexpr double half_hidden = 0.5;

constexpr std::uint32_t least_pilot = 16, most_pilot = 64, least_rays_of_part = 4;
constexpr std::uint32_t fastest_growth = 16;  ///< Limit per round, since a variance from few rays is uncertain.

/// Light through openings, as a share of the allowed error, that is left to the sky's own rays. Derived from its part
/// of the variance, a sixteenth.
constexpr double little = 0.25;

/// Nearly hidden light needs no better accuracy than light of this share of the unoccluded light.
constexpr double min_share = 0.05;

std::size_t facet_count(const DistantLight::Dome& dome) {
    DistantLight alone;
    alone.domes.push_back(dome);
    return distant_facets(alone).size();
}

/// The domes of the scene whose facets are among the emitters.
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

bool is_grey(const Spectrum& s) {
    return std::all_of(s.value.begin(), s.value.end(), [&](double v) { return v == s[0]; });
}

/// A source that is drawn from the tree of emitters.
struct DrawnSource {
    const EmitterTree::Source* source = nullptr;
    double chance = 0;  ///< Probability of drawing it; 0 if it was drawn by rounding alone.
};

/// Draws one of the terms of a cut, and then a source below it in proportion to its power, by a number u in [0, 1).
/// chance_before  prefix sums of the chances of the terms
DrawnSource draw_source(const EmitterTree& tree, const EmitterTree::Cut& cut, const std::vector<double>& chance_before,
                        double u) {
    const double wanted = u * chance_before.back();
    const auto after = std::upper_bound(chance_before.begin() + 1, chance_before.end() - 1, wanted);
    const auto term = static_cast<std::size_t>(after - chance_before.begin()) - 1;
    const double of_term = chance_before[term + 1] - chance_before[term];
    if (!(of_term / chance_before.back() > 0)) return {};
    const EmitterTree::Node& node = tree.nodes()[cut.terms[term].node];
    const double within = std::clamp((wanted - chance_before[term]) / of_term, 0.0, 1.0);
    const auto first = tree.power_before().begin() + node.first, end = tree.power_before().begin() + node.last;
    const auto found = std::upper_bound(first + 1, end, *first + within * (*end - *first));
    const EmitterTree::Source& source =
        tree.sources()[static_cast<std::size_t>(found - tree.power_before().begin()) - 1];
    return {&source, of_term / chance_before.back() * source.power / node.power};
}

std::uint32_t power_of_two(double rays, std::uint32_t least, std::uint32_t most) {
    return std::bit_ceil(
        static_cast<std::uint32_t>(std::clamp(rays, static_cast<double>(least), static_cast<double>(most))));
}

}  // namespace

std::uint64_t RayLight::key_of(const Point& x, RegionId own) {
    const auto bits = [](double c) { return std::bit_cast<std::uint64_t>(c); };
    return hash(static_cast<std::uint64_t>(Stream::direct), bits(x.x), bits(x.y), bits(x.z), own.value);
}

Spectrum RayLight::Estimate::standard_error() const {
    const double level = mean(irradiance), error = std::sqrt(variance);
    return level > 0 ? error / level * irradiance : Spectrum(error);
}

double RayLight::rays_for(double relative_error) {
    return std::pow(half_hidden / relative_error, 4.0 / 3);
}

double RayLight::error_of(double rays) {
    return half_hidden * std::pow(rays, -0.75);
}

RayLight::RayLight(const DirectLight& direct, const RayTracer& tracer)
    : direct_(&direct),
      tracer_(&tracer),
      tree_(direct),
      sky_(kept_domes(direct)),
      size_(direct.occluders().scene().size()) {
    for (std::uint32_t e = 0; e < direct.emitters().size(); ++e) {
        const DirectLight::Emitter& emitter = direct.emitters()[e];
        if (!direct.looks_far(e) || emitter.sky != DirectLight::Emitter::Sky::none) continue;
        const PieceId piece = *emitter.pieces.begin();
        const std::span<const Point> corners = direct.occluders().corners(piece);
        discs_.push_back(
            {{e, piece},
             SeenPolygon(corners, emitter.plane.n, norm(area_vector(corners)), direct.occluders().middle())});
    }
    for (const Pane& pane : direct.occluders().scene().panes()) is_coloured_ |= !is_grey(pane.transmissivity);
}

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
            return 2;
        case Kind::piece:
            break;
    }
    return source.piece.value + 2ull;
}

const SkyOpenings& RayLight::openings() const {
    std::call_once(searched_, [this] {
        std::vector<SkyOpenings::Sun> suns;
        for (const Disc& disc : discs_) suns.push_back({&disc.seen, direct_->occluders().middle()});
        openings_ = std::make_unique<const SkyOpenings>(direct_->occluders(), *tracer_, sky_, suns);
    });
    return *openings_;
}

/// Returns the variance of a part. If no ray to the sky or to a sun has arrived, the variance is estimated from the
/// light that equally many rays miss at the places of SkyOpenings.
double RayLight::variance(const Part& part) const {
    const bool is_sky = part.kind == Part::Kind::sky, is_sun = part.kind == Part::Kind::piece && part.is_sun;
    const bool finds_nothing = std::all_of(part.blocks.begin(), part.blocks.end(),
                                           [](const Part::Block& block) { return !(max(block.arrived) > 0); });
    double missed = half_hidden * mean(part.open) / part.rays;
    if (finds_nothing && is_sun) missed = half_hidden * mean(part.open) * openings().hidden_sun(part.rays);
    if (finds_nothing && is_sky)
        missed = std::min(missed, part.unaimed + half_hidden * mean(part.open) * openings().hidden_sky(part.rays));
    return part.variance(missed);
}

/// Unoccluded light of a piece of an emitter.
Spectrum RayLight::open_light(const Receiver& at, const DirectLight::SourceName& source, Workspace& room) const {
    const DirectLight::Emitter& emitter = direct_->emitters()[source.emitter];
    if (!direct_->shines_on(emitter, at.own)) return {};
    return visible_form_factor(direct_->occluders(), at, source.piece, {}, room.exact, emitter.radiance) *
           emitter.exitance;
}

void RayLight::add_discs(const Receiver& at, Workspace& room) const {
    if (discs_.empty()) return;
    if (room.disc_light_.empty() || !(room.disc_normal_ == at.n)) {
        room.disc_normal_ = at.n, room.disc_light_.clear();
        for (const Disc& disc : discs_) room.disc_light_.push_back(open_light(at, disc.name, room));
    }
    for (std::size_t i = 0; i < discs_.size(); ++i)
        if (max(room.disc_light_[i]) > 0)
            room.parts_.push_back({.kind = Part::Kind::piece,
                                   .source = discs_[i].name,
                                   .open = room.disc_light_[i],
                                   .seen = &discs_[i].seen,
                                   .is_sun = true,
                                   .from = direct_->occluders().middle()});
}

void RayLight::add_piece(const Receiver& at, const DirectLight::SourceName& source, Workspace& room) const {
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
void RayLight::add_openings(const Receiver& at, const LightAccuracy& accuracy, Workspace& room) const {
    const double left_out = openings().choose(at.x, at.n, room.cells_);
    Spectrum light;
    double chosen = 0;
    for (const PortalCell& cell : room.cells_) {
        const Vec3 w = normalized(cell.corner + 0.5 * (cell.u + cell.v) - at.x);
        const double share = PortalAim::form_factor(cell, at.x, at.n);
        light += share * direct_->scene().distant().radiosity(w, false), chosen += share;
    }
    const double of_all = chosen > 0 ? (chosen + left_out) / chosen * mean(light) : 0;
    if (of_all <= little * accuracy.allowed(min_share * mean(room.aim_.open)))
        room.cells_.clear();
    else
        room.parts_.back().unaimed = of_all - mean(light);
    room.portals_.set(room.cells_, at.x, at.n);
    if (!room.cells_.empty()) room.parts_.push_back({.kind = Part::Kind::openings, .open = light});
}

/// Finds the parts of the light at a receiver and the numbers of their first rays. Returns the unoccluded light, mean
/// over bands.
double RayLight::find_parts(const Receiver& at, const LightAccuracy& accuracy, Workspace& room) const {
    room.parts_.clear(), room.seen_.clear();
    if (!sky_.empty() && !direct_->occluders().enclosure().holds(at.own)) {
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
    const double pilot =
        std::clamp(0.5 * rays_for(std::max(accuracy.allowed(open) / open, 1e-9)), 1.0 * least_pilot, 1.0 * most_pilot);
    for (Part& part : room.parts_)
        part.block = power_of_two(pilot * mean(part.open) / open, least_rays_of_part, most_pilot) / 4;
    return open;
}

/// Makes the rays of one part and adds them to the batch. `i`: number of a ray; s, t, u in [0, 1) choose it.
class RayLight::RayMaker {
  public:
    RayMaker(const RayLight& light, const Receiver& at, Part& part, Workspace& room)
        : light_(light),
          occluders_(light.direct_->occluders()),
          at_(at),
          part_(part),
          room_(room),
          reach_(2 * (light.size_ + norm(at.x - occluders_.middle()))) {}

    void make(std::uint32_t i, double s, double t, double u) {
        switch (part_.kind) {
            case Part::Kind::sky:
                return to_sky(i, s, t);
            case Part::Kind::openings:
                return through_openings(i, s, t);
            case Part::Kind::piece: {
                const Point y = part_.seen->at(s, t);
                return towards(i, part_.source, y, part_.from, part_.seen->weight(y - part_.from, at_.n));
            }
            case Part::Kind::others:
                return to_others(i, s, t, u);
        }
    }

  private:
    void add(std::uint32_t i, const Point& to, RegionId region, const Spectrum& weight, bool is_distant,
             PieceId window) {
        part_.blocks[i / part_.block].all += weight;
        const auto number = static_cast<std::uint32_t>(&part_ - room_.parts_.data());
        room_.rays_.push_back({number, i / part_.block, is_distant, window, weight});
        room_.from_.push_back({at_.x, at_.own}), room_.to_.push_back({to, region});
    }

    void to_sky(std::uint32_t i, double s, double t) {
        const SkyTree::Direction to = light_.sky_.direction(room_.aim_, s, t);
        const double cosine = dot(at_.n, to.w);
        if (cosine <= 0) return;
        const Spectrum weight = cosine / (pi * to.density) * occluders_.scene().distant().radiosity(to.w, false);
        if (room_.portals_.is_aimed_at(to.w))
            part_.blocks[i / part_.block].all += weight;  // the ray's light belongs to the part `openings`
        else
            add(i, at_.x + reach_ * to.w, RegionId(), weight, true, PieceId());
    }

    void through_openings(std::uint32_t i, double s, double t) {
        const PortalAim::Ray ray = room_.portals_.aimed(s, t);
        if (!(ray.weight > 0)) return;
        const Spectrum light = occluders_.scene().distant().radiosity(ray.direction, false);
        add(i, at_.x + reach_ * ray.direction, RegionId(), ray.weight * light, true, PieceId());
    }

    /// Adds a ray to a point y of an emitter. `weight`: cosines / (pi r^2 density), or that times any constant if only
    /// the ratio of weights matters.
    void towards(std::uint32_t i, const DirectLight::SourceName& source, const Point& y, const Point& from,
                 double weight) {
        const DirectLight& direct = *light_.direct_;
        const DirectLight::Emitter& emitter = direct.emitters()[source.emitter];
        const Vec3 d = y - from;
        weight *= emitter.radiance.towards(from, y);
        if (!(weight > 0)) return;
        const bool is_window = emitter.sky == DirectLight::Emitter::Sky::window;
        constexpr double before = 1e-5;  // share of the scene's size: rays end in front of a window's pane
        const double length = norm(d);
        const double way = direct.looks_far(source.emitter) ? std::min(1.0, reach_ / length)
                           : is_window                      ? std::max(0.5, 1 - before * light_.size_ / length)
                                                            : 1;
        add(i, at_.x + way * d, emitter.region, weight * emitter.exitance, direct.is_distant(source.emitter),
            is_window && looks_out_on_faces(occluders_, source.piece) ? source.piece : PieceId());
    }

    void to_others(std::uint32_t i, double s, double t, double u) {
        const DrawnSource drawn = draw_source(light_.tree_, room_.cut_, room_.chance_before_, u);
        if (!(drawn.chance > 0)) return;
        const EmitterTree::Source& source = *drawn.source;
        const DirectLight::Emitter& emitter = light_.direct_->emitters()[source.name.emitter];
        if (!light_.direct_->shines_on(emitter, at_.own)) return;
        const Point y = uniform_on(occluders_.corners(source.name.piece), source.area, s, t);
        const Vec3 d = y - at_.x;
        const double above = dot(at_.n, d), below = -dot(emitter.plane.n, d), squared = squared_norm(d);
        if (above <= 0 || below <= 0) return;
        const double density = drawn.chance / source.area;
        towards(i, source.name, y, at_.x, above * below / (pi * squared * squared * density));
    }

    const RayLight& light_;
    const Occluders& occluders_;
    const Receiver& at_;
    Part& part_;
    Workspace& room_;
    double reach_;  ///< Length of rays to the sky, beyond all surfaces, metres.
};

/// Adds the rays of a part up to number `last` to the batch.
void RayLight::add_rays(const Receiver& at, Part& part, std::uint32_t last, std::uint64_t key, Workspace& room) const {
    const std::size_t count = last - part.rays;
    const ScrambledSobol places(hash(key, part.sequence()));
    room.s_.resize(count), room.t_.resize(count), room.u_.resize(count);
    places.fill(part.rays, 0, room.s_), places.fill(part.rays, 1, room.t_);
    if (part.kind == Part::Kind::others) places.fill(part.rays, 2, room.u_);
    part.blocks.resize(last / part.block);
    RayMaker maker(*this, at, part, room);
    for (std::uint32_t k = 0; k < count; ++k) maker.make(part.rays + k, room.s_[k], room.t_[k], room.u_[k]);
    part.rays = last;
}

/// Rays through a window to the sky are continued behind its pane, whose transmission is part of the radiance.
void RayLight::continue_through_windows(const Receiver& at, Workspace& room) const {
    room.onwards_.clear(), room.onwards_from_.clear(), room.onwards_to_.clear();
    for (std::size_t i = 0; i < room.rays_.size(); ++i) {
        if (room.blocked_[i] || room.rays_[i].window.is_none()) continue;
        constexpr double step = 3e-5, beyond_all = 2;  // both as shares of the scene's size
        const Point& end = room.to_[i].at;
        const Vec3 w = normalized(end - at.x);
        room.onwards_.push_back(i);
        room.onwards_from_.push_back({end + (step * size_) * w, RegionId()});
        room.onwards_to_.push_back({end + (beyond_all * size_) * w, RegionId()});
    }
    const auto hidden = std::make_unique<bool[]>(room.onwards_.size());
    tracer_->occluded(room.onwards_from_, room.onwards_to_, std::span(hidden.get(), room.onwards_.size()));
    for (std::size_t k = 0; k < room.onwards_.size(); ++k) room.blocked_[room.onwards_[k]] = hidden[k];
}

/// Traces the batch and adds the arriving light to the blocks.
void RayLight::trace(const Receiver& at, Workspace& room) const {
    if (room.blocked_size_ < room.rays_.size()) {
        room.blocked_size_ = std::bit_ceil(room.rays_.size());
        room.blocked_ = std::make_unique<bool[]>(room.blocked_size_);
    }
    tracer_->occluded(room.from_, room.to_, std::span(room.blocked_.get(), room.rays_.size()));
    const auto ends_at_window = [](const Workspace::Ray& ray) { return !ray.window.is_none(); };
    if (std::any_of(room.rays_.begin(), room.rays_.end(), ends_at_window)) continue_through_windows(at, room);
    for (std::size_t i = 0; i < room.rays_.size(); ++i) {
        if (room.blocked_[i]) continue;
        Workspace::Ray& ray = room.rays_[i];
        if (is_coloured_) {  // rays pass by the mean of the bands
            const Spectrum T = transmission_between(direct_->occluders().scene().panes(), at.x, room.to_[i].at);
            ray.weight *= T / mean(T);
        }
        Part& part = room.parts_[ray.part];
        part.blocks[ray.block].arrived += ray.weight;
        if (ray.is_distant) part.distant += ray.weight;
    }
    room.rays_.clear(), room.from_.clear(), room.to_.clear();
}

RayLight::Estimate RayLight::on_side(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                                     Workspace& room) const {
    const Receiver at = direct_->receiver(x, n, own);
    const std::uint64_t key = key_of(x, own);
    Estimate out;
    const double open = find_parts(at, accuracy, room);
    for (Part& part : room.parts_) add_rays(at, part, 4 * part.block, key, room);
    for (bool grows = true; grows;) {
        trace(at, room);
        out = Estimate();
        double rates = 0;  // sum of c^(2/5), c the variance of one ray
        for (const Part& part : room.parts_) {
            const double variance = this->variance(part);
            out.irradiance += part.light(), out.variance += variance, out.rays += part.rays;
            rates += std::pow(variance * std::pow(part.rays, 1.5), 0.4);
        }
        // Less than the light found by a standard deviation: light that is overestimated must not end the search.
        const double least = std::max(mean(out.irradiance) - std::sqrt(out.variance), min_share * open);
        const double allowed = accuracy.allowed(least);
        const double limit = allowed * allowed;
        if (out.variance <= limit || out.rays >= accuracy.most_rays) break;
        // The variance sum of c_i n_i^(-3/2) is reached with fewest rays by n_i in proportion to c_i^(2/5).
        grows = false;
        const double scale = std::pow(rates / limit, 2.0 / 3);
        for (Part& part : room.parts_) {
            const double wanted = scale * std::pow(variance(part) * std::pow(part.rays, 1.5), 0.4);
            const std::uint32_t rays =
                power_of_two(wanted, 1, std::min(fastest_growth * part.rays, accuracy.most_rays));
            if (rays <= part.rays) continue;
            add_rays(at, part, rays, key, room);
            grows = true;
        }
    }
    for (const Part& part : room.parts_)
        out.parallel += part.kind == Part::Kind::others ? part.distant / static_cast<double>(part.rays)
                        : part.kind != Part::Kind::piece || direct_->is_distant(part.source.emitter) ? part.light()
                                                                                                     : Spectrum();
    if (!direct_->beams().empty()) out.irradiance += direct_->beams().irradiance(at, &out.parallel);
    return out;
}

/// Returns the unoccluded light of all parts but those of sky and sun that probably pass by the openings, W/m^2.
double RayLight::light_through_openings(const Workspace& room) const {
    double sum = 0;
    for (const Part& part : room.parts_) {
        double share = 1;
        if (part.kind == Part::Kind::sky)
            share = openings().hidden_sky(least_pilot);
        else if (part.is_sun && !room.portals_.is_aimed_at(part.seen->at(0.5, 0.5) - part.from))
            share = openings().hidden_sun(least_pilot);
        sum += share * mean(part.open);
    }
    return sum;
}

double RayLight::forecast(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                          Workspace& room) const {
    constexpr double work_of_place = 20;  // work of choosing the parts, in rays (measured)
    double open = find_parts(direct_->receiver(x, n, own), accuracy, room);
    if (std::any_of(room.parts_.begin(), room.parts_.end(),
                    [](const Part& part) { return part.kind == Part::Kind::openings; }))
        open = light_through_openings(room);
    const double rays = open > 0 ? rays_for(std::max(accuracy.allowed(open) / open, 1e-9)) : 0;
    return work_of_place + std::clamp(rays, 1.0 * least_pilot, 1.0 * accuracy.most_rays);
}

RayLight::Estimate RayLight::at(const Point& x, const Normal& n, RegionId own, const LightAccuracy& accuracy,
                                Workspace& room) const {
    const RegionId behind = direct_->occluders().scene().behind(own);
    const Estimate front = on_side(x, n, own, accuracy, room);
    if (behind.is_none()) return front;
    const double through = direct_->occluders().scene().material(own).through, not_through = 1 - through;
    const Estimate back = on_side(x, -n, behind, accuracy, room);
    return {not_through * front.irradiance + through * back.irradiance,
            not_through * front.parallel + through * back.parallel,
            not_through * not_through * front.variance + through * through * back.variance, front.rays + back.rays};
}

}  // namespace exitance
