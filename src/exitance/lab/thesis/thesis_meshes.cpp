#include "exitance/lab/thesis/thesis_studies.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/random.hpp"
#include "exitance/discontinuity/receiver_curves.hpp"
#include "exitance/lab/dm_tree/dm_tree.hpp"
#include "exitance/lab/layers/winged_edge_bytes.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"

namespace exitance {
namespace {

// --------------------------------------------------------------------------------------------- triangulations

using Light = std::function<double(const Point&)>;

/// Distance inside a triangle at which its border is evaluated, as a share of the scene's size.
constexpr double nudge_share = 1e-6;

struct RefinedMesh {
    BisectionMesh mesh;
    std::vector<double> value;  ///< Value at each node; NaN: not evaluated yet.
    double rms = 0, ratio = 0, area = 0;
};

double value_at(RefinedMesh& m, std::uint32_t node, const Light& light) {
    m.value.resize(m.mesh.nodes().size(), NAN);
    if (std::isnan(m.value[node])) m.value[node] = light(m.mesh.nodes()[node].seen_from);
    return m.value[node];
}

double quadratic(RefinedMesh& m, const BisectionMesh::Triangle& t, const std::array<double, 3>& L, const Light& light) {
    const std::array<double, 6> w = six_node_weights({L[1], L[2]});
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
        sum += w[k] * value_at(m, t.corner[k], light) + w[3 + k] * value_at(m, t.middle[k], light);
    return sum;
}

/// Bisects triangles while the error of their quadratic polynomial exceeds `allowed` at one of seven points.
RefinedMesh refine(const LabelledTriangles& triangles, const PlaneFrame& frame, const Light& light, double allowed,
                   double nudge) {
    constexpr std::uint8_t max_depth = 14;
    constexpr std::size_t max_triangles = 200'000;
    RefinedMesh m{BisectionMesh(nudge), {}};
    m.mesh.add(triangles, frame);
    for (std::vector<std::uint32_t> changed = m.mesh.take_changed(); !changed.empty(); changed = m.mesh.take_changed())
        for (std::uint32_t number : changed) {
            const BisectionMesh::Triangle t = m.mesh.triangles()[number];
            if (t.depth >= max_depth || m.mesh.triangles().size() > max_triangles) continue;
            double misfit = 0;
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t end = 0; end < 2; ++end) {
                    std::array<double, 3> L{};
                    L[k] = end == 0 ? 0.75 : 0.25, L[(k + 1) % 3] = 1 - L[k];
                    misfit =
                        std::max(misfit, std::abs(quadratic(m, t, L, light) - value_at(m, t.quarter[k][end], light)));
                }
            std::array<double, 3> L{0.25, 0.25, 0.25};
            L[(t.longest + 2) % 3] = 0.5;
            misfit = std::max(misfit, std::abs(quadratic(m, t, L, light) - value_at(m, t.inner, light)));
            if (misfit > allowed) m.mesh.bisect(number);
        }
    for (std::uint32_t i = 0; i < m.mesh.triangles().size(); ++i) {
        const BisectionMesh::Triangle t = m.mesh.triangles()[i];
        const double area = m.mesh.area(i), third = 1.0 / 3;
        const double off = quadratic(m, t, {third, third, third}, light) - light(m.mesh.centre(i));
        m.rms += area * off * off, m.area += area;
        std::array<Vec2, 3> c;
        for (std::size_t k = 0; k < 3; ++k) c[k] = frame.flat(m.mesh.nodes()[t.corner[k]].at);
        m.ratio += radius_ratio(c[0], c[1], c[2]);
    }
    m.rms = std::sqrt(m.rms / m.area);
    m.ratio /= static_cast<double>(m.mesh.triangles().size());
    return m;
}

struct ChosenReceiver {
    RegionId region;
    std::optional<ReceiverCurves> curves;
    double largest = 0;  ///< Largest light at random points, W/m^2.
};

/// Returns the region of one convex loop with the most curves.
ChosenReceiver choose(const Stage& stage) {
    const BlockerEdges edges(stage.occluders);
    const CurveFinder finder(stage, edges, {});
    ChosenReceiver out;
    for (RegionId r : stage.scene.regions().ids()) {
        const Region& region = stage.scene.regions()[r];
        if (region.loops.size() != 1 || !is_convex(region.loops[0], region.plane.n)) continue;
        ReceiverCurves curves = finder.find(r);
        if (!out.curves || curves.curves.size() > out.curves->curves.size())
            out.region = r, out.curves = std::move(curves);
    }
    if (!out.curves) return out;
    DirectLight::Workspace workspace;
    RandomStream random(1, Stream::mesh);
    const Region& region = stage.scene.regions()[out.region];
    for (int i = 0; i < 1000; ++i) {
        Point p = region.loops[0][0];
        for (const Point& q : region.loops[0]) p += random.uniform() * (q - p);
        out.largest = std::max(out.largest, mean(stage.direct.irradiance(p, region.plane.n, out.region, workspace)));
    }
    return out;
}

LabelledTriangles triangles_of(const ReceiverCurves& receiver, TriangulationScheme scheme, double tolerance,
                               const std::function<bool(const FlatCurve&)>& is_wanted, std::size_t* construction) {
    std::vector<std::uint8_t> labels;
    if (scheme == TriangulationScheme::delaunay) {
        std::vector<LabelledSegment> segments;
        for (const FlatCurve& c : receiver.curves)
            if (is_wanted(c)) segments.push_back({c.a, c.b, static_cast<std::uint8_t>(c.order)});
        return labelled_triangles(receiver.loops, segments);
    }
    DmTree tree(receiver.loops[0], tolerance);
    for (const FlatCurve& c : receiver.curves) {
        if (!is_wanted(c)) continue;
        tree.insert(c.a, c.b, static_cast<std::uint32_t>(labels.size()));
        labels.push_back(static_cast<std::uint8_t>(c.order));
    }
    if (construction) *construction = tree.construction_edges();
    return triangulated(tree, scheme, labels);
}

/// Mean of the bands, W/m^2; 0 if covered by another surface.
double light_at(const Stage& stage, const Point& p, const Normal& n, RegionId r, DirectLight::Workspace& workspace) {
    return stage.occluders.is_covered(p, n, r) ? 0 : mean(stage.direct.irradiance(p, n, r, workspace));
}

void triangulation(const char* name, const Scene& scene, CsvText& out) {
    const Stage stage(scene);
    const ChosenReceiver receiver = choose(stage);
    if (!receiver.curves) return;
    const Normal n = scene.regions()[receiver.region].plane.n;
    DirectLight::Workspace workspace;
    const Light light = [&](const Point& p) { return light_at(stage, p, n, receiver.region, workspace); };
    for (double threshold : {0.1, 0.05, 0.03, 0.02, 0.01, 0.005, 0.003, 0.002})
        for (const auto& [scheme, scheme_name] : triangulation_names) {
            std::size_t construction = 0;
            const LabelledTriangles first = triangles_of(
                *receiver.curves, scheme, 1e-7 * scene.size(), [](const FlatCurve&) { return true; }, &construction);
            const RefinedMesh m =
                refine(first, receiver.curves->frame, light, threshold * receiver.largest, nudge_share * scene.size());
            out.print("%s,%zu,%g,%s,%zu,%zu,%zu,%.4f,%.6f\n", name, receiver.curves->curves.size(), threshold,
                      scheme_name, construction, first.corners.size(), m.mesh.triangles().size(), m.ratio,
                      m.rms / receiver.largest);
        }
}

// ----------------------------------------------------------------------------------------------------- layers

LayerTriangles layer_of(RefinedMesh& m, const PlaneFrame& frame, const Light& light) {
    LayerTriangles out;
    std::map<std::uint32_t, std::uint32_t> number;
    for (const BisectionMesh::Triangle& t : m.mesh.triangles()) {
        auto& c = out.corners.emplace_back();
        auto& middle = out.middles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [at, is_new] = number.try_emplace(t.corner[k], static_cast<std::uint32_t>(out.points.size()));
            if (is_new) {
                out.points.push_back(frame.flat(m.mesh.nodes()[t.corner[k]].at));
                out.values.push_back(value_at(m, t.corner[k], light));
            }
            c[k] = at->second;
            middle[k] = value_at(m, t.middle[k], light);
        }
    }
    return out;
}

/// The largest difference at triangles' centres, relative to the largest light.
double worst(const LayerTriangles& exact, const LightLayer& layer, double largest) {
    double out = 0;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < exact.corners.size(); ++t) {
        if (exact.is_dark(t)) continue;
        const Vec2 middle{1.0 / 3, 1.0 / 3};
        out = std::max(out, std::abs(exact.at(t, middle) - layer.at(kept++, middle)) / largest);
    }
    return out;
}

void layers(const char* name, const Scene& scene, CsvText& out) {
    const Stage stage(scene);
    const ChosenReceiver receiver = choose(stage);
    if (!receiver.curves) return;
    const Normal n = scene.regions()[receiver.region].plane.n;
    const double allowed = 0.01 * receiver.largest;
    DirectLight::Workspace workspace;
    std::vector<LightLayer> parts;
    const auto run = [&](const char* kind, const Light& light, const std::function<bool(const FlatCurve&)>& is_wanted) {
        const LabelledTriangles first =
            triangles_of(*receiver.curves, TriangulationScheme::delaunay, 1e-7 * scene.size(), is_wanted, nullptr);
        RefinedMesh m = refine(first, receiver.curves->frame, light, allowed, nudge_share * scene.size());
        const LayerTriangles all = layer_of(m, receiver.curves->frame, light);
        const LightLayer floats(all, LightLayer::Form::floats), halves(all, LightLayer::Form::halves);
        out.print("%s,%s,%zu,%zu,%zu,%zu,%zu,%.6f,%.2g,%.2g\n", name, kind, all.corners.size(), floats.size(),
                  winged_edge_bytes(all), floats.memory_bytes(), halves.memory_bytes(), m.rms / receiver.largest,
                  worst(all, floats, receiver.largest), worst(all, halves, receiver.largest));
        parts.push_back(halves);
    };
    const Light together = [&](const Point& p) { return light_at(stage, p, n, receiver.region, workspace); };
    run("merged", together, [](const FlatCurve&) { return true; });
    parts.clear();
    for (const DirectLight::Emitter& emitter : stage.direct.emitters())
        run(
            "layer",
            [&](const Point& p) {
                if (stage.occluders.is_covered(p, n, receiver.region)) return 0.0;
                return mean(emitter.exitance) * stage.direct.form_factor({p, n, receiver.region}, emitter, workspace);
            },
            [&](const FlatCurve& c) { return c.cause == CurveCause::contact || c.source == emitter.region; });
    for (LightLayer& part : parts) part.make_grid();
    RandomStream random(2, Stream::mesh);
    const auto& loop = scene.regions()[receiver.region].loops[0];
    double off = 0;
    constexpr int places = 5000;
    for (int i = 0; i < places; ++i) {
        const double s = random.uniform(), t = random.uniform();
        const Point p = loop[0] + s * (loop[1] - loop[0]) + t * (1 - s) * (loop[2] - loop[0]);
        double sum = 0;
        for (const LightLayer& part : parts) sum += part.at(receiver.curves->frame.flat(p));
        off += (sum - together(p)) * (sum - together(p));
    }
    out.print("%s,sum of %zu layers,,,,,,%.6f,,\n", name, parts.size(), std::sqrt(off / places) / receiver.largest);
}

// ---------------------------------------------------------------------------------------------------- premesh

/// Faces and construction edges of a DM-tree by the insertion order of its curves: as found; the longest first, as an
/// approximation of penumbra outlines first; after a grid of cells.
void premesh(const char* name, const Scene& scene, CsvText& out) {
    const Stage stage(scene);
    const ChosenReceiver receiver = choose(stage);
    if (!receiver.curves) return;
    std::vector<FlatCurve> longest = receiver.curves->curves;
    std::stable_sort(longest.begin(), longest.end(), [](const FlatCurve& a, const FlatCurve& b) {
        return dot(a.b - a.a, a.b - a.a) > dot(b.b - b.a, b.b - b.a);
    });
    const auto run = [&](const char* order, std::span<const FlatCurve> curves, std::size_t grid) {
        DmTree tree(receiver.curves->loops[0], 1e-7 * scene.size());
        if (grid > 0) tree.insert_grid(grid);
        std::vector<std::uint8_t> labels;
        for (const FlatCurve& c : curves) {
            tree.insert(c.a, c.b, static_cast<std::uint32_t>(labels.size()));
            labels.push_back(static_cast<std::uint8_t>(c.order));
        }
        const LabelledTriangles t = triangulated(tree, TriangulationScheme::shortest, labels);
        double ratio = 0;
        for (const auto& c : t.corners) ratio += radius_ratio(t.points[c[0]], t.points[c[1]], t.points[c[2]]);
        out.print("%s,%zu,%s,%zu,%zu,%zu,%.4f,%zu\n", name, curves.size(), order, tree.mesh().faces().size(),
                  tree.construction_edges(), t.corners.size(), ratio / static_cast<double>(t.corners.size()),
                  tree.memory_bytes());
    };
    run("found", receiver.curves->curves, 0);
    run("longest first", longest, 0);
    run("grid 4", receiver.curves->curves, 4);
    run("grid 16", receiver.curves->curves, 16);
}

}  // namespace

std::span<const SceneStudy> thesis_mesh_studies() {
    static constexpr SceneStudy studies[] = {
        {"triangulation", "scene,curves,threshold,scheme,construction_edges,first_triangles,triangles,radius_ratio,rms",
         triangulation},
        {"premesh", "scene,curves,order,faces,construction_edges,triangles,radius_ratio,tree_bytes", premesh},
        {"layers", "scene,kind,triangles,kept,winged_bytes,float_bytes,half_bytes,rms,float_worst,half_worst", layers},
    };
    return studies;
}

}  // namespace exitance
