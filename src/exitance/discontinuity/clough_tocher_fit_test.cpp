#include "exitance/discontinuity/clough_tocher_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "exitance/base/random.hpp"
#include "exitance/scene/scene.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

using Function = std::function<double(const Point&)>;
constexpr double rounding_of_floats = 1e-6;

/// A square of 1 m, cut by a line of a given order and by a D2 line, and bisected randomly into triangles.
struct Sheet {
    BisectionMesh mesh{1e-9};
    std::vector<Spectrum> values;
    SixNodeMesh elements;

    Sheet(CurveOrder line, int rounds, const Function& f) {
        const std::vector<std::vector<Vec2>> border{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        const std::vector<LabelledSegment> lines{{{0.4, 0}, {0.55, 1}, static_cast<std::uint8_t>(line)},
                                                 {{0, 0.3}, {1, 0.45}, static_cast<std::uint8_t>(CurveOrder::d2)}};
        mesh.add(labelled_triangles(border, lines), PlaneFrame({0, 0, 0}, {0, 0, 1}));
        RandomStream random(3, Stream::mesh);
        for (int round = 0; round < rounds; ++round) {
            const auto count = static_cast<std::uint32_t>(mesh.triangles().size());
            for (std::uint32_t t = 0; t < count; ++t)
                if (random.uniform() < 0.3) mesh.bisect(t);
        }
        fit(f);
    }

    /// Splits every triangle into four.
    void halve(const Function& f) {
        for (int twice = 0; twice < 2; ++twice) {
            const auto count = static_cast<std::uint32_t>(mesh.triangles().size());
            std::vector<std::uint8_t> depth;
            for (const auto& t : mesh.triangles()) depth.push_back(t.depth);
            for (std::uint32_t t = 0; t < count; ++t)
                if (mesh.triangles()[t].depth == depth[t]) mesh.bisect(t);
        }
        fit(f);
    }

    void fit(const Function& f) {
        values.clear(), elements = {};
        for (const BisectionMesh::Node& node : mesh.nodes()) values.emplace_back(f(node.seen_from));
        for (const BisectionMesh::Node& node : mesh.nodes()) {
            elements.points.push_back(node.at);
            elements.values.emplace_back();
            elements.values.back().fill(static_cast<float>(f(node.seen_from)));
        }
        for (const BisectionMesh::Triangle& t : mesh.triangles()) {
            elements.nodes.push_back({t.corner[0], t.corner[1], t.corner[2], t.middle[0], t.middle[1], t.middle[2]});
            elements.region.emplace_back(0), elements.edge_order.push_back(t.order);
            elements.shadow.push_back(ShadowClass::lit);
        }
        CloughTocherFit(mesh, values, [](std::uint32_t) { return Normal{0, 0, 1}; }).write(elements);
    }

    double largest_error(const Function& f) const {
        RandomStream random(4, Stream::mesh);
        double out = 0;
        for (std::uint32_t t = 0; t < elements.size(); ++t)
            for (int i = 0; i < 8; ++i) {
                const double s = random.uniform(), u = random.uniform() * (1 - s);
                const auto& n = elements.nodes[t];
                const Point& o = elements.points[n[0]];
                const Point p = o + s * (elements.points[n[1]] - o) + u * (elements.points[n[2]] - o);
                out = std::max(out, std::abs(elements.at(t, {s, u})[0] - f(p)));
            }
        return out;
    }

    /// Largest error of the elements before they are rounded to floats.
    double largest_error_before_rounding(const Function& f) const {
        const CloughTocherFit fit(mesh, values, [](std::uint32_t) { return Normal{0, 0, 1}; });
        RandomStream random(6, Stream::mesh);
        double out = 0;
        for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
            const CloughTocher element = fit.element(t, 0);
            for (int i = 0; i < 4; ++i) {
                const double s = random.uniform(), u = random.uniform() * (1 - s);
                const auto& c = mesh.triangles()[t].corner;
                const Point& o = mesh.nodes()[c[0]].at;
                const Point p = o + s * (mesh.nodes()[c[1]].at - o) + u * (mesh.nodes()[c[2]].at - o);
                out = std::max(out, std::abs(element.at({1 - s - u, s, u}) - f(p)));
            }
        }
        return out;
    }

    /// Largest differences of value and slope between the two sides of edges of the selected orders.
    struct Jumps {
        double value = 0, slope = 0;
        int edges = 0;
    };
    Jumps jumps(const std::function<bool(CurveOrder)>& is_wanted) const {
        Jumps out;
        const auto& triangles = mesh.triangles();
        for (std::uint32_t t = 0; t < triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t n = triangles[t].neighbor[k];
                if (n == BisectionMesh::none || n < t || !is_wanted(triangles[t].order[k])) continue;
                ++out.edges;
                const Point &a = elements.points[triangles[t].corner[k]],
                            &b = elements.points[triangles[t].corner[(k + 1) % 3]];
                const Vec3 inwards = cross(Normal{0, 0, 1}, b - a);
                for (const double share : {0.15, 0.5, 0.8}) {
                    const Point p = a + share * (b - a);
                    out.value = std::max(out.value, std::abs(at(t, p) - at(n, p)));
                    out.slope =
                        std::max(out.slope, std::abs(slope(t, p, inwards) + slope(n, p, -inwards)) / norm(b - a));
                }
            }
        return out;
    }

  private:
    double at(std::uint32_t t, const Point& p) const {
        const auto& n = elements.nodes[t];
        const Point& o = elements.points[n[0]];
        const Vec3 a = elements.points[n[1]] - o, b = elements.points[n[2]] - o, w = p - o;
        const double area = cross(a, b).z;
        return elements.at(t, {cross(w, b).z / area, cross(a, w).z / area})[0];
    }
    /// Derivative along d, into the triangle: exact for cubics except for rounding errors, which are divided by the
    /// step.
    double slope(std::uint32_t t, const Point& p, const Vec3& d) const {
        constexpr double step = 1e-3;
        return (-11 * at(t, p) + 18 * at(t, p + step * d) - 9 * at(t, p + 2 * step * d) + 2 * at(t, p + 3 * step * d)) /
               (6 * step);
    }
};

double cubic(const Point& p) {
    return 3 + p.x - 2 * p.y + p.x * p.y - 2 * p.x * p.x * p.y + p.y * p.y * p.y + 0.5 * p.x * p.x * p.x;
}

/// A wave with a kink: right of a line, a second wave is added that is 0 on the line.
double kinked(const Point& p) {
    const double beside = p.x - 0.4 - 0.15 * p.y;
    return std::sin(3 * p.x + 2 * p.y) + (beside > 0 ? 2 * beside * std::cos(p.y) : 0);
}

TEST(CloughTocherFit, ReproducesCubicPolynomials) {
    for (const CurveOrder line : {CurveOrder::d0, CurveOrder::d1, CurveOrder::d2}) {
        const Sheet sheet(line, 6, cubic);
        EXPECT_GT(sheet.mesh.triangles().size(), 50u);
        EXPECT_LT(sheet.largest_error(cubic), rounding_of_floats * 10);
    }
}

TEST(CloughTocherFit, TangentPlanesAgreeAcrossAllEdgesExceptKinks) {
    // No cubic fits this function, so that continuity results from the construction, not from smooth data.
    const Sheet sheet(CurveOrder::d1, 6, [](const Point& p) { return std::sin(40 * p.x) * std::cos(70 * p.y); });
    const Sheet::Jumps smooth = sheet.jumps([](CurveOrder o) { return o > CurveOrder::d1; });
    EXPECT_GT(smooth.edges, 50);
    constexpr double rounding = 1e-8;  // slopes are up to some hundred per metre, steps a thousandth of an edge
    EXPECT_LT(smooth.value, rounding);
    EXPECT_LT(smooth.slope, 1e3 * rounding);
    const Sheet::Jumps kink = sheet.jumps([](CurveOrder o) { return o == CurveOrder::d1; });
    EXPECT_GT(kink.edges, 3);
    EXPECT_LT(kink.value, 1e3 * rounding_of_floats);  // gradients along the kink agree up to their rounding to floats
    EXPECT_GT(kink.slope, 0.1);
}

TEST(CloughTocherFit, KinksAreNotSmoothed) {
    const Sheet sheet(CurveOrder::d1, 9, kinked);
    const Sheet::Jumps kink = sheet.jumps([](CurveOrder o) { return o == CurveOrder::d1; });
    EXPECT_NEAR(kink.slope, 2 * std::hypot(1.0, 0.15), 0.1);  // the kink is strongest where the cosine is 1
    EXPECT_LT(kink.value, 10 * rounding_of_floats);
    const Sheet blurred(CurveOrder::d2, 9, kinked);
    EXPECT_LT(10 * sheet.largest_error(kinked), blurred.largest_error(kinked));
}

TEST(CloughTocherFit, ValuesJumpWhereLightDoes) {
    const Function step = [](const Point& p) { return p.x > 0.4 + 0.15 * p.y ? 1.0 : 0.0; };
    const Sheet sheet(CurveOrder::d0, 4, step);
    for (std::uint32_t t = 0; t < sheet.elements.size(); ++t) {
        const double light = step(sheet.mesh.centre(t));
        for (const Vec2 st : {Vec2{0.1, 0.1}, {0.8, 0.1}, {0.3, 0.4}})
            EXPECT_NEAR(sheet.elements.at(t, st)[0], light, rounding_of_floats);
    }
}

TEST(CloughTocherFit, ErrorsFallWithTheFourthPowerOfTheSize) {
    const Function wave = [](const Point& p) { return std::sin(5 * p.x + p.y) * std::exp(p.y); };
    Sheet sheet(CurveOrder::d2, 2, wave);
    std::vector<double> error;
    for (int i = 0; i < 4; ++i) {
        sheet.halve(wave);
        error.push_back(sheet.largest_error_before_rounding(wave));
    }
    EXPECT_GT(std::log2(error[1] / error[3]) / 2, 3.6);  // bisected triangles are not exactly similar to their parents
}

TEST(CloughTocherFit, TheMisfitIsTheErrorOfSmoothLight) {
    const Function quartic = [](const Point& p) { return 10 * p.x * p.x * p.y * p.y + 5 * std::pow(p.y, 4); };
    Sheet sheet(CurveOrder::d2, 5, quartic);
    sheet.halve(quartic);
    const CloughTocherFit fit(sheet.mesh, sheet.values, [](std::uint32_t) { return Normal{0, 0, 1}; });
    double estimated = 0, largest = 0, square = 0;
    RandomStream random(5, Stream::mesh);
    constexpr int places = 20;
    for (std::uint32_t t = 0; t < sheet.elements.size(); ++t) {
        const Misfit misfit = fit.misfit(t, Spectrum(1.0));
        estimated += misfit.squared, largest = std::max(largest, misfit.largest);
        for (int i = 0; i < places; ++i) {
            double s = random.uniform(), u = random.uniform();
            if (s + u > 1) s = 1 - s, u = 1 - u;
            const auto& n = sheet.elements.nodes[t];
            const Point& o = sheet.elements.points[n[0]];
            const Point p = o + s * (sheet.elements.points[n[1]] - o) + u * (sheet.elements.points[n[2]] - o);
            const double off = sheet.elements.at(t, {s, u})[0] - quartic(p);
            square += sheet.elements.area(t) / places * off * off;
        }
    }
    EXPECT_NEAR(std::sqrt(estimated / square), 1,
                0.4);  // the weights assume one shape of error; the triangles have many
    EXPECT_NEAR(largest / sheet.largest_error(quartic), 1, 0.4);
}

}  // namespace
}  // namespace exitance
