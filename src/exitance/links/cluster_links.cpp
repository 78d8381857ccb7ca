#include "exitance/links/cluster_links.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"

namespace exitance {

std::vector<Body> Bodies::parts(Body b) const {
    if (b.is_cluster()) {
        const auto children = clusters_->children(b.cluster());
        return {children.begin(), children.end()};
    }
    std::vector<Body> out;
    for (ElementId child : elements().children(b.element())) out.push_back(child);
    return out;
}

RegionId Bodies::region(Body b) const {
    while (b.is_cluster()) b = clusters_->children(b.cluster()).front();
    return elements().region(b.element());
}

VectorPower power_of(const LinkSites& sites, ElementId e, const NodalField& b) {
    VectorPower out{};
    for (std::size_t k = 0; k < sites.nodes(); ++k)
        for (std::size_t band = 0; band < bands; ++band)
            out[band] += (sites.tree().area(e) * sites.weight(e, k) * b.node(e, k)[band]) * sites.normal(e);
    return out;
}

namespace {

void add(VectorPower& sum, const VectorPower& v) {
    for (std::size_t band = 0; band < bands; ++band) sum[band] += v[band];
}

}  // namespace

Field<FacingId, VectorPower> find_vector_powers(const Bodies& bodies, const NodalField& b) {
    const ClusterTree& clusters = bodies.clusters();
    Field<FacingId, VectorPower> out(clusters.facing_count());
    for (ElementId piece : bodies.elements().roots())
        add(out[clusters.facing_of(piece)], power_of(bodies.sites(), piece, b));
    for (std::size_t i = clusters.size(); i-- > 1;)
        for (FacingId f : clusters.facings(ClusterId(i))) add(out[clusters.facing(f).above], out[f]);
    return out;
}

ClusterLinks::ClusterLinks(const Bodies& bodies, std::vector<ClusterLink> links)
    : bodies_(bodies), links_(std::move(links)) {
    std::sort(links_.begin(), links_.end(), [](const ClusterLink& a, const ClusterLink& b) {
        return a.receiver != b.receiver ? a.receiver < b.receiver : a.source < b.source;
    });
    for (std::size_t i = 0; i < links_.size(); ++i)
        if (i == 0 || links_[i].receiver != links_[i - 1].receiver) first_.push_back(i);
    first_.push_back(links_.size());
}

std::size_t ClusterLinks::memory_bytes() const {
    return links_.size() * sizeof(ClusterLink) + 8 * first_.size() + bodies_.clusters().memory_bytes() +
           2 * bodies_.clusters().facing_count() * sizeof(VectorPower);
}

void ClusterLinks::mark(Field<ElementId, std::uint8_t>& marked) const {
    for (const ClusterLink& link : links_)
        for (Body end : {link.receiver, link.source})
            if (!end.is_cluster()) marked[end.element()] = 1;
}

namespace {

/// Irradiance per band on a plane perpendicular to the direction of light, and that direction, from the source to x.
struct Arrival {
    Spectrum E;
    Vec3 w;
};

class Sender {
  public:
    Sender(const Bodies& bodies, const Field<FacingId, VectorPower>& powers, const NodalField& b)
        : bodies_(bodies), powers_(powers), b_(b) {}

    Arrival at(const Point& x, const ClusterLink& link) const {
        const Vec3 d = x - bodies_.centre(link.source);
        const double rr = squared_norm(d);
        Arrival out{Spectrum(), (1 / std::sqrt(rr)) * d};
        const auto send = [&](const Vec3& area, const VectorPower& v) {
            if (dot(area, out.w) <= 0) return;
            for (std::size_t band = 0; band < bands; ++band) out.E[band] += dot(v[band], out.w);
        };
        if (link.source.is_cluster()) {
            const ClusterTree& clusters = bodies_.clusters();
            for (FacingId f : clusters.facings(link.source.cluster())) send(clusters.facing(f).area, powers_[f]);
        } else {
            const ElementId q = link.source.element();
            send(bodies_.sites().normal(q), power_of(bodies_.sites(), q, b_));
        }
        out.E *= static_cast<double>(link.visible) / (pi * rr);
        return out;
    }

  private:
    const Bodies& bodies_;
    const Field<FacingId, VectorPower>& powers_;
    const NodalField& b_;
};

}  // namespace

void ClusterLinks::add_to(NodalField& E, const NodalField& b) const {
    const ClusterTree& clusters = bodies_.clusters();
    const LinkSites& sites = bodies_.sites();
    const Field<FacingId, VectorPower> powers = find_vector_powers(bodies_, b);
    const Sender sender(bodies_, powers, b);
    Field<FacingId, VectorPower> received(clusters.facing_count());  // sums of E w for each facing
    parallel_for(first_.size() - 1, 16,
                 [&](std::size_t row) {
                     const Body receiver = links_[first_[row]].receiver;
                     NodalValues arrived{};
                     for (std::size_t i = first_[row]; i < first_[row + 1]; ++i) {
                         if (receiver.is_cluster()) {
                             const Arrival light = sender.at(clusters.centre(receiver.cluster()), links_[i]);
                             for (FacingId f : clusters.facings(receiver.cluster())) {
                                 if (dot(clusters.facing(f).area, light.w) >= 0) continue;
                                 for (std::size_t band = 0; band < bands; ++band)
                                     received[f][band] += light.E[band] * light.w;
                             }
                             continue;
                         }
                         const ElementId p = receiver.element();
                         for (std::size_t k = 0; k < sites.nodes(); ++k) {
                             const Arrival light = sender.at(sites.node(p, k), links_[i]);
                             const double cosine = -dot(sites.normal(p), light.w);
                             if (cosine > 0) arrived[k] += cosine * light.E;
                         }
                     }
                     if (!receiver.is_cluster()) E.add(receiver.element(), arrived);
                     note_touched("links", first_[row + 1] - first_[row]);
                 },
                 {"gather cluster links",
                  [&](std::size_t row) { return bodies_.region(links_[first_[row]].receiver).value; }, true});
    for (std::size_t i = 1; i < clusters.size(); ++i)
        for (FacingId f : clusters.facings(ClusterId(i))) add(received[f], received[clusters.facing(f).above]);
    for (ElementId piece : bodies_.elements().roots()) {
        Spectrum light;
        for (std::size_t band = 0; band < bands; ++band)
            light[band] = -dot(sites.normal(piece), received[clusters.facing_of(piece)][band]);
        NodalValues alike;
        alike.fill(light);
        E.add(piece, alike);
    }
}

}  // namespace exitance
