#include "exitance/lab/local_passes/line_hierarchy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

constexpr double nearness = 2e-8;  // share of the scene's size, due to rounding, as for arranged curves

std::vector<Vec2> flat_outline(const Patch& patch, const PlaneFrame& frame) {
    std::vector<Vec2> out;
    for (int i = 0; i < patch.corner_count(); ++i) out.push_back(frame.flat(patch.corner(i)));
    return out;
}

}  // namespace

LineHierarchy::LineHierarchy(const Stage& stage, const LineHierarchyOptions& options)
    : stage_(stage), options_(options), tree_(nearness * stage.scene.size()) {
    double emitted = 0, area = 0;
    Spectrum flux;
    for (const RegionId r : stage.scene.regions().ids()) {
        flux += stage.scene.regions()[r].area * stage.scene.material(r).exitance;
        area += stage.scene.regions()[r].area;
    }
    emitted = max(flux);
    threshold_ = options.threshold * emitted;
    min_area_ = options.min_area * area;
}

const Normal& LineHierarchy::normal(std::uint32_t node) const {
    return stage_.scene.regions()[tree_.nodes()[node].region].plane.n;
}

bool LineHierarchy::is_primary(std::uint32_t node) const {
    return stage_.scene.material(tree_.nodes()[node].region).emits();
}

Spectrum LineHierarchy::sent(std::uint32_t node) const {
    return options_.layers ? b_[node] : stage_.scene.material(tree_.nodes()[node].region).exitance + b_[node];
}

std::size_t LineHierarchy::leaf_count() const {
    return static_cast<std::size_t>(
        std::count_if(tree_.nodes().begin(), tree_.nodes().end(), [](const auto& n) { return n.is_leaf(); }));
}

std::uint32_t LineHierarchy::leaf_at(RegionId region, const Point& p) const {
    const Vec2 at = receivers_[region.value].frame.flat(p);
    std::uint32_t best = LineTree::none;
    double inside = -HUGE_VAL;
    for (const std::uint32_t root : roots_[region.value]) {
        const std::vector<Vec2>& outline = tree_.nodes()[root].outline;
        double least = HUGE_VAL;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const Vec2 e = outline[(i + 1) % outline.size()] - outline[i];
            least = std::min(least, cross(e, at - outline[i]) / std::sqrt(dot(e, e)));
        }
        if (least > inside) inside = least, best = root;
    }
    return best == LineTree::none ? best : tree_.leaf_under(best, at);
}

void LineHierarchy::add_corners() {
    if (first_corner_.empty()) first_corner_.push_back(0);
    for (std::size_t n = first_corner_.size() - 1; n < tree_.size(); ++n) {
        const PlaneFrame& frame = receivers_[tree_.nodes()[n].region.value].frame;
        for (const Vec2 p : tree_.nodes()[n].outline) corners_.push_back(frame.at(p));
        first_corner_.push_back(corners_.size());
    }
    whole_.resize(tree_.size(), 0);
}

void LineHierarchy::points_on(std::uint32_t node, std::uint64_t key, std::size_t count, std::vector<Point>& out) const {
    const LineTree::Node& n = tree_.nodes()[node];
    const PlaneFrame& frame = receivers_[n.region.value].frame;
    const std::vector<FanTriangle> fan = fan_of(n.outline);
    const ScrambledSobol random(key);
    out.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        double at = n.area * random(i, 2);
        std::size_t t = 0;
        while (t + 1 < fan.size() && at > fan[t].area) at -= fan[t++].area;
        const Vec2 st = uniform_in_shape(Patch::Shape::triangle, random(i, 0), random(i, 1));
        out.push_back(frame.at(fan[t].a + st.x * (fan[t].b - fan[t].a) + st.y * (fan[t].c - fan[t].a)));
    }
}

/// Mean form factor over the receiver: one point in each of its triangles, but many near the source, where it varies
/// strongly.
double LineHierarchy::form_factor(std::uint32_t p, std::uint32_t q) const {
    const LineTree::Node& node = tree_.nodes()[p];
    const PlaneFrame& frame = receivers_[node.region.value].frame;
    const auto span_of = [&](std::uint32_t n, const Point& from) {
        double out = 0;
        for (const Point& c : corners(n)) out = std::max(out, norm(c - from));
        return out;
    };
    constexpr double near_distance = 3;  // radii of the receiver from the border of the source
    constexpr int parts = 4;             // parts that an edge of the source is divided into
    const Point x = frame.at(node.centre),
                y = receivers_[tree_.nodes()[q].region.value].frame.at(tree_.nodes()[q].centre);
    const int n = norm(y - x) < near_distance * span_of(p, x) + span_of(q, y) ? parts : 1;
    double sum = 0;
    for (const FanTriangle& t : fan_of(node.outline))
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < 2 * (n - i) - 1; ++k) {
                // Centres of the n^2 equal triangles: upright ones (even k) and those between them.
                const double third = k % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
                const double u = (i + third) / n, v = (k / 2 + third) / n;
                const Vec2 at = t.a + u * (t.b - t.a) + v * (t.c - t.a);
                sum += t.area / (n * n) * point_to_polygon(frame.at(at), normal(p), corners(q));
            }
    return sum / node.area;
}

double LineHierarchy::visibility(std::uint32_t p, std::uint32_t q) const {
    const std::uint64_t purpose = hash(options_.seed, static_cast<std::uint64_t>(Stream::visibility), p, q);
    std::vector<Point> from, to, starts, ends;
    points_on(p, hash(purpose, 1u), options_.rays, from);
    points_on(q, hash(purpose, 2u), options_.rays, to);
    for (std::size_t i = 0; i < from.size(); ++i) {
        const Vec3 way = to[i] - from[i];
        if (dot(normal(p), way) > 0 && dot(normal(q), way) < 0) starts.push_back(from[i]), ends.push_back(to[i]);
    }
    if (starts.empty()) return 0;
    const std::unique_ptr<bool[]> blocked(new bool[starts.size()]);
    stage_.tracer.occluded(starts, ends, tree_.nodes()[p].region, tree_.nodes()[q].region,
                           std::span(blocked.get(), starts.size()));
    const auto hidden = std::count(blocked.get(), blocked.get() + starts.size(), true);
    return 1 - static_cast<double>(hidden) / static_cast<double>(starts.size());
}

bool LineHierarchy::can_cut(std::uint32_t node) const {
    const LineTree::Node& n = tree_.nodes()[node];
    return !n.is_leaf() || (n.area > 2 * min_area_ && !whole_[node]);
}

LineHierarchy::Judged LineHierarchy::judge(std::uint32_t p, std::uint32_t q) const {
    Judged out{.link = {p, q}};
    const double slack = nearness * stage_.scene.size();
    const Plane &below = stage_.scene.regions()[tree_.nodes()[p].region].plane,
                &beside = stage_.scene.regions()[tree_.nodes()[q].region].plane;
    const auto rises = [&](const Plane& plane, std::span<const Point> outline) {
        return std::any_of(outline.begin(), outline.end(),
                           [&](const Point& c) { return plane.signed_distance(c) > slack; });
    };
    const bool dark = max(stage_.scene.material(tree_.nodes()[p].region).reflectance) == 0 && options_.layers;
    if (dark || !rises(below, corners(q)) || !rises(beside, corners(p))) return out.cut = 3, out;
    if (brightest_[q] <= darkest_) return out.cut = 4, out;
    const double F = form_factor(p, q);
    const bool both_whole = !can_cut(p) && !can_cut(q);
    const double carried = max(sent(q)) * F * tree_.nodes()[p].area;
    constexpr double of_partial = 1.0 / 3, of_hidden = 8;  // lower epsilon of [Wallach & Hanrahan]; rays may miss slits
    double V = visibility(p, q);
    const double allowed = (V >= 1 ? 1 : V > 0 ? of_partial : of_hidden) * threshold_;
    if (carried > allowed && !both_whole) {
        const bool receiver = tree_.nodes()[p].area >= tree_.nodes()[q].area;
        out.cut = (receiver ? can_cut(p) : !can_cut(q)) ? 1 : 2;
        return out;
    }
    out.link.factor = static_cast<float>(F), out.link.visible = static_cast<float>(V);
    return out;
}

bool LineHierarchy::cut(std::uint32_t node) {
    if (!tree_.nodes()[node].is_leaf()) return true;
    if (!tree_.split(node)) return whole_[node] = 1, false;
    add_corners();
    const std::uint32_t child = tree_.nodes()[node].first_child;
    for (std::uint32_t c = child; c < child + 2; ++c) {
        E_.push_back(E_[node]), b_.push_back(b_[node]), brightest_.push_back(brightest_[node]);
        if (!direct_.empty()) direct_.push_back(direct_[node]);  // otherwise direct light has not been found yet
    }
    return true;
}

/// Links these pairs, or parts of them. Returns false after a request to stop.
bool LineHierarchy::link(Pairs pending, const StopRequest& stop) {
    while (!pending.empty() && !stop.requested()) {
        std::vector<Judged> judged(pending.size());
        parallel_for(pending.size(), 32,
                     [&](std::size_t i) { judged[i] = judge(pending[i].first, pending[i].second); });
        Pairs next;
        for (const Judged& j : judged) {
            const auto [p, q] = std::pair(j.link.receiver, j.link.source);
            if (j.cut < 3) ++form_factors_, rays_ += options_.rays;
            if (j.cut == 0 && j.link.factor > 0) links_.push_back(j.link);
            if (j.cut == 4) dark_.emplace_back(p, q);
            if (j.cut != 1 && j.cut != 2) continue;
            const std::uint32_t node = j.cut == 1 ? p : q;
            if (!cut(node)) {
                next.emplace_back(p, q);
                continue;
            }
            const std::uint32_t child = tree_.nodes()[node].first_child;
            for (std::uint32_t c = child; c < child + 2; ++c) next.emplace_back(j.cut == 1 ? c : p, j.cut == 2 ? c : q);
        }
        pending = std::move(next);
    }
    return pending.empty();
}

/// Splits links that carry too much light and tests pairs again that were too dark.
bool LineHierarchy::refine(const StopRequest& stop) {
    Pairs pending = std::exchange(dark_, {});
    std::vector<Link> kept;
    for (const Link& l : links_) {
        constexpr double of_partial = 1.0 / 3;
        const double carried = max(sent(l.source)) * l.factor * tree_.nodes()[l.receiver].area;
        const double allowed = (l.visible < 1 ? of_partial : 1) * threshold_;
        const bool open = can_cut(l.receiver) || can_cut(l.source);
        if (carried > allowed && open && l.visible > 0)
            pending.emplace_back(l.receiver, l.source);
        else
            kept.push_back(l);
    }
    links_ = std::move(kept);
    constexpr std::size_t slice = 500'000;  // pairs at a time, to limit memory
    bool whole = true;
    for (std::size_t first = 0; first < pending.size() && whole; first += slice) {
        const std::size_t count = std::min(slice, pending.size() - first);
        whole = link({pending.begin() + static_cast<std::ptrdiff_t>(first),
                      pending.begin() + static_cast<std::ptrdiff_t>(first + count)},
                     stop);
    }
    sort_links();
    return whole;
}

void LineHierarchy::sort_links() {
    std::sort(links_.begin(), links_.end(), [](const Link& a, const Link& b) {
        return a.receiver != b.receiver ? a.receiver < b.receiver : a.source < b.source;
    });
    first_link_.assign(tree_.size() + 1, 0);
    for (const Link& l : links_) ++first_link_[l.receiver + 1];
    std::partial_sum(first_link_.begin(), first_link_.end(), first_link_.begin());
}

void LineHierarchy::pull() {
    for (std::size_t n = tree_.size(); n-- > 0;) {
        const LineTree::Node& node = tree_.nodes()[n];
        if (node.is_leaf()) {
            const Material& m = stage_.scene.material(node.region);
            b_[n] = m.reflectance * E_[n];
            brightest_[n] = max(sent(static_cast<std::uint32_t>(n)));
            continue;
        }
        E_[n] = b_[n] = Spectrum();
        brightest_[n] = 0;
        for (std::uint32_t c = node.first_child; c < node.first_child + 2; ++c) {
            const double share = tree_.nodes()[c].area / node.area;
            E_[n] += share * E_[c], b_[n] += share * b_[c];
            brightest_[n] = std::max(brightest_[n], brightest_[c]);
        }
    }
}

/// Gathers over the links, pushes to the leaves and pulls, until the change is small.
void LineHierarchy::relax(const StopRequest& stop) {
    constexpr int max_iterations = 200;
    const double max_change = calibrated::changed_light_settled;
    std::vector<Spectrum> arriving(tree_.size());
    for (int i = 0; i < max_iterations && !stop.requested(); ++i, ++iterations_) {
        parallel_for(tree_.size(), 256, [&](std::size_t n) {
            Spectrum sum;
            for (const Link& l : links_of(static_cast<std::uint32_t>(n)))
                sum += static_cast<double>(l.factor * l.visible) * sent(l.source);
            arriving[n] = sum;
        });
        double before = 0, moved = 0;
        for (std::size_t n = 0; n < tree_.size(); ++n) {  // parents come first
            const LineTree::Node& node = tree_.nodes()[n];
            if (node.parent != LineTree::none) arriving[n] += arriving[node.parent];
            if (!node.is_leaf()) continue;
            const Spectrum E = arriving[n] + (options_.layers ? direct_[n] : Spectrum());
            const Spectrum& rho = stage_.scene.material(node.region).reflectance;
            before += node.area * mean(rho * E), moved += node.area * std::abs(mean(rho * (E - E_[n])));
            E_[n] = E;
        }
        pull();
        change_ = before > 0 ? moved / before : 0;
        if (change_ < max_change) break;
    }
}

/// Splits leaves on which exact direct light varies by more than a link may carry; then stores its means.
void LineHierarchy::cut_by_direct_light(const StopRequest& stop) {
    direct_.resize(tree_.size());
    std::vector<std::uint32_t> active(tree_.size());
    std::iota(active.begin(), active.end(), 0u);
    while (!active.empty() && !stop.requested()) {
        std::vector<std::uint8_t> is_varying(active.size(), 0);
        parallel_ranges(active.size(), 8, [&](std::size_t first, std::size_t last) {
            DirectLight::Workspace workspace;
            ReceiverLight light;
            for (std::size_t i = first; i < last; ++i) {
                const LineTree::Node& node = tree_.nodes()[active[i]];
                const PlaneFrame& frame = receivers_[node.region.value].frame;
                const Normal& n = normal(active[i]);
                stage_.direct.prepare(corners(active[i]), n, node.region, light, workspace);
                Spectrum sum;
                double lo = HUGE_VAL, hi = -HUGE_VAL;
                const auto look = [&](Vec2 p, double weight) {
                    const Point x = frame.at(p);
                    Spectrum E;
                    if (!light.is_dark() && !stage_.occluders.is_covered(x, n, node.region))
                        E = stage_.direct.irradiance(light, x, workspace);
                    sum += weight * E;
                    lo = std::min(lo, max(E)), hi = std::max(hi, max(E));
                };
                // Points a sixth of the way in from the edges: exact for quadratic polynomials.
                for (const FanTriangle& t : fan_of(node.outline))
                    for (const auto& [a, b, c] : {std::tuple(t.a, t.b, t.c), {t.b, t.c, t.a}, {t.c, t.a, t.b}})
                        look(1.0 / 6 * (4 * a + b + c), t.area / (3 * node.area));
                direct_[active[i]] = sum;
                const double rho = max(stage_.scene.material(node.region).reflectance);
                is_varying[i] = rho * (hi - lo) * node.area > threshold_ && can_cut(active[i]);
            }
        });
        std::vector<std::uint32_t> next;
        for (std::size_t i = 0; i < active.size(); ++i)
            if (is_varying[i] && cut(active[i]))
                for (std::uint32_t c = 0; c < 2; ++c) next.push_back(tree_.nodes()[active[i]].first_child + c);
        active = std::move(next);
    }
    double reflected = 0, area = 0;
    for (std::size_t n = 0; n < tree_.size(); ++n) {
        const LineTree::Node& node = tree_.nodes()[n];
        if (!node.is_leaf()) continue;
        E_[n] = direct_[n];
        area += node.area;
        reflected += node.area * mean(stage_.scene.material(node.region).reflectance * direct_[n]);
    }
    darkest_ = area > 0 ? options_.dark * reflected / area : 0;
}

bool LineHierarchy::solve(Progress& progress, const StopRequest& stop) {
    progress.phase("shadow lines");
    const BlockerEdges edges(stage_.occluders);
    const CurveFinder finder(stage_, edges, {.stop = &stop});
    const std::size_t regions = stage_.scene.regions().size();
    std::vector<std::optional<ReceiverCurves>> found(regions);
    parallel_for(regions, 1, [&](std::size_t r) {
        const RegionId region(static_cast<std::uint32_t>(r));
        found[r].emplace(finder.find(region));
        finder.add_contacts_in_the_dark(region, *found[r]);
    });
    for (auto& f : found) receivers_.push_back(std::move(*f));
    roots_.resize(regions);
    for (const Piece& piece : stage_.pieces) {
        if (stage_.is_unlit(piece.region)) continue;
        const ReceiverCurves& receiver = receivers_[piece.region.value];
        roots_[piece.region.value].push_back(
            tree_.add_root(piece.region, flat_outline(piece.patch, receiver.frame), receiver.curves));
    }
    if (stop.requested()) return false;
    E_.resize(tree_.size()), b_.resize(tree_.size()), brightest_.resize(tree_.size());
    add_corners();
    progress.phase("link");
    if (options_.layers) cut_by_direct_light(stop);
    pull();
    const auto roots = static_cast<std::uint32_t>(stage_.pieces.size());
    for (std::uint32_t p = 0; p < tree_.size() && p < roots; ++p)
        for (std::uint32_t q = 0; q < tree_.size() && q < roots; ++q)
            if (p != q && tree_.nodes()[p].parent == LineTree::none && tree_.nodes()[q].parent == LineTree::none)
                dark_.emplace_back(p, q);
    for (int round = 0; round < options_.rounds; ++round) {
        const std::size_t before = links_.size();
        if (!refine(stop)) return false;
        relax(stop);
        progress.note(fmt::format("round {}: {} links, {} leaves", round + 1, links_.size(), leaf_count()));
        if (links_.size() == before) break;
    }
    return !stop.requested();
}

}  // namespace exitance
