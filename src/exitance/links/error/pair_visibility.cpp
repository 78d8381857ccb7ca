#include "exitance/links/error/pair_visibility.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Variance of a share of `open` out of `all` rays. Half a ray is added to both open and blocked rays, so that few rays
/// do not give certainty.
double variance_of_share(double open, double all) {
    const double v = (open + 0.5) / (all + 1);
    return v * (1 - v) / all;
}

}  // namespace

/// Adds a ray if the two front sides face each other there. Returns whether they do.
bool PairVisibility::add_ray(ElementId p, ElementId q, const Point& x, const Point& y) {
    if (dot(sites_.normal(p), y - x) <= 0 || dot(sites_.normal(q), x - y) <= 0) return false;
    from_.push_back(x), to_.push_back(y);
    return true;
}

void PairVisibility::cast(ElementId p, ElementId q) {
    rays_ += sites_.stage().tracer.occluded(from_, to_, sites_.tree().region(p), sites_.tree().region(q),
                                            std::span(blocked_).first(from_.size()));
}

double PairVisibility::look(ElementId p, ElementId q, unsigned count) {
    const ScrambledSobol points(hash(seed_, static_cast<std::uint64_t>(Stream::visibility), p.value, q.value));
    const ElementTree& tree = sites_.tree();
    const Patch &receiver = tree.patch(p), &source = tree.patch(q);
    from_.clear(), to_.clear();
    for (std::uint32_t i = 0; i < count; ++i)
        add_ray(p, q, at_nodes_ ? sites_.node(p, 0) : receiver.at(tree.uniform(p, points(i, 0), points(i, 1))),
                at_nodes_ ? sites_.node(q, 0) : source.at(tree.uniform(q, points(i, 2), points(i, 3))));
    share_[0] = 1;
    if (from_.empty()) return 0;
    cast(p, q);
    const auto open = std::count(blocked_.begin(), blocked_.begin() + static_cast<long>(from_.size()), false);
    const auto rays = static_cast<double>(from_.size());
    share_[0] = static_cast<double>(open) / rays;
    return std::sqrt(variance_of_share(static_cast<double>(open), rays));
}

void PairVisibility::look_by_node(ElementId p, ElementId q, unsigned each, bool few) {
    // Derived from the quadrature rule at the nodes: twice the distance of its first node from the element's border.
    const double size = at_nodes_ ? 0 : n_ == 4 ? 0.42 : 0.22;
    RandomStream random(seed_, Stream::visibility, p.value, q.value);
    const Patch receiver = sites_.frame(p), source = sites_.frame(q);
    const auto around = [&](ElementId e, const Patch& frame, std::size_t node) {
        const double s = random.uniform(), t = random.uniform();
        const Point x =
            sites_.node(frame, node) + size * (frame.at(uniform_in_shape(frame.shape, s, t)) - frame.centre());
        return sites_.within(e, x);
    };
    from_.clear(), to_.clear(), pair_of_ray_.clear();
    for (std::size_t k = 0; k < n_; ++k) {
        if (sites_.weight(p, k) == 0) continue;
        const std::size_t chosen = few ? static_cast<std::size_t>(random.uniform() * static_cast<double>(n_)) : n_;
        for (std::size_t l = 0; l < n_; ++l) {
            if (few && l != chosen) continue;
            for (unsigned ray = 0; ray < each; ++ray) {
                const Point x = around(p, receiver, k), y = around(q, source, l);
                if (add_ray(p, q, x, y)) pair_of_ray_.push_back(k * n_ + l);
            }
        }
    }
    share_.fill(1);
    variance_.fill(0);
    if (from_.empty()) return;
    cast(p, q);
    std::array<double, 81> open{}, all{};
    for (std::size_t i = 0; i < from_.size(); ++i) {
        all[pair_of_ray_[i]] += 1;
        if (!blocked_[i]) open[pair_of_ray_[i]] += 1;
    }
    for (std::size_t k = 0; k < n_; ++k) {
        double through = 0, cast = 0;
        for (std::size_t i = k * n_; i < (k + 1) * n_; ++i) {
            through += open[i], cast += all[i];
            if (all[i] > 0) share_[i] = open[i] / all[i];
        }
        if (cast == 0) continue;
        if (few) std::fill_n(share_.begin() + static_cast<long>(k * n_), n_, through / cast);
        variance_[k] = variance_of_share(through, cast);
    }
}

}  // namespace exitance
