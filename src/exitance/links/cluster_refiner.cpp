#include "exitance/links/cluster_refiner.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

constexpr std::size_t block_size = 32;

/// Sums a term per piece over the pieces of each facing, bottom-up.
template <class Term>
Field<FacingId, double> sum_over_pieces(const Bodies& bodies, const Term& term) {
    const ClusterTree& clusters = bodies.clusters();
    Field<FacingId, double> out(clusters.facing_count(), 0.0);
    for (ElementId piece : bodies.elements().roots()) out[clusters.facing_of(piece)] += term(piece);
    for (std::size_t i = clusters.size(); i-- > 1;)
        for (FacingId f : clusters.facings(ClusterId(i))) out[clusters.facing(f).above] += out[f];
    return out;
}

}  // namespace

/// The result of judging a block of pairs.
struct ClusterRefiner::Block {
    std::vector<Found> links, cut;
    std::vector<LinkPair> pairs;
    std::size_t rays = 0;
};

/// Judges pairs. One object per thread.
class ClusterRefiner::Judge {
  public:
    /// Data shared by all threads.
    struct Light {
        Light(const Bodies& bodies, const NodalField& b, const LinkTolerance& tolerance)
            : powers(find_vector_powers(bodies, b)),
              response(
                  sum_over_pieces(bodies, [&](ElementId e) { return bodies.elements().area(e) * weight(bodies, e); })),
              importance(sum_over_pieces(
                  bodies, [&](ElementId e) { return bodies.elements().area(e) * tolerance.weight(e); })) {}

        /// Share of the light on an element that counts, mean over bands.
        static double weight(const Bodies& bodies, ElementId e) {
            return mean(light_weight(bodies.sites().stage().scene.material(bodies.elements().region(e))));
        }

        Field<FacingId, VectorPower> powers;
        Field<FacingId, double> response, importance;  ///< Sums over areas, m^2.
    };
    enum class Verdict : std::uint8_t { drop, accept, cut_receiver, cut_source, leave_to_elements };

    Judge(const Bodies& bodies, const NodalField& b, const Light& light, const LinkTolerance& tolerance)
        : bodies_(bodies), b_(b), light_(light), tolerance_(tolerance) {}

    Verdict judge(Found& pair) {
        const auto [R, S] = std::pair{pair.link.receiver, pair.link.source};
        if (!R.is_cluster() && !S.is_cluster()) return Verdict::leave_to_elements;
        const Vec3 d = bodies_.centre(R) - bodies_.centre(S);
        const double r = norm(d), reach = bodies_.radius(R) + bodies_.radius(S);
        if (reach > calibrated::cluster_reach * r) return larger_part(R, S);
        const Arrival light = arrival(R, S, (1 / r) * d, reach / r);
        if (light.most == 0) return Verdict::drop;
        const double allowed = tolerance_.error;
        const double extent = tolerance_.systematic * reach / r * light.most;
        if (extent > allowed) return larger_part(R, S);
        const bool tiny = light.most < calibrated::weak_link_share * allowed;
        constexpr unsigned min_rays = 4, max_rays = 16;
        const unsigned wanted = tiny ? min_rays : max_rays;
        if (wanted > pair.rays) cast(pair, wanted);
        // Half a ray is added to both open and blocked rays, so that few rays do not give certainty.
        const double open = (pair.open + 0.5) / (pair.rays + 1), hidden = light.most * std::sqrt(open * (1 - open));
        if (hidden > allowed) return larger_part(R, S);
        pair.squared_error = extent * extent + hidden * hidden;
        pair.light = light.power * static_cast<double>(pair.link.visible);
        return Verdict::accept;
    }

    std::size_t rays() const { return rays_; }

  private:
    /// Chooses the larger body that can be split. Clusters count as four times as large, because elements can be split
    /// later, when the accuracy of their light requires it.
    Verdict larger_part(Body R, Body S) const {
        constexpr double cluster_weight = 4;
        const auto size = [&](Body b) {
            return bodies_.is_leaf(b) ? 0 : bodies_.radius(b) * (b.is_cluster() ? cluster_weight : 1);
        };
        return size(R) >= size(S) ? Verdict::cut_receiver : Verdict::cut_source;
    }

    /// Unoccluded light: upper bound of the root of the integral of the squared radiosity that it causes, weighted with
    /// importance, W/m^2 m; and its power.
    struct Arrival {
        double most = 0, power = 0;
    };

    /// Returns upper bounds of the effect of the light of S on R. `w`: direction from S to R. `slack`: maximum
    /// difference of a cosine between any two of their points from that between their centres.
    Arrival arrival(Body R, Body S, const Vec3& w, double slack) const {
        double sent = 0;
        const auto send = [&](const Vec3& area, double spread, const VectorPower& v) {
            const double cosine = dot(normalized(area), w) + slack + spread;
            if (cosine <= 0) return;
            double strength = 0;
            for (const Vec3& band : v) strength += norm(band) / static_cast<double>(bands);
            sent += std::min(1.0, cosine) * strength;
        };
        if (S.is_cluster()) {
            for (FacingId f : bodies_.clusters().facings(S.cluster())) {
                const Facing& facing = bodies_.clusters().facing(f);
                send(facing.area, facing.spread, light_.powers[f]);
            }
        } else {
            send(bodies_.sites().normal(S.element()), 0, power_of(bodies_.sites(), S.element(), b_));
        }
        Arrival out;
        if (sent == 0) return out;
        const double E = sent / (pi * squared_norm(bodies_.centre(R) - bodies_.centre(S)));
        double sum = 0;
        const auto receive = [&](const Vec3& area, double spread, double surface, double response, double importance) {
            const double cosine = std::min(1.0, slack + spread - dot(normalized(area), w));
            if (cosine <= 0) return;
            const double B = response / surface * E * cosine;
            sum += importance * B * B;
            out.power += surface * E * cosine;
        };
        if (R.is_cluster()) {
            for (FacingId f : bodies_.clusters().facings(R.cluster())) {
                const Facing& facing = bodies_.clusters().facing(f);
                receive(facing.area, facing.spread, facing.surface, light_.response[f], light_.importance[f]);
            }
        } else {
            const ElementId p = R.element();
            const double area = bodies_.elements().area(p);
            receive(bodies_.sites().normal(p), 0, area, area * Light::weight(bodies_, p), area * tolerance_.weight(p));
        }
        out.most = std::sqrt(sum);
        return out;
    }

    ElementId any_member(Body body, RandomStream& random) const {
        while (body.is_cluster()) {
            double at = random.uniform() * bodies_.area(body);
            const auto children = bodies_.clusters().children(body.cluster());
            body = children.back();
            for (Body child : children) {
                at -= bodies_.area(child);
                if (at > 0) continue;
                body = child;
                break;
            }
        }
        return body.element();
    }

    RayEnd any_point(Body body, RandomStream& random) const {
        const ElementTree& tree = bodies_.elements();
        const ElementId e = any_member(body, random);
        const double s = random.uniform(), t = random.uniform();
        return {tree.patch(e).at(tree.uniform(e, s, t)), tree.region(e)};
    }

    const Normal& normal(const RayEnd& p) const { return bodies_.sites().stage().scene.regions()[p.region].plane.n; }

    /// Casts rays between random points of the members that face each other. Each ray is weighted with the transport
    /// along it.
    void cast(Found& pair, unsigned wanted) {
        RandomStream random(tolerance_.seed, Stream::visibility, pair.link.receiver.value(), pair.link.source.value());
        std::vector<RayEnd> from, to;
        std::vector<double> share;
        constexpr unsigned attempts = 4;  // random pairs of points that are tried per wanted ray
        for (unsigned i = 0; i < attempts * wanted && from.size() < wanted; ++i) {
            const RayEnd x = any_point(pair.link.receiver, random), y = any_point(pair.link.source, random);
            const Vec3 d = y.x - x.x;
            const double here = dot(normal(x), d), there = -dot(normal(y), d);
            if (here <= 0 || there <= 0) continue;
            from.push_back(x), to.push_back(y);
            share.push_back(here * there / squared_norm(d));
        }
        std::array<bool, 64> blocked{};
        rays_ += bodies_.sites().stage().tracer.occluded(from, to, std::span(blocked).first(from.size()));
        double open = 0, all = 0;
        pair.rays = wanted, pair.open = 0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            all += share[i];
            if (!blocked[i]) open += share[i], ++pair.open;
        }
        pair.link.visible = all > 0 ? static_cast<float>(open / all) : 1;
        // If fewer point pairs than requested face each other, scale the number of open rays accordingly.
        if (!from.empty())
            pair.open = pair.open * wanted / static_cast<unsigned>(from.size());
        else
            pair.open = wanted;
    }

    const Bodies& bodies_;
    const NodalField& b_;
    const Light& light_;
    const LinkTolerance& tolerance_;
    std::size_t rays_ = 0;
};

std::vector<LinkPair> ClusterRefiner::refine(const NodalField& b, const LinkTolerance& tolerance,
                                             const StopRequest& stop) {
    std::vector<Found> open = std::move(links_);
    links_.clear();
    if (!begun_ && bodies_.clusters().size() > 0)
        open.push_back({{bodies_.clusters().root(), bodies_.clusters().root()}});
    begun_ = true;
    const Judge::Light light(bodies_, b, tolerance);
    std::vector<LinkPair> pairs;
    while (!open.empty()) {
        // After a stop request, link the remaining pairs as soon as possible.
        LinkTolerance now = tolerance;
        if (stop.requested()) now.error = HUGE_VAL;
        std::vector<Block> blocks((open.size() + block_size - 1) / block_size);
        parallel_for(blocks.size(), 1,
                     [&](std::size_t i) {
                         Judge judge(bodies_, b, light, now);
                         Block& block = blocks[i];
                         for (std::size_t k = i * block_size; k < std::min(open.size(), (i + 1) * block_size); ++k) {
                             Found& pair = open[k];
                             const auto [R, S] = std::pair{pair.link.receiver, pair.link.source};
                             switch (judge.judge(pair)) {
                                 case Judge::Verdict::drop:
                                     break;
                                 case Judge::Verdict::accept:
                                     block.links.push_back(pair);
                                     break;
                                 case Judge::Verdict::cut_receiver:
                                     for (Body part : bodies_.parts(R)) block.cut.push_back({{part, S}});
                                     break;
                                 case Judge::Verdict::cut_source:
                                     for (Body part : bodies_.parts(S)) block.cut.push_back({{R, part}});
                                     break;
                                 case Judge::Verdict::leave_to_elements:
                                     block.pairs.push_back({R.element(), S.element()});
                             }
                         }
                         block.rays = judge.rays();
                         note_touched("rays", block.rays), note_touched("links", block.links.size());
                     },
                     {"judge clusters",
                      [&](std::size_t i) { return bodies_.region(open[i * block_size].link.receiver).value; }, true});
        open.clear();
        for (Block& block : blocks) {
            links_.insert(links_.end(), block.links.begin(), block.links.end());
            open.insert(open.end(), block.cut.begin(), block.cut.end());
            pairs.insert(pairs.end(), block.pairs.begin(), block.pairs.end());
            rays_ += block.rays;
            block = {};
        }
    }
    double squares = 0;
    light_ = 0;
    for (const Found& found : links_) squares += found.squared_error, light_ += found.light;
    error_ = std::sqrt(squares);
    return pairs;
}

ClusterLinks ClusterRefiner::make_links() const {
    std::vector<ClusterLink> links;
    for (const Found& found : links_)
        if (found.link.visible > 0) links.push_back(found.link);
    return {bodies_, std::move(links)};
}

}  // namespace exitance
