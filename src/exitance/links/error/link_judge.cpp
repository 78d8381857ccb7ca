#include "exitance/links/error/link_judge.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exitance/calibration/numbers.hpp"
#include "exitance/links/error/undersampling.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

/// Number of visibility rays per value of a link, and of a weak link.
constexpr unsigned rays_per_link = 16, rays_per_weak_link = 4;

/// Returns whether a link is so weak that a few rays suffice for its visibility.
bool is_weak(double light, double allowed) {
    return light < calibrated::weak_link_share * allowed;
}

/// Standard error of this many rays if half of the light is hidden, W/m^2.
double error_half_hidden(double light, double rays) {
    return 0.5 * light / std::sqrt(rays);
}

LinkDecision decided(LinkDecision::Verdict verdict) {
    LinkDecision out;
    out.verdict = verdict;
    return out;
}

}  // namespace

LinkJudge::LinkJudge(const LinkSites& sites, const NodalField& b, const Field<ElementId, double>& roughness,
                     const LinkTolerance& tolerance)
    : sites_(sites),
      b_(b),
      roughness_(roughness),
      tolerance_(tolerance),
      n_(sites.nodes()),
      rule_(sites, tolerance),
      visible_(sites, tolerance.quadrature, tolerance.seed) {}

/// Returns whether the front of each element may be visible from somewhere on the other. Conservative: may return true
/// unnecessarily.
bool LinkJudge::may_see(ElementId p, ElementId q) const {
    const Vec3 d = sites_.centre(q) - sites_.centre(p);
    const double reach = sites_.radius(p) + sites_.radius(q), slack = sites_.stage().occluders.rounding();
    return dot(sites_.normal(p), d) > slack - reach && -dot(sites_.normal(q), d) > slack - reach;
}

/// Determines possible occluders, unless they are known. For a weak pair, uses those inherited.
void LinkJudge::classify_view(LinkPair& pair, std::span<const PieceId> pool, bool is_weak) {
    if (pair.view != View::mixed || classified_) return;
    const auto inherited = pool.subspan(pair.first, pair.triaged ? pair.count : 0);
    if (tolerance_.triage && !is_weak) {
        classified_ = true;
        const LinkSites& s = sites_;
        const std::vector<Point> receiver = s.tree().outline(pair.receiver), source = s.tree().outline(pair.source);
        shaft_.set(s.stage().occluders, {receiver, s.normal(pair.receiver), s.tree().region(pair.receiver)},
                   {source, s.normal(pair.source), s.tree().region(pair.source)});
        pair.view = pair.triaged ? shaft_.classify(inherited, candidates_) : shaft_.classify(candidates_);
        pair.triaged = true;
    } else if (pair.triaged) {
        candidates_.assign(inherited.begin(), inherited.end());
    }
}

/// Tries a constant link: a small contribution may be treated as uniform over the receiver and as independent of where
/// on the source it originates, for every basis. Returns nothing if that is too inaccurate.
std::optional<LinkDecision> LinkJudge::judge_as_constant(LinkPair& pair, std::span<const PieceId> pool,
                                                         const SourceLight& source, double allowed) {
    const auto [p, q] = std::pair{pair.receiver, pair.source};
    const double b = source.mean;
    double variation = source.roughness * source.roughness;
    for (std::size_t l = 0; l < n_; ++l) variation += source.weight[l] * std::pow(source.light[l] - b, 2);
    const EvenTransfer even = rule_.send_evenly(p, source, b, allowed);
    const double residual =
        tolerance_.residual_weight * std::min(1.0, rule_.ratio(p, q)) * even.form_factor * std::sqrt(variation);
    const double rule_error = even.rule_error + tolerance_.systematic * residual;
    if (rule_error > allowed) return std::nullopt;
    for (double d : even.departure)
        if (std::abs(d) > calibrated::negligible_link_share * allowed) return std::nullopt;

    const double light = std::abs(even.form_factor * b);
    const bool weak = is_weak(light, allowed);
    classify_view(pair, pool, weak);
    if (pair.view == View::none) return LinkDecision();
    visible_.set_all(1);
    double visibility_error = 0;
    if (pair.view == View::mixed) {
        constexpr double hopeless_excess = 2;
        if (error_half_hidden(light, rays_per_link) > hopeless_excess * allowed) return std::nullopt;
        visibility_error = light * visible_.look(p, q, weak ? rays_per_weak_link : rays_per_link);
        if (visibility_error > allowed) return std::nullopt;
    }
    const double area = sites_.tree().area(p);
    LinkDecision out = decided(LinkDecision::Verdict::accept);
    out.link.receiver = p, out.link.source = q;
    out.link.set_constant(even.form_factor * visible_.share(0));
    for (std::size_t i = 0; i < even.departure.size(); ++i) out.departure[i] = even.departure[i] * visible_.share(0);
    out.light = area * light;
    out.squared_error = area * tolerance_.weight(p) * (rule_error * rule_error + visibility_error * visibility_error);
    return out;
}

double LinkJudge::cast_once(const LinkPair& pair, const OpenTransfer& transfer, unsigned times, bool few) {
    if (n_ == 1) {
        const unsigned rays = tolerance_.quadrature ? 1 : few ? rays_per_weak_link : rays_per_link * times;
        return std::abs(transfer.light[0]) * visible_.look(pair.receiver, pair.source, rays);
    }
    visible_.look_by_node(pair.receiver, pair.source, times, few && !tolerance_.quadrature);
    double variance = 0;
    for (std::size_t k = 0; k < n_; ++k)
        variance += sites_.weight(pair.receiver, k) * std::pow(transfer.light[k], 2) * visible_.variance(k);
    return std::sqrt(variance);
}

/// Casts rays between the two, more if that is needed for an error of at most `allowed`. Returns the standard error of
/// the received light, W/m^2. few: only a few rays.
double LinkJudge::cast(const LinkPair& pair, const OpenTransfer& transfer, bool few, double allowed) {
    constexpr double max_times = 16;
    const double error = cast_once(pair, transfer, 1, few);
    if (few || tolerance_.quadrature || error <= allowed) return error;
    const double times = std::clamp(std::ceil(std::pow(error / allowed, 2)), 2.0, max_times);
    return cast_once(pair, transfer, static_cast<unsigned>(times), few);
}

/// Strength oracles: if the link is too strong, selects the larger element for splitting. A source that is a leaf is
/// not split; as a receiver it is judged separately.
LinkJudge::Cut LinkJudge::what_to_cut(const LinkPair& pair, const OpenTransfer& transfer) const {
    constexpr double partial = 0.5;  // share of the limit for partly hidden pairs; derived from [Hanrahan91]
    const auto [p, q] = std::pair{pair.receiver, pair.source};
    const double allowed = (pair.view == View::mixed ? partial : 1) * tolerance_.strongest;
    const double area = sites_.tree().area(p), ratio = area / sites_.tree().area(q);
    double F = 0, power = 0;
    for (std::size_t k = 0; k < n_; ++k) {
        for (std::size_t l = 0; l < n_; ++l) F += sites_.weight(p, k) * transfer.rows[k][l];
        power += area * sites_.weight(p, k) * std::abs(transfer.light[k]);
    }
    const bool by_power = tolerance_.oracle == LinkOracle::power;
    const double as_receiver = by_power ? power : F * ratio, as_source = by_power ? power : F;
    if (ratio <= 1 && as_source > allowed && !sites_.tree().is_leaf(q)) return Cut::source;
    return as_receiver > allowed ? Cut::receiver : Cut::nothing;
}

LinkDecision LinkJudge::decide_by_strength(LinkPair& pair, std::span<const PieceId> pool, const SourceLight& source,
                                           const OpenTransfer& transfer, double allowed) {
    classify_view(pair, pool, false);
    if (pair.view == View::none) return {};
    const Cut cut = what_to_cut(pair, transfer);
    if (cut == Cut::source && allowed < HUGE_VAL) return decided(LinkDecision::Verdict::cut_source);
    const bool cuts_receiver = cut == Cut::receiver;
    const double visibility_error = pair.view == View::mixed ? cast(pair, transfer, cuts_receiver, HUGE_VAL) : 0;
    LinkDecision out = accept(pair, source, transfer, visibility_error);
    out.cuts_receiver = cuts_receiver;
    return out;
}

LinkDecision LinkJudge::decide_by_error(LinkPair& pair, std::span<const PieceId> pool, const SourceLight& source,
                                        const OpenTransfer& transfer, double allowed) {
    const LinkDecision cut_source = decided(LinkDecision::Verdict::cut_source);
    const double light = transfer.largest_light(n_);
    const bool weak = is_weak(light, allowed), leaf = sites_.tree().is_leaf(pair.source);
    classify_view(pair, pool, weak);
    if (pair.view == View::none) return {};
    if (!leaf && transfer.rule_error > allowed) return cut_source;
    double visibility_error = 0;
    if (pair.view == View::mixed) {
        // Rays are not cast if their error would be far too large.
        const double rays_per_node = n_ == 1 ? rays_per_link : static_cast<double>(n_);
        constexpr double hopeless_excess = 3;
        if (!leaf && error_half_hidden(light, rays_per_node) > hopeless_excess * allowed) return cut_source;
        visibility_error = cast(pair, transfer, weak, leaf ? allowed : HUGE_VAL);
        if (!leaf && visibility_error > allowed) return cut_source;
    }
    const bool looks_closer = !tolerance_.corrected && allowed < HUGE_VAL;
    return accept(pair, source, transfer, visibility_error,
                  looks_closer ? undersampling_error(rule_, sites_, transfer, pair.receiver, source,
                                                     pair.view == View::open, allowed)
                               : 0);
}

LinkDecision LinkJudge::judge(LinkPair& pair, std::span<const PieceId> pool) {
    const auto [p, q] = std::pair{pair.receiver, pair.source};
    candidates_.clear();
    block_.clear();
    classified_ = false;
    if (!may_see(p, q)) return {};
    const Material& material = sites_.stage().scene.material(sites_.tree().region(p));
    const SourceLight source = source_light(sites_, b_, roughness_[q], q, light_weight(material));
    const double allowed = tolerance_.error / std::sqrt(sites_.tree().area(p) * tolerance_.weight(p));
    if (n_ > 1 && tolerance_.corrected)
        if (const auto decision = judge_as_constant(pair, pool, source, allowed)) return *decision;
    const OpenTransfer transfer = rule_.send(p, source, allowed);
    return tolerance_.oracle == LinkOracle::transport ? decide_by_error(pair, pool, source, transfer, allowed)
                                                      : decide_by_strength(pair, pool, source, transfer, allowed);
}

/// Makes an accepted link. `visibility_error`, `undersampling`: RMS over the receiver, W/m^2.
LinkDecision LinkJudge::accept(const LinkPair& pair, const SourceLight& source, const OpenTransfer& transfer,
                               double visibility_error, double undersampling) {
    const auto [p, q] = std::pair{pair.receiver, pair.source};
    const double area = sites_.tree().area(p), weight = tolerance_.weight(p);
    LinkDecision out = decided(LinkDecision::Verdict::accept);
    out.departure = transfer.departure;
    out.link.receiver = p, out.link.source = q;
    out.undersampling = std::sqrt(area * weight) * undersampling;
    out.cuts_receiver = out.undersampling > tolerance_.error;
    set_kernel(pair.view == View::open, source, transfer, out);
    for (std::size_t k = 0; k < n_; ++k) out.light += area * sites_.weight(p, k) * std::abs(transfer.light[k]);
    out.squared_error =
        area * weight * (transfer.rule_error * transfer.rule_error + visibility_error * visibility_error);
    return out;
}

void LinkJudge::set_block(const OpenTransfer& transfer, double scale) {
    for (std::size_t k = 0; k < n_; ++k)
        for (std::size_t l = 0; l < n_; ++l) block_.push_back(static_cast<float>(transfer.rows[k][l] * scale));
}

/// Stores the visibility found by rays: as bits if it is 0 or 1, otherwise as factors in the block.
void LinkJudge::set_kernel(bool open, const SourceLight& source, const OpenTransfer& transfer, LinkDecision& out) {
    if (n_ == 1) {
        const double share = open ? 1 : visible_.share(0);
        out.link.factor = static_cast<float>(transfer.rows[0][0] * share);
        for (double& d : out.departure) d *= share;
        return;
    }
    const std::size_t pairs = n_ * n_;
    if (transfer.has_block) set_block(transfer, 1);
    double scale = 1, share = 1;
    if (!open) {
        share = 0;
        bool partial = false;
        for (std::size_t i = 0; i < pairs; ++i) {
            partial |= visible_.share(i) > 0 && visible_.share(i) < 1;
            share += visible_.share(i) / static_cast<double>(pairs);
        }
        if (tolerance_.fractional) {
            visible_.set_all(share);
            partial = share > 0 && share < 1;
        }
        if (partial && block_.empty()) {
            if (!transfer.near) scale = rule_.scale_of_kernel(transfer, out.link.receiver, source);
            set_block(transfer, scale);
        }
        for (std::size_t i = 0; i < block_.size(); ++i) block_[i] *= static_cast<float>(visible_.share(i));
        for (std::size_t k = 0; k < n_; ++k) {
            out.variance[k] = std::pow(transfer.light[k], 2) * visible_.variance(k);
            for (std::size_t l = 0; l < n_; ++l)
                out.shadowed[k] += transfer.rows[k][l] * scale * visible_.share(k * n_ + l) * source.light[l];
        }
    }
    for (double& d : out.departure) d *= share;
    out.near = !block_.empty();
    if (!out.near) out.link.set_far(static_cast<float>(rule_.scale_of_kernel(transfer, out.link.receiver, source)));
    for (std::size_t i = 0; i < pairs; ++i)
        if (open || out.near || visible_.share(i) > 0) out.link.set(i);
}

}  // namespace exitance
