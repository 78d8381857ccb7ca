#include "exitance/links/error/link_judge.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/geometry/polygon.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

/// cos cos / r^2 between two points of two surfaces, m^-2; 0 where either looks away from the other.
double point_kernel(const Point& x, const Normal& n, const Point& y, const Normal& m) {
    const Vec3 d = y - x;
    const double here = dot(n, d), there = -dot(m, d), rr = squared_norm(d);
    return here > 0 && there > 0 ? here * there / (rr * rr) : 0;
}

/// The rule's error relative to what it gives is rule_constant (size / distance)^(2 M).
constexpr double rule_constant = 0.3, surely_near = 0.7, surely_far = 0.1;

constexpr double hardly = 0.2;  ///< Of what is allowed: errors and departures of many links add up.

/// Does so much light count so little that what may stand in between is hardly worth a look?
bool is_tiny(double light, double allowed) {
    return light < 0.3 * allowed;
}

}  // namespace

LinkJudge::LinkJudge(const LinkSites& sites, const NodalField& b, const Field<ElementId, double>& roughness,
                     const LinkTolerance& tolerance)
    : sites_(sites),
      b_(b),
      roughness_(roughness),
      tolerance_(tolerance),
      n_(sites.nodes()),
      square_(make_checks(Patch::Shape::parallelogram)),
      triangle_(make_checks(Patch::Shape::triangle)),
      near_row_(sites),
      visible_(sites, tolerance.quadrature, tolerance.seed) {}

/// Points between the nodes, the middle first, at which a polynomial of the basis and one of a degree more differ by
/// about as much as in the mean; of constants, Gauss's points.
LinkJudge::Checks LinkJudge::make_checks(Patch::Shape shape) const {
    Checks out;
    if (n_ == 1) {
        for (const PlanarNode& node : shape == Patch::Shape::triangle ? triangle_rule(2) : square_rule(2))
            out.at.push_back(node.at);
    } else if (shape == Patch::Shape::triangle) {
        if (sites_.basis().order() == 2)
            out.at = {{1.0 / 3, 1.0 / 3}, {0.5, 0.08}, {0.08, 0.5}, {0.42, 0.42}};
        else
            out.at = {{1.0 / 3, 1.0 / 3}, {0.12, 0.12}, {0.76, 0.12}, {0.12, 0.76}};
    } else if (sites_.basis().order() == 2) {
        out.at = {{0.5, 0.5}, {0.5, 0.08}, {0.92, 0.5}, {0.5, 0.92}, {0.08, 0.5}};
    } else {
        constexpr double g = 0.26;
        out.at = {{0.5, 0.5}, {0.5 - g, 0.5 - g}, {0.5 + g, 0.5 - g}, {0.5 - g, 0.5 + g}, {0.5 + g, 0.5 + g}};
    }
    out.factors.resize(out.at.size() * n_);
    for (std::size_t i = 0; i < out.at.size(); ++i)
        sites_.basis().interpolate(shape, out.at[i], std::span(out.factors).subspan(i * n_, n_));
    return out;
}

/// Can the front of either be seen from anywhere on the other? Errs to yes.
bool LinkJudge::may_see(ElementId p, ElementId q) const {
    const Vec3 d = sites_.centre(q) - sites_.centre(p);
    const double reach = sites_.radius(p) + sites_.radius(q), slack = sites_.stage().occluders.rounding();
    return dot(sites_.normal(p), d) > slack - reach && -dot(sites_.normal(q), d) > slack - reach;
}

void LinkJudge::set_source(ElementId q, const Spectrum& weight) {
    source_normal_ = sites_.normal(q);
    source_area_ = sites_.tree().area(q) / pi;
    source_roughness_ = mean(weight) * roughness_[q];
    source_mean_ = 0;
    const Patch frame = sites_.frame(q);
    for (std::size_t l = 0; l < n_; ++l) {
        source_node_[l] = sites_.node(frame, l);
        source_weight_[l] = sites_.weight(q, l);
        source_light_[l] = mean(weight * b_.node(q, l));
        source_mean_ += source_weight_[l] * source_light_[l];
    }
}

LinkJudge::Row LinkJudge::row(const Point& x, const Normal& n) {
    if (!near_) return kernel_row(x, n);
    Row out{};
    ++form_factors_;
    near_row_(x, n, out.data());
    return out;
}

LinkJudge::Row LinkJudge::kernel_row(const Point& x, const Normal& n) const {
    Row out{};
    for (std::size_t l = 0; l < n_; ++l)
        out[l] = source_weight_[l] * source_area_ * point_kernel(x, n, source_node_[l], source_normal_);
    return out;
}

double LinkJudge::light(const Row& row) const {
    double sum = 0;
    for (std::size_t l = 0; l < n_; ++l) sum += row[l] * source_light_[l];
    return sum;
}

/// One number stands for the whole receiver: the mean over Gauss's points of what reaches them, which goes to `light`.
/// Its middle alone would miss what peaks at edges where surfaces meet.
LinkJudge::Row LinkJudge::mean_row(const Patch& receiver, const Normal& n, Departure& light) {
    const Checks& checks = this->checks(receiver.shape);
    Row out{};
    for (std::size_t i = 0; i < checks.at.size(); ++i) {
        const Row here = row(receiver.at(checks.at[i]), n);
        light[i] = this->light(here);
        out[0] += here[0] / static_cast<double>(checks.at.size());
    }
    return out;
}

/// Size of the source to its distance.
double LinkJudge::ratio_of(ElementId p, ElementId q) const {
    const double gap = norm(sites_.centre(q) - sites_.centre(p)) - sites_.radius(p);
    return sites_.radius(q) / std::max(gap, 1e-3 * sites_.radius(q));
}

double LinkJudge::send(ElementId p, ElementId q, double allowed, Departure& departure) {
    const Normal& n = sites_.normal(p);
    const Patch frame = sites_.frame(p);
    const Checks& checks = this->checks(frame.shape);
    const double ratio = ratio_of(p, q);
    const int M = sites_.basis().order();
    ratio_ = ratio;
    const double rule_error = tolerance_.systematic * rule_constant * std::pow(ratio, 2 * M);
    near_ = keeps_block_ = false;
    block_.clear();
    double unit = 0, most = 0, kernel_error = 0;
    const auto at_nodes = [&] {
        unit = most = 0;
        departure.fill(0);
        for (std::size_t k = 0; k < n_; ++k) {
            rows_[k] = n_ == 1 ? mean_row(frame, n, departure) : row(sites_.receiving_node(p, k), n);
            node_light_[k] = light(rows_[k]);
            most = std::max(most, std::abs(node_light_[k]));
            for (std::size_t l = 0; l < n_; ++l) unit += sites_.weight(p, k) * rows_[k][l];
        }
    };
    if (ratio <= surely_near) {
        at_nodes();
        // Strength says nothing of the rule: there the good one is taken.
        const bool is_rough = tolerance_.oracle != LinkOracle::transport || most * rule_error > hardly * allowed;
        near_ = ratio > surely_far && is_rough;
    }
    if (ratio > surely_near || near_) {
        near_ = true;
        near_row_.set_source(q);
        at_nodes();
        kernel_error = tolerance_.systematic * error_of_kernel(p, q);
        const bool will_do = tolerance_.oracle == LinkOracle::transport && kernel_error <= hardly * allowed;
        keeps_block_ = n_ > 1 && !(will_do && allowed < HUGE_VAL);
        if (keeps_block_) set_block(), kernel_error = 0;
    }
    form_factor_ = rows_[0][0];
    brightest_ = most;
    for (std::size_t i = 0; i < checks.at.size(); ++i) {
        if (n_ > 1) departure[i] = light(row(frame.at(checks.at[i]), n));
        brightest_ = std::max(brightest_, std::abs(departure[i]));
        for (std::size_t k = 0; k < n_; ++k) departure[i] -= checks.factors[i * n_ + k] * node_light_[k];
    }
    const double unevenness = tolerance_.hidden * std::min(1.0, std::pow(ratio, M)) * unit * source_roughness_;
    return (near_ ? kernel_error : most * rule_error) + tolerance_.systematic * unevenness;
}

void LinkJudge::set_part(ElementId e, const Plane& plane, Part& out) const {
    out.plane = plane;
    clip(sites_.tree().outline(e), plane, out.outline);
    out.area = norm(area_vector(out.outline));
    if (out.area <= 0) return;
    out.middle = centroid(out.outline);
    out.radius = 0;
    for (const Point& corner : out.outline) out.radius = std::max(out.radius, norm(corner - out.middle));
}

/// Off the border, as far as the share says towards the middle, and before the plane.
Point LinkJudge::Part::drawn_in(const Point& x, double share) const {
    const double height = plane.signed_distance(middle), h = plane.signed_distance(x),
                 to_front = h < height ? (share * height - h) / (height - h) : 0;
    return x + std::clamp(to_front, share, 1.0) * (middle - x);
}

/// What a source sends to where none of the points are that are looked at: it is small and near, they all lie behind
/// it, or the two meet in a tip. RMS over the receiver, W/m^2. After send(), for the same pair.
double LinkJudge::missed_peak(ElementId p, ElementId q, bool open) {
    if (!near_) return 0;
    const auto plane_of = [&](ElementId e) { return Plane{sites_.normal(e), dot(sites_.normal(e), sites_.centre(e))}; };
    set_part(p, plane_of(q), receiver_part_);
    set_part(q, plane_of(p), source_part_);
    if (receiver_part_.area <= 0 || source_part_.area <= 0) return 0;
    const Patch receiver = sites_.frame(p), source = sites_.frame(q);
    const auto nearest = [](const Patch& patch, const Part& part, const Point& x) {
        return part.drawn_in(patch.at(into_shape(patch.coordinates(x), patch.shape)), 0);
    };
    constexpr double in_front = 0.5, at_border = 0.02, off_border = 0.1;
    const double thickness = source_part_.thickness();
    const Point& middle = source_part_.middle;
    const Point before = nearest(receiver, receiver_part_, middle + in_front * thickness * source_normal_);
    Point close = nearest(receiver, receiver_part_, middle);
    for (int i = 0; i < 4; ++i) close = nearest(receiver, receiver_part_, nearest(source, source_part_, close));
    const double depth = norm(receiver_part_.middle - close);
    const double off = std::min(off_border, in_front * thickness / std::max(depth, thickness));
    const auto missed = [&](const Point& x) {
        return missed_at(x, norm(nearest(source, source_part_, x) - x), p, open);
    };
    return std::max(missed(receiver_part_.drawn_in(before, at_border)), missed(receiver_part_.drawn_in(close, off)));
}

/// The same at a point, which is so far off the source.
double LinkJudge::missed_at(const Point& x, double gap, ElementId p, bool open) {
    // Where it is less bright, departures tell. They cancel where light is even, as it is mostly where views are open.
    const double plainly = n_ == 1 ? 8 : open ? 4 : 1.3, least = plainly * brightest_;
    const Normal& n = sites_.normal(p);
    ++form_factors_;
    const double F = point_to_polygon(x, n, source_part_.outline), unknown = F * source_roughness_;
    if (F * std::abs(source_mean_) + unknown < least) return 0;
    const double there = light(row(x, n));
    if (std::max(std::abs(there), unknown) < least) return 0;
    const double missed = std::max(std::abs(there - said_at(x, p)), unknown);
    const double area = (2 * source_part_.radius + gap) * (source_part_.thickness() + gap);  // of the peak
    return missed * std::sqrt(std::min(1.0, area / sites_.tree().area(p)));
}

/// The nodes' polynomial, W/m^2.
double LinkJudge::said_at(const Point& x, ElementId p) const {
    const Patch frame = sites_.frame(p);
    std::array<double, 9> factors{};
    sites_.basis().interpolate(frame.shape, frame.coordinates(x), std::span(factors).first(n_));
    double said = 0;
    for (std::size_t k = 0; k < n_; ++k) said += factors[k] * node_light_[k];
    return said;
}

/// Of a source that ends beside the receiver, what the nodes say of corners that see next to none of it. RMS over the
/// receiver, W/m^2, where it is above `allowed`. After send(), for the same pair.
double LinkJudge::missed_fall(ElementId p, double allowed) {
    constexpr double plainly = 4, much = 0.5, off_border = 0.03, share = 0.02;
    if (!near_ || n_ == 1 || std::sqrt(share) * brightest_ <= allowed) return 0;
    double most = 0;
    for (const Point& corner : sites_.tree().outline(p)) {
        const Point x = corner + off_border * (sites_.centre(p) - corner);
        const double there = light(row(x, sites_.normal(p))), said = said_at(x, p), missed = std::abs(said - there);
        if (std::abs(said) > plainly * std::abs(there) && missed > much * brightest_) most = std::max(most, missed);
    }
    return std::sqrt(share) * most;
}

/// How much light the kernel, made anew and scaled to send what near rows do in the mean, misplaces at the node where
/// that is most: of small or dim sources little, near as they are.
double LinkJudge::error_of_kernel(ElementId p, ElementId q) {
    if (n_ == 1) return 0;
    constexpr double least = 1e-3;  // of their sizes: single precision loses nodes that are nearer
    const double nearest = least * (sites_.radius(p) + sites_.radius(q));
    std::array<Row, 9> kernel;
    double exact = 0, rule = 0;
    for (std::size_t k = 0; k < n_; ++k) {
        const Point x = sites_.receiving_node(p, k);
        kernel[k] = kernel_row(x, sites_.normal(p));
        for (std::size_t l = 0; l < n_; ++l) {
            exact += sites_.weight(p, k) * rows_[k][l], rule += sites_.weight(p, k) * kernel[k][l];
            if (squared_norm(source_node_[l] - x) < nearest * nearest) return HUGE_VAL;
        }
    }
    kernel_scale_ = scale_to(exact, rule);
    if (std::abs(kernel_scale_ * rule - exact) > 1e-6 * exact) return HUGE_VAL;  // errors of one sign would add up
    double most = 0;
    for (std::size_t k = 0; k < n_; ++k)
        most = std::max(most, std::abs(kernel_scale_ * light(kernel[k]) - node_light_[k]));
    return most;
}

void LinkJudge::set_block() {
    block_.clear();
    for (std::size_t k = 0; k < n_; ++k)
        for (std::size_t l = 0; l < n_; ++l) block_.push_back(static_cast<float>(rows_[k][l]));
}

void LinkJudge::triage(LinkPair& pair, std::span<const PieceId> pool) {
    const LinkSites& s = sites_;
    const std::vector<Point> receiver = s.tree().outline(pair.receiver), source = s.tree().outline(pair.source);
    shaft_.set(s.stage().occluders, {receiver, s.normal(pair.receiver), s.tree().region(pair.receiver)},
               {source, s.normal(pair.source), s.tree().region(pair.source)});
    pair.view = pair.triaged ? shaft_.classify(pool.subspan(pair.first, pair.count), candidates_)
                             : shaft_.classify(candidates_);
    pair.triaged = true;
}

void LinkJudge::look_between(LinkPair& pair, std::span<const PieceId> pool, bool tiny) {
    if (pair.view != View::mixed || looked_between_) return;
    if (tolerance_.triage && !tiny) {
        looked_between_ = true;
        triage(pair, pool);
    } else if (pair.triaged) {
        const auto inherited = pool.subspan(pair.first, pair.count);
        candidates_.assign(inherited.begin(), inherited.end());
    }
}

LinkJudge::Even LinkJudge::send_evenly(ElementId p, ElementId q, double b, double allowed) {
    const Normal& n = sites_.normal(p);
    const Patch frame = sites_.frame(p);
    const Checks& checks = this->checks(frame.shape);
    const Point middle = sites_.centre(q);
    const auto kernel = [&](const Point& x) { return source_area_ * point_kernel(x, n, middle, source_normal_); };
    Even out;
    const double ratio = ratio_of(p, q), relative = tolerance_.systematic * rule_constant * ratio * ratio;
    out.rule_error = relative * std::abs(b) * kernel(frame.centre());
    const bool is_near = ratio > surely_near || (ratio > surely_far && out.rule_error > hardly * allowed);
    if (is_near) {
        outline_ = sites_.tree().outline(q);
        out.rule_error = 0;
        ++form_factors_;
    }
    const std::size_t count = checks.at.size();
    std::array<double, 5> F{};
    for (std::size_t i = 0; i < count; ++i) {
        const Point x = frame.at(checks.at[i]);
        F[i] = is_near ? std::max(0.0, point_to_polygon(x, n, outline_)) : kernel(x);
        if (i > 0) out.form_factor += F[i] / static_cast<double>(count - 1);  // nearly Gauss's rule of as many points
    }
    for (std::size_t i = 0; i < count; ++i) out.departure[i] = (F[i] - out.form_factor) * b;
    return out;
}

/// What little an element sends to another arrives alike all over it, wherever on the source it comes from: then one
/// number does, whatever the basis. Is that so here? Then `out` holds the link, if there is one.
bool LinkJudge::judge_as_constant(LinkPair& pair, std::span<const PieceId> pool, double allowed, Result& out) {
    const auto [p, q] = std::pair{pair.receiver, pair.source};
    const double b = source_mean_;
    double variation = source_roughness_ * source_roughness_;
    for (std::size_t l = 0; l < n_; ++l) variation += source_weight_[l] * std::pow(source_light_[l] - b, 2);
    const Even even = send_evenly(p, q, b, allowed);
    const double unevenness =
        tolerance_.hidden * std::min(1.0, ratio_of(p, q)) * even.form_factor * std::sqrt(variation);
    const double rule = even.rule_error + tolerance_.systematic * unevenness;
    if (rule > allowed) return false;
    for (double d : even.departure)
        if (std::abs(d) > hardly * allowed) return false;

    const double light = std::abs(even.form_factor * b);
    const bool tiny = is_tiny(light, allowed);
    look_between(pair, pool, tiny);
    if (pair.view == View::none) return true;
    visible_.set_all(1);
    double visibility = 0;
    if (pair.view == View::mixed) {
        constexpr unsigned few = 4, many = 16;
        constexpr double half_hidden = 0.5, too_large = 2;
        if (half_hidden * light / std::sqrt(static_cast<double>(many)) > too_large * allowed) return false;
        visibility = light * visible_.look(p, q, tiny ? few : many);
        if (visibility > allowed) return false;
    }
    out.link.receiver = p, out.link.source = q;
    out.link.set_constant(even.form_factor * visible_.share(0));
    for (std::size_t i = 0; i < even.departure.size(); ++i) out.departure[i] = even.departure[i] * visible_.share(0);
    const double area = sites_.tree().area(p);
    out.light = area * light;
    out.squared_error = area * tolerance_.weight(p) * (rule * rule + visibility * visibility);
    out.verdict = Verdict::accept;
    return true;
}

double LinkJudge::cast_once(ElementId p, ElementId q, unsigned times, bool few) {
    constexpr unsigned one_link = 16, few_of_one = 4;
    if (n_ == 1) {
        const unsigned rays = tolerance_.quadrature ? 1 : few ? few_of_one : one_link * times;
        return std::abs(node_light_[0]) * visible_.look(p, q, rays);
    }
    visible_.look_by_node(p, q, times, few && !tolerance_.quadrature);
    double variance = 0;
    for (std::size_t k = 0; k < n_; ++k)
        variance += sites_.weight(p, k) * std::pow(node_light_[k], 2) * visible_.variance(k);
    return std::sqrt(variance);
}

double LinkJudge::cast(ElementId p, ElementId q, bool few, double allowed) {
    const double error = cast_once(p, q, 1, few);
    if (few || tolerance_.quadrature || error <= allowed) return error;
    return cast_once(p, q, static_cast<unsigned>(std::clamp(std::ceil(std::pow(error / allowed, 2)), 2.0, 16.0)), few);
}

/// By strength: the larger of the two, as long as the link is too strong. A source that is a leaf stays as it is; as a
/// receiver it is judged by itself.
LinkJudge::Cut LinkJudge::what_to_cut(ElementId p, ElementId q, bool mixed) const {
    constexpr double partial = 0.5;  // of what is allowed, where something may stand in between
    const double allowed = (mixed ? partial : 1) * tolerance_.strongest;
    const double area = sites_.tree().area(p), ratio = area / sites_.tree().area(q);
    double F = 0, power = 0;
    for (std::size_t k = 0; k < n_; ++k) {
        for (std::size_t l = 0; l < n_; ++l) F += sites_.weight(p, k) * rows_[k][l];
        power += area * sites_.weight(p, k) * std::abs(node_light_[k]);
    }
    const bool by_power = tolerance_.oracle == LinkOracle::power;
    const double as_receiver = by_power ? power : F * ratio, as_source = by_power ? power : F;
    if (ratio <= 1 && as_source > allowed && !sites_.tree().is_leaf(q)) return Cut::source;
    return as_receiver > allowed ? Cut::receiver : Cut::nothing;
}

LinkJudge::Result LinkJudge::judge(LinkPair& pair, std::span<const PieceId> pool) {
    const auto [p, q] = std::pair{pair.receiver, pair.source};
    Result out;
    candidates_.clear();
    looked_between_ = false;
    if (!may_see(p, q)) return out;
    const Material& material = sites_.stage().scene.material(sites_.tree().region(p));
    set_source(q, light_weight(material));
    const double area = sites_.tree().area(p), weight = tolerance_.weight(p),
                 allowed = tolerance_.error / std::sqrt(area * weight);
    if (n_ > 1 && tolerance_.corrected && judge_as_constant(pair, pool, allowed, out)) return out;
    const double rule = send(p, q, allowed, out.departure);
    double light = 0;
    for (std::size_t k = 0; k < n_; ++k) light = std::max(light, std::abs(node_light_[k]));
    const bool by_error = tolerance_.oracle == LinkOracle::transport, tiny = by_error && is_tiny(light, allowed);
    look_between(pair, pool, tiny);
    if (pair.view == View::none) return out;
    out.link.receiver = p, out.link.source = q;
    const bool leaf = sites_.tree().is_leaf(q);
    double visibility = 0;
    if (!by_error) {
        const Cut cut = what_to_cut(p, q, pair.view == View::mixed);
        if (cut == Cut::source && allowed < HUGE_VAL) return out.verdict = Verdict::cut_source, out;
        out.cuts_receiver = cut == Cut::receiver;
        if (pair.view == View::mixed) visibility = cast(p, q, out.cuts_receiver, HUGE_VAL);
    } else if (!leaf && rule > allowed) {
        return out.verdict = Verdict::cut_source, out;
    } else if (pair.view == View::mixed) {
        // With half of it hidden, would the rays' error be far too large? Then they are not worth casting.
        const double rays_a_node = n_ == 1 ? 16 : static_cast<double>(n_);
        constexpr double far_too_large = 3;
        if (!leaf && 0.5 * light / std::sqrt(rays_a_node) > far_too_large * allowed)
            return out.verdict = Verdict::cut_source, out;
        visibility = cast(p, q, tiny, leaf ? allowed : HUGE_VAL);
        if (!leaf && visibility > allowed) return out.verdict = Verdict::cut_source, out;
    }
    if (by_error && !tolerance_.corrected && allowed < HUGE_VAL) {
        out.missed =
            std::sqrt(area * weight) * std::max(missed_peak(p, q, pair.view == View::open), missed_fall(p, allowed));
        out.cuts_receiver = out.missed > tolerance_.error;
    }
    hand_over(pair.view == View::open, out);
    for (std::size_t k = 0; k < n_; ++k) out.light += area * sites_.weight(p, k) * std::abs(node_light_[k]);
    out.squared_error = area * weight * (rule * rule + visibility * visibility);
    out.verdict = Verdict::accept;
    return out;
}

double LinkJudge::scale_to(double exact, double rule) {
    constexpr double least = 0.5, most = 2;  // beyond, it is the horizon that cuts the source
    return rule > 0 ? std::clamp(exact / rule, least, most) : 1;
}

double LinkJudge::scale_of_rule(ElementId p, ElementId q) {
    constexpr double hardly = 1e-5;  // of what arrives
    if (near_) return kernel_scale_;
    if (std::pow(ratio_, 2 * sites_.basis().order()) < hardly) return 1;
    const Normal& n = sites_.normal(p);
    const std::vector<Point> outline = sites_.tree().outline(q);
    double exact = 0, rule = 0;
    for (std::size_t k = 0; k < n_; ++k) {
        exact += sites_.weight(p, k) * point_to_polygon(sites_.receiving_node(p, k), n, outline);
        for (std::size_t l = 0; l < n_; ++l) rule += sites_.weight(p, k) * rows_[k][l];
    }
    ++form_factors_;
    return scale_to(exact, rule);
}

/// What the rays have shown becomes bits where it is yes or no, and part of the block where it is in between.
void LinkJudge::hand_over(bool open, Result& out) {
    if (n_ == 1) {
        const double share = open ? 1 : visible_.share(0);
        out.link.factor = static_cast<float>(form_factor_ * share);
        for (double& d : out.departure) d *= share;
        return;
    }
    double share = 1;
    if (!open) {
        share = 0;
        bool partial = false;
        for (std::size_t i = 0; i < n_ * n_; ++i) {
            partial |= visible_.share(i) > 0 && visible_.share(i) < 1;
            share += visible_.share(i) / static_cast<double>(n_ * n_);
        }
        if (tolerance_.fractional) {
            visible_.set_all(share);
            partial = share > 0 && share < 1;
        }
        if (partial && !keeps_block_) {
            const double scale = near_ ? 1 : scale_of_rule(out.link.receiver, out.link.source);
            for (Row& row : rows_)
                for (double& K : row) K *= scale;
            set_block();
            keeps_block_ = true;
        }
        if (keeps_block_)
            for (std::size_t i = 0; i < n_ * n_; ++i) block_[i] *= static_cast<float>(visible_.share(i));
    }
    for (double& d : out.departure) d *= share;
    if (!open) {
        for (std::size_t k = 0; k < n_; ++k) out.variance[k] = std::pow(node_light_[k], 2) * visible_.variance(k);
        for (std::size_t k = 0; k < n_; ++k)
            for (std::size_t l = 0; l < n_; ++l)
                out.shadowed[k] += rows_[k][l] * visible_.share(k * n_ + l) * source_light_[l];
    }
    out.near = keeps_block_;
    if (!keeps_block_) out.link.set_far(static_cast<float>(scale_of_rule(out.link.receiver, out.link.source)));
    for (std::size_t i = 0; i < n_ * n_; ++i)
        if (open || keeps_block_ || visible_.share(i) > 0) out.link.set(i);
}

}  // namespace exitance
