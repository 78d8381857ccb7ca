#include "exitance/lab/local_passes/local_passes.hpp"

#include <algorithm>
#include <atomic>
#include <memory>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/discontinuity/shadow_class.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {
namespace {

/// Triangulates a region along leaves' edges and curves.
LabelledTriangles triangles_of(const LineHierarchy& h, RegionId region, const std::vector<std::uint32_t>& leaves,
                               double tolerance) {
    const ReceiverCurves& receiver = h.receiver(region);
    std::vector<FlatCurve> lines = receiver.curves;
    for (const std::uint32_t leaf : leaves) {
        const std::vector<Vec2>& outline = h.tree().nodes()[leaf].outline;
        for (std::size_t i = 0; i < outline.size(); ++i) {
            FlatCurve edge;
            edge.a = outline[i], edge.b = outline[(i + 1) % outline.size()], edge.order = CurveOrder::none;
            lines.push_back(edge);
        }
    }
    const ArrangedCurves arranged = arranged_curves(std::move(lines), receiver.loops, tolerance);
    std::vector<LabelledSegment> segments;
    for (const FlatCurve& c : arranged.curves) segments.push_back({c.a, c.b, static_cast<std::uint8_t>(c.order)});
    LabelledTriangles out = labelled_triangles(arranged.loops, segments);
    if (out.corners.empty()) out = labelled_triangles(receiver.loops, {});
    return out;
}

/// A node of the mesh, and the leaves around it.
struct Site {
    std::uint32_t node = BisectionMesh::none, leaf = LineTree::none;
    std::vector<std::uint32_t> around;
};

class Evaluator {
  public:
    Evaluator(const LineHierarchy& h, LocalPassRule rule) : h_(h), rule_(rule) {}

    Spectrum at(const Point& x, const Site& site, std::uint64_t key, LocalPassWork& work,
                DirectLight::Workspace& workspace) {
        const RegionId region = h_.tree().nodes()[site.leaf].region;
        const Normal& n = h_.normal(site.leaf);
        if (h_.stage().occluders.is_covered(x, n, region)) return {};
        if (rule_ == LocalPassRule::a) {
            Spectrum sum;
            for (const std::uint32_t leaf : site.around) sum += h_.irradiance(leaf);
            return 1 / static_cast<double>(site.around.size()) * sum;
        }
        Spectrum out;
        if (rule_ == LocalPassRule::e) ++work.exact, out = h_.stage().direct.irradiance(x, n, region, workspace);
        for (std::uint32_t p = site.leaf; p != LineTree::none; p = h_.tree().nodes()[p].parent)
            for (const LineHierarchy::Link& link : h_.links_of(p)) out += through(link, x, n, region, key, work);
        return out;
    }

  private:
    Spectrum through(const LineHierarchy::Link& link, const Point& x, const Normal& n, RegionId region,
                     std::uint64_t key, LocalPassWork& work) {
        const bool is_recomputed =
            rule_ == LocalPassRule::c || (rule_ == LocalPassRule::d && h_.is_primary(link.source));
        const Spectrum b = rule_ == LocalPassRule::e ? h_.reflected(link.source) : h_.sent(link.source);
        if (!(max(b) > 0) || (!is_recomputed && link.visible == 0)) return {};
        ++work.form_factors;
        const double F = point_to_polygon(x, n, h_.corners(link.source));
        if (!(F > 0)) return {};
        return F * (is_recomputed ? visible(link, x, n, region, key, work) : static_cast<double>(link.visible)) * b;
    }

    double visible(const LineHierarchy::Link& link, const Point& x, const Normal& n, RegionId region, std::uint64_t key,
                   LocalPassWork& work) {
        h_.points_on(link.source, hash(key, link.source), h_.options().rays, ends_);
        const Normal& facing = h_.normal(link.source);
        std::erase_if(ends_, [&](const Point& y) { return dot(n, y - x) <= 0 || dot(facing, y - x) >= 0; });
        if (ends_.empty()) return 0;
        starts_.assign(ends_.size(), x);
        if (blocked_.size() < ends_.size()) blocked_.resize(ends_.size());
        const std::unique_ptr<bool[]> blocked(new bool[ends_.size()]);
        work.rays += ends_.size();
        h_.stage().tracer.occluded(starts_, ends_, region, h_.tree().nodes()[link.source].region,
                                   std::span(blocked.get(), ends_.size()));
        const auto hidden = std::count(blocked.get(), blocked.get() + ends_.size(), true);
        return 1 - static_cast<double>(hidden) / static_cast<double>(ends_.size());
    }

    const LineHierarchy& h_;
    LocalPassRule rule_;
    std::vector<Point> starts_, ends_;
    std::vector<char> blocked_;
};

/// Converts the mesh to six-node triangles without values, and fills `sites`, one per node.
SixNodeMesh take_mesh(const LineHierarchy& h, const BisectionMesh& mesh, const std::vector<RegionId>& region_of,
                      std::vector<Site>& sites) {
    SixNodeMesh out;
    std::vector<std::uint32_t> number(mesh.nodes().size(), BisectionMesh::none);
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
        const BisectionMesh::Triangle& triangle = mesh.triangles()[t];
        const std::uint32_t leaf = h.leaf_at(region_of[t], mesh.centre(t));
        if (leaf == LineTree::none) continue;
        std::array<std::uint32_t, 6> nodes;
        for (std::size_t k = 0; k < 6; ++k) {
            const std::uint32_t node = k < 3 ? triangle.corner[k] : triangle.middle[k - 3];
            if (number[node] == BisectionMesh::none) {
                number[node] = static_cast<std::uint32_t>(out.points.size());
                out.points.push_back(mesh.nodes()[node].at);
                sites.push_back({.node = node, .leaf = leaf, .around = {}});
            }
            nodes[k] = number[node];
            Site& site = sites[number[node]];
            if (mesh.nodes()[node].face == t) site.leaf = leaf;
            if (std::find(site.around.begin(), site.around.end(), leaf) == site.around.end())
                site.around.push_back(leaf);
        }
        out.nodes.push_back(nodes);
        out.region.push_back(region_of[t]);
        out.edge_order.push_back(triangle.order);
    }
    return out;
}

/// Classes of all triangles, by the view from their centres.
std::vector<ShadowClass> shadow_classes(const LineHierarchy& h, const SixNodeMesh& mesh) {
    std::vector<ShadowClass> out(mesh.size());
    const Stage& stage = h.stage();
    parallel_ranges(mesh.size(), 64, [&](std::size_t first, std::size_t last) {
        DirectLight::Workspace workspace;
        for (std::size_t i = first; i < last; ++i) {
            const auto t = static_cast<std::uint32_t>(i);
            const RegionId r = mesh.region[t];
            const Point x = mesh.centre(t);
            const bool is_covered = stage.occluders.is_covered(x, stage.scene.regions()[r].plane.n, r);
            out[t] = is_covered ? ShadowClass::umbra : shadow_class_at(stage.direct, h.receiver(r).light, x, workspace);
        }
    });
    return out;
}

}  // namespace

SixNodeMesh run_local_pass(const LineHierarchy& h, LocalPassRule rule, LocalPassWork& work, const StopRequest& stop) {
    constexpr double nearness = 2e-8, nudge = 1e-6;  // shares of the scene's size, derived from rounding
    const Stage& stage = h.stage();
    const std::size_t regions = stage.scene.regions().size();
    std::vector<std::vector<std::uint32_t>> leaves(regions);
    for (std::uint32_t n = 0; n < h.tree().size(); ++n)
        if (h.tree().nodes()[n].is_leaf()) leaves[h.tree().nodes()[n].region.value].push_back(n);
    std::vector<LabelledTriangles> triangles(regions);
    parallel_for(regions, 1, [&](std::size_t r) {
        if (!leaves[r].empty())
            triangles[r] =
                triangles_of(h, RegionId(static_cast<std::uint32_t>(r)), leaves[r], nearness * stage.scene.size());
    });
    BisectionMesh mesh(nudge * stage.scene.size());
    std::vector<RegionId> region_of;
    for (const RegionId r : stage.scene.regions().ids()) {
        mesh.add(triangles[r.value], h.receiver(r).frame);
        region_of.resize(mesh.triangles().size(), r);
    }
    std::vector<Site> sites;
    SixNodeMesh out = take_mesh(h, mesh, region_of, sites);
    out.shadow = shadow_classes(h, out);
    out.values.resize(out.points.size());
    std::atomic<std::size_t> form_factors = 0, rays = 0, exact = 0;
    parallel_ranges(sites.size(), 32, [&](std::size_t first, std::size_t last) {
        Evaluator evaluator(h, rule);
        DirectLight::Workspace workspace;
        LocalPassWork own;
        for (std::size_t i = first; i < last && !stop.requested(); ++i) {
            const std::uint64_t key = hash(h.options().seed, static_cast<std::uint64_t>(Stream::gather), i);
            const Spectrum E = evaluator.at(mesh.nodes()[sites[i].node].seen_from, sites[i], key, own, workspace);
            for (std::size_t k = 0; k < bands; ++k) out.values[i][k] = static_cast<float>(E[k]);
        }
        form_factors += own.form_factors, rays += own.rays, exact += own.exact;
    });
    for (const RegionId r : stage.scene.regions().ids()) {
        const ReceiverCurves& receiver = h.receiver(r);
        for (const FlatCurve& c : receiver.curves)
            out.curves.push_back({r, receiver.frame.at(c.a), receiver.frame.at(c.b), c.order, c.cause, c.source});
    }
    work = {sites.size(), form_factors, rays, exact, out.empty() ? 0 : out.mean_radius_ratio()};
    return out;
}

}  // namespace exitance
