#include "exitance/methods/light/secondary_light.hpp"

#include <algorithm>
#include <array>
#include <atomic>

#include "exitance/base/parallel.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/basis/element_fit.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/solution/continuous.hpp"

namespace exitance {
namespace {

/// Calls visit(s, t) for the centres of 3 x 3 squares.
template <class Visit>
void visit_places(const Visit& visit) {
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) visit((i + 0.5) / 3, (k + 0.5) / 3);
}
constexpr std::size_t places = 9;

/// Reflected radiosity of surfaces, W/m^2.
class Reflected {
  public:
    Reflected(const Stage& stage, const Solution& solution, const ElementLocator& locator)
        : stage_(stage), solution_(solution), locator_(locator) {}

    Spectrum at(RegionId r, const Point& p, DirectLight::Workspace& workspace) const {
        const Normal& n = stage_.scene.regions()[r].plane.n;
        if (stage_.occluders.is_covered(p, n, r)) return {};
        const Spectrum light = solution_.indirect.at(locator_.find(r, p)) +
                               (Spectrum(1.0) - solution_.direct_share) * stage_.direct.irradiance(p, n, r, workspace);
        return stage_.scene.material(r).reflectance * light;
    }

  private:
    const Stage& stage_;
    const Solution& solution_;
    const ElementLocator& locator_;
};

/// Returns regions in descending order of their reflected power (W, mean of the bands).
std::vector<RegionId> brightest_regions(const Stage& stage, const Reflected& reflected, const SecondarySources& asked,
                                        const StopRequest& stop) {
    const std::size_t pieces = stage.pieces.size();
    std::vector<double> power(pieces);
    parallel_ranges(pieces, 64, [&](std::size_t first, std::size_t last) {
        DirectLight::Workspace workspace;
        for (std::size_t i = first; i < last && !stop.requested(); ++i) {
            const Piece& piece = stage.pieces[i];
            visit_places([&](double s, double t) {
                const Point p = piece.patch.at(uniform_in_shape(piece.patch.shape, s, t));
                power[i] += piece.patch.area() / places * mean(reflected.at(piece.region, p, workspace));
            });
        }
    });
    std::vector<double> of_region(stage.scene.regions().size());
    for (std::size_t i = 0; i < pieces; ++i) of_region[stage.pieces[i].region.value] += power[i];
    std::vector<std::uint32_t> order;
    for (std::uint32_t r = 0; r < of_region.size(); ++r)
        if (of_region[r] > 0 && of_region[r] >= asked.power.value_or(0)) order.push_back(r);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return of_region[a] > of_region[b]; });
    if (asked.count && order.size() > *asked.count) order.resize(*asked.count);
    return {order.begin(), order.end()};
}

/// An element that may be divided further.
struct Cuttable {
    ElementId element;
    Spectrum radiosity;
    double difference = 0;  ///< Difference of power, W; 0 if radiosity is uniform enough.
};

Cuttable look_at(const ElementTree& tree, ElementId e, const Reflected& reflected, DirectLight::Workspace& workspace) {
    constexpr double min_variation = 0.5;
    Cuttable out{e, {}, 0};
    double lowest = HUGE_VAL, highest = 0;
    visit_places([&](double s, double t) {
        const Spectrum b = reflected.at(tree.region(e), tree.patch(e).at(tree.uniform(e, s, t)), workspace);
        out.radiosity += 1.0 / places * b;
        lowest = std::min(lowest, mean(b)), highest = std::max(highest, mean(b));
    });
    const bool can_be_cut = !tree.is_leaf(e) || !tree.is_cell(e);
    if (can_be_cut && highest - lowest > min_variation * highest) out.difference = tree.area(e) * (highest - lowest);
    return out;
}

/// Divides a region into parts. `tree`: the elements, to which quarters of leaves are added.
std::vector<SecondarySource::Part> parts_of(ElementTree& tree, std::span<const ElementId> roots, const Normal& n,
                                            const Reflected& reflected, const StopRequest& stop) {
    constexpr std::size_t max_parts = 64;
    DirectLight::Workspace workspace;
    std::vector<Cuttable> elements;
    for (const ElementId e : roots) elements.push_back(look_at(tree, e, reflected, workspace));
    while (elements.size() < max_parts && !stop.requested()) {
        const auto next = std::max_element(elements.begin(), elements.end(), [](const Cuttable& a, const Cuttable& b) {
            return a.difference < b.difference;
        });
        if (next == elements.end() || next->difference == 0) break;
        const ElementId cut = next->element;
        elements.erase(next);
        if (tree.is_leaf(cut)) tree.split(cut, Cut::both);
        for (const ElementId child : tree.children(cut)) elements.push_back(look_at(tree, child, reflected, workspace));
    }
    std::vector<SecondarySource::Part> out;
    for (const Cuttable& e : elements) {
        if (!(max(e.radiosity) > 0)) continue;
        SecondarySource::Part& part = out.emplace_back();
        part.outline = tree.outline(e.element);
        if (dot(area_vector(part.outline), n) < 0) std::reverse(part.outline.begin(), part.outline.end());
        part.radiosity = e.radiosity, part.area = tree.area(e.element);
    }
    return out;
}

}  // namespace

std::vector<SecondarySource> secondary_sources(const Stage& stage, const Solution& solution,
                                               const ElementLocator& locator, const SecondarySources& asked,
                                               const StopRequest& stop) {
    const Reflected reflected(stage, solution, locator);
    ElementTree tree = solution.indirect.tree;
    Field<RegionId, std::vector<ElementId>> roots(stage.scene.regions().size());
    for (const ElementId root : tree.roots()) roots[tree.region(root)].push_back(root);
    std::vector<SecondarySource> out;
    for (const RegionId r : brightest_regions(stage, reflected, asked, stop)) {
        if (stop.requested()) break;
        out.push_back({r, parts_of(tree, roots[r], stage.scene.regions()[r].plane.n, reflected, stop)});
    }
    return out;
}

SecondaryLight::SecondaryLight(const Stage& stage, const ElementFunction& elements, const ElementLocator& locator,
                               std::vector<SecondarySource> sources, const StopRequest& stop)
    : stage_(stage), elements_(elements), locator_(locator), sources_(std::move(sources)) {
    if (!sources_.empty() && stage.scene.panes().empty()) fit_elements(stop);
}

/// Computes H_e: polynomials of the elements of E_e, made continuous like these. A fan of triangles replaces the single
/// element that it was made from.
void SecondaryLight::fit_elements(const StopRequest& stop) {
    ElementFunction fit;
    fit.tree = elements_.tree;
    fit.first_value.resize(fit.tree.size());
    std::vector<ElementId> fitted;
    for (const ElementId e : fit.tree.ids()) {
        const ElementId parent = fit.tree.parent(e);
        const bool in_fan = !parent.is_none() && fit.tree.cut_of(parent) == Cut::fan;
        if (in_fan || !(fit.tree.is_leaf(e) || fit.tree.cut_of(e) == Cut::fan)) continue;
        fitted.push_back(e);
        fit.first_value[e] = static_cast<std::uint32_t>(fit.values.size());
        for (int k = 0; k < fit.tree.patch(e).corner_count(); ++k) fit.add_value({});
    }
    std::atomic<bool> is_whole = true;
    parallel_ranges(fitted.size(), 16, [&](std::size_t first, std::size_t last) {
        Workspace scratch;
        for (std::size_t i = first; i < last && is_whole; ++i) {
            if (stop.requested()) is_whole = false;
            fit_element(fit, fitted[i], scratch);
        }
    });
    if (!is_whole) return;
    fit_ = nearest_continuous(fit, stage_.scene, stage_.contacts, &stop);
    if (!stop.requested()) fit_locator_.emplace(fit_.tree, stage_.scene.regions().size());
}

/// Fits the polynomial at the points at which the local pass gathers.
void SecondaryLight::fit_element(ElementFunction& fit, ElementId e, Workspace& scratch) const {
    const std::vector<WeightedPlace> rule = element_rule(fit.tree, e, RuleOrder::fine);
    std::vector<Spectrum> values;
    for (const WeightedPlace& place : rule)
        values.push_back(hidden(fit.tree.region(e), fit.tree.patch(e).at(place.uv), scratch));
    const ElementFit polynomial(fit.tree, e, rule, values);
    for (int k = 0; k < fit.tree.patch(e).corner_count(); ++k)
        for (std::size_t b = 0; b < bands; ++b)
            fit.values[fit.first_value[e] + static_cast<std::uint32_t>(k)][b] =
                static_cast<float>(polynomial.corner(k)[b]);
}

/// Returns the sum of B F over the source's parts, clipped to a polygon in its plane (corners relative to x).
Spectrum SecondaryLight::light_of(const SecondarySource& source, std::span<const Vec3> polygon, const SurfacePoint& at,
                                  Workspace& scratch) const {
    const Normal& m = stage_.scene.regions()[source.region].plane.n;
    Spectrum out;
    for (const SecondarySource::Part& part : source.parts) {
        scratch.part.assign(polygon.begin(), polygon.end());
        for (std::size_t k = 0; k < part.outline.size() && scratch.part.size() >= 3; ++k) {
            const Vec3 a = part.outline[k] - at.x, b = part.outline[(k + 1) % part.outline.size()] - at.x;
            const Vec3 inward = cross(m, b - a);
            clip(scratch.part, {inward, dot(inward, a)}, scratch.next);
            scratch.part.swap(scratch.next);
        }
        if (scratch.part.size() >= 3) out += std::max(0.0, contour_sum(at.n, scratch.part)) * part.radiosity;
    }
    return out;
}

Spectrum SecondaryLight::hidden(RegionId region, const Point& x, Workspace& scratch) const {
    constexpr double negligible = 1e-12;  // derived from the rounding errors of form factors
    const SurfacePoint at = stage_.direct.receiver(x, stage_.scene.regions()[region].plane.n, region);
    Spectrum out;
    for (const SecondarySource& source : sources_) {
        if (stage_.occluders.is_own(source.region, region)) continue;
        if (stage_.scene.regions()[source.region].plane.signed_distance(at.x) <= stage_.occluders.rounding()) continue;
        for (const PieceId piece : stage_.occluders.pieces(source.region)) {
            scratch.whole.clear();
            for (const Point& p : stage_.occluders.corners(piece)) scratch.whole.push_back(p - at.x);
            const double all = contour_sum(at.n, scratch.whole);
            if (all <= negligible) continue;
            visible_fragments(stage_.occluders, at, piece, {}, scratch.visibility, scratch.fragments);
            double seen = 0;
            for (const std::vector<Vec3>& fragment : scratch.fragments)
                seen += std::max(0.0, contour_sum(at.n, fragment));
            if (all - seen <= negligible) continue;
            out += light_of(source, scratch.whole, at, scratch);
            for (const std::vector<Vec3>& fragment : scratch.fragments) out -= light_of(source, fragment, at, scratch);
        }
    }
    return out;
}

Spectrum SecondaryLight::at(RegionId region, const Point& x) const {
    Spectrum out = elements_.at(locator_.find(region, x));
    if (!fit_locator_) return out;
    thread_local Workspace scratch;
    out -= hidden(region, x, scratch) - fit_.at(fit_locator_->find(region, x));
    for (double& v : out.value) v = std::max(0.0, v);
    return out;
}

}  // namespace exitance
