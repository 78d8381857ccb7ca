// The rays of the parts of the light at a place or an element, traced in batches.
#include <algorithm>
#include <bit>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/direct/ray_light.hpp"
#include "exitance/visibility/window_view.hpp"

namespace exitance {
namespace {

/// A source that is drawn from the tree of emitters.
struct DrawnSource {
    const EmitterTree::Source* source = nullptr;
    double chance = 0;  ///< Probability of drawing it; 0 if it was drawn by rounding alone.
    std::uint32_t term = 0;
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
    return {&source, of_term / chance_before.back() * source.power / node.power, static_cast<std::uint32_t>(term)};
}

}  // namespace

/// Makes the rays of one part and adds them to the batch. `i`: number of a ray; s, t, u in [0, 1) choose it.
class RayLight::RayMaker {
  public:
    RayMaker(const RayLight& light, const Start& start, Part& part, Workspace& room)
        : light_(light),
          occluders_(light.direct_->occluders()),
          at_(start.at),
          part_(part),
          room_(room),
          reach_(2 * (light.size_ + norm(at_.x - occluders_.middle()))) {}

    /// Moves the start of the rays.
    void start_at(const Point& x) { at_.x = x; }

    void make(std::uint32_t i, double s, double t, double u) {
        switch (part_.kind) {
            case Part::Kind::sky:
                return to_sky(i, s, t);
            case Part::Kind::openings:
                return through_openings(i, s, t);
            case Part::Kind::piece: {
                const Point y = part_.seen->at(s, t);
                const double weight = part_.seen->weight(y - part_.from, at_.n);
                return towards(i / part_.block, part_.source, y, part_.from, weight);
            }
            case Part::Kind::others:
                return to_others(i, s, t, u);
        }
    }

  private:
    void add(std::uint32_t block, const Point& to, RegionId region, const Spectrum& weight, bool is_distant,
             PieceId window) {
        part_.blocks[block].all += weight;
        const auto number = static_cast<std::uint32_t>(&part_ - room_.parts_.data());
        room_.rays_.push_back({number, block, is_distant, window, weight});
        room_.from_.push_back({at_.x, at_.region}), room_.to_.push_back({to, region});
    }

    void to_sky(std::uint32_t i, double s, double t) {
        const SkyTree::Direction to = light_.sky_.direction(room_.aim_, s, t);
        const double cosine = dot(at_.n, to.w);
        if (cosine <= 0) return;
        const Spectrum weight = cosine / (pi * to.density) * occluders_.scene().distant().radiosity(to.w, false);
        if (room_.portals_.is_aimed_at(to.w))
            part_.blocks[i / part_.block].all += weight;  // the ray's light belongs to the part `openings`
        else
            add(i / part_.block, at_.x + reach_ * to.w, RegionId(), weight, true, PieceId());
    }

    void through_openings(std::uint32_t i, double s, double t) {
        const PortalAim::Ray ray = room_.portals_.aimed(s, t);
        if (!(ray.weight > 0)) return;
        const Spectrum light = occluders_.scene().distant().radiosity(ray.direction, false);
        add(i / part_.block, at_.x + reach_ * ray.direction, RegionId(), ray.weight * light, true, PieceId());
    }

    /// Adds a ray to a point y of an emitter. `weight`: cosines / (pi r^2 density), or that times any constant if only
    /// the ratio of weights matters.
    void towards(std::uint32_t block, const DirectLight::SourceName& source, const Point& y, const Point& from,
                 double weight) {
        const DirectLight& direct = *light_.direct_;
        const DirectLight::Emitter& emitter = direct.emitters()[source.emitter];
        const Vec3 d = y - from;
        weight *= emitter.radiance.towards(from, y);
        if (!(weight > 0)) return;
        const bool is_window = emitter.sky == DirectLight::Emitter::Sky::window;
        // Rays end in front of a window's pane. Share of the scene's size, derived from single precision, in which rays
        // are traced: 170 roundings of a coordinate.
        constexpr double before = 1e-5;
        const double length = norm(d);
        const double way = direct.looks_far(source.emitter) ? std::min(1.0, reach_ / length)
                           : is_window                      ? std::max(0.5, 1 - before * light_.size_ / length)
                                                            : 1;
        add(block, at_.x + way * d, emitter.region, weight * emitter.exitance, direct.is_distant(source.emitter),
            is_window && looks_out_on_faces(occluders_, source.piece) ? source.piece : PieceId());
    }

    void to_others(std::uint32_t i, double s, double t, double u) {
        const DrawnSource drawn = draw_source(light_.tree_, room_.cut_, room_.chance_before_, u);
        if (!(drawn.chance > 0)) return;
        const EmitterTree::Source& source = *drawn.source;
        const DirectLight::Emitter& emitter = light_.direct_->emitters()[source.name.emitter];
        if (!light_.direct_->shines_on(emitter, at_.region)) return;
        const Point y = uniform_on(occluders_.corners(source.name.piece), source.area, s, t);
        const Vec3 d = y - at_.x;
        const double above = dot(at_.n, d), below = -dot(emitter.plane.n, d), squared = squared_norm(d);
        if (above <= 0 || below <= 0) return;
        const double density = drawn.chance / source.area;
        towards(part_.by_term ? drawn.term : i / part_.block, source.name, y, at_.x,
                above * below / (pi * squared * squared * density));
    }

    const RayLight& light_;
    const Occluders& occluders_;
    SurfacePoint at_;
    Part& part_;
    Workspace& room_;
    double reach_;  ///< Length of rays to the sky, beyond all surfaces, metres.
};

/// Adds the rays of a part up to number `last` to the batch.
void RayLight::add_rays(const Start& start, Part& part, std::uint32_t last, Workspace& room) const {
    const std::size_t count = last - part.rays;
    const std::uint64_t key = hash(start.key, part.sequence());
    const ScrambledSobol places(key);
    room.s_.resize(count), room.t_.resize(count), room.u_.resize(count);
    places.fill(part.rays, 0, room.s_), places.fill(part.rays, 1, room.t_);
    if (part.kind == Part::Kind::others) places.fill(part.rays, 2, room.u_);
    if (start.tree) {
        const ScrambledSobol starts(hash(key));
        room.start_s_.resize(count), room.start_t_.resize(count);
        starts.fill(part.rays, 0, room.start_s_), starts.fill(part.rays, 1, room.start_t_);
    }
    part.blocks.resize(part.by_term ? room.cut_.terms.size() : last / part.block);
    RayMaker maker(*this, start, part, room);
    for (std::uint32_t k = 0; k < count; ++k) {
        if (start.tree) {
            const Vec2 uv = start.tree->uniform(start.element, room.start_s_[k], room.start_t_[k]);
            const Point x = start.tree->patch(start.element).at(uv);
            maker.start_at(direct_->receiver(x, start.at.n, start.at.region).x);
        }
        maker.make(part.rays + k, room.s_[k], room.t_[k], room.u_[k]);
    }
    part.rays = last;
}

/// Rays through a window to the sky are continued behind its pane, whose transmission is part of the radiance.
void RayLight::continue_through_windows(Workspace& room) const {
    room.onwards_.clear(), room.onwards_from_.clear(), room.onwards_to_.clear();
    for (std::size_t i = 0; i < room.rays_.size(); ++i) {
        if (room.blocked_[i] || room.rays_[i].window.is_none()) continue;
        // Shares of the scene's size. The step is derived from single precision, in which rays are traced: it is wider
        // than the distance from the pane at which the first part of the ray ended.
        constexpr double step = 3e-5, beyond_all = 2;
        const Point& end = room.to_[i].x;
        const Vec3 w = normalized(end - room.from_[i].x);
        room.onwards_.push_back(i);
        room.onwards_from_.push_back({end + (step * size_) * w, RegionId()});
        room.onwards_to_.push_back({end + (beyond_all * size_) * w, RegionId()});
    }
    const auto hidden = std::make_unique<bool[]>(room.onwards_.size());
    tracer_->occluded(room.onwards_from_, room.onwards_to_, std::span(hidden.get(), room.onwards_.size()));
    for (std::size_t k = 0; k < room.onwards_.size(); ++k) {
        Workspace::Ray& ray = room.rays_[room.onwards_[k]];
        room.blocked_[room.onwards_[k]] = hidden[k];
        if (!glass_.empty() && !hidden[k]) ray.weight *= glass_.between(room.onwards_from_[k].x, room.onwards_to_[k].x);
    }
}

/// Traces the batch and adds the arriving light to the blocks.
void RayLight::trace(Workspace& room) const {
    if (room.blocked_size_ < room.rays_.size()) {
        room.blocked_size_ = std::bit_ceil(room.rays_.size());
        room.blocked_ = std::make_unique<bool[]>(room.blocked_size_);
    }
    tracer_->occluded(room.from_, room.to_, std::span(room.blocked_.get(), room.rays_.size()));
    const auto ends_at_window = [](const Workspace::Ray& ray) { return !ray.window.is_none(); };
    if (std::any_of(room.rays_.begin(), room.rays_.end(), ends_at_window)) continue_through_windows(room);
    for (std::size_t i = 0; i < room.rays_.size(); ++i) {
        if (room.blocked_[i]) continue;
        Workspace::Ray& ray = room.rays_[i];
        if (!glass_.empty()) ray.weight *= glass_.between(room.from_[i].x, room.to_[i].x);
        Part& part = room.parts_[ray.part];
        part.blocks[ray.block].arrived += ray.weight;
        if (ray.is_distant) part.distant += ray.weight;
    }
    room.rays_.clear(), room.from_.clear(), room.to_.clear();
}

}  // namespace exitance
