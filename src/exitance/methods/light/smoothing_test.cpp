#include "exitance/methods/light/smoothing.hpp"

#include <gtest/gtest.h>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Two coplanar, adjacent walls of 1 m x 1 m in regions 0 and 1, split `cuts` times.
GlobalLight two_walls(int cuts, bool triangles) {
    GlobalLight light;
    const auto shape = triangles ? Patch::Shape::triangle : Patch::Shape::parallelogram;
    for (std::size_t r = 0; r < 2; ++r) {
        const double x = static_cast<double>(r);
        light.tree.add_root(RegionId(r), {{x, 0, 0}, {1, 0, 0}, {0, 1, 0}, shape});
        if (triangles) light.tree.add_root(RegionId(r), {{x + 1, 1, 0}, {-1, 0, 0}, {0, -1, 0}, shape});
    }
    for (int round = 0; round < cuts; ++round)
        for (ElementId e : light.tree.leaves()) light.tree.split(e, Cut::both);
    light.numbering = LeafNumbering(light.tree);
    return light;
}

/// Sets the mean of a function on every leaf.
template <class Function>
void set_light(GlobalLight& light, const Function& f) {
    light.indirect.clear();
    for (ElementId e : light.numbering.leaves) {
        double sum = 0;
        constexpr int n = 8;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const Vec2 uv = light.tree.uniform(e, (i + 0.5) / n, (j + 0.5) / n);
                sum += f(light.tree.patch(e).at(uv)) / (n * n);
            }
        light.indirect.push_back(Spectrum(sum));
    }
}

template <class Function>
double rms_error(const ElementFunction& smooth, const Function& f) {
    double sum = 0, area = 0;
    RandomStream random(1, Stream::mesh);
    for (ElementId e : smooth.tree.leaves())
        for (int k = 0; k < 16; ++k) {
            const Vec2 uv = smooth.tree.uniform(e, random.uniform(), random.uniform());
            const double off = smooth.at({e, uv})[0] - f(smooth.tree.patch(e).at(uv));
            sum += smooth.tree.area(e) * off * off, area += smooth.tree.area(e);
        }
    return std::sqrt(sum / area);
}

}  // namespace

TEST(Smoothing, IsExactForLinearLightAndStopsAtWalls) {
    // Each wall has its own slope: using neighbours across the seam would affect both.
    const auto f = [](const Point& p) { return p.x < 1 ? 1 + 2 * p.x + 3 * p.y : 9 - 4 * (p.x - 1) + p.y; };
    for (bool triangles : {false, true}) {
        GlobalLight light = two_walls(3, triangles);
        set_light(light, f);
        // Single precision of the values. A triangle in a corner has one neighbour, and thus a slope in one direction
        // only; without slopes the error would be 0.15.
        const double tolerance = triangles ? 0.05 : 1e-5;
        EXPECT_LT(rms_error(smoothed_on_leaves(light, 2), f), tolerance) << triangles;
    }
}

TEST(Smoothing, ErrorFallsWithTheSquareOfTheSize) {
    const auto f = [](const Point& p) { return 2 + std::sin(3 * p.x) * std::cos(2 * p.y); };
    double before = 0;
    for (int cuts : {3, 4, 5}) {
        GlobalLight light = two_walls(cuts, false);
        set_light(light, f);
        const double error = rms_error(smoothed_on_leaves(light, 2), f);
        // Half the size gives a quarter of the error, except where the slope is limited at maxima and minima.
        EXPECT_TRUE(before == 0 || error < 0.32 * before) << error << " after " << before;
        before = error;
    }
}

TEST(Smoothing, ShadowEdgesAreNotBlurred) {
    // A step of 10 between elements, on top of a gentle slope.
    const auto f = [](const Point& p) { return (p.x < 0.5 ? 10.0 : 0.0) + 0.1 + 0.4 * p.y; };
    GlobalLight light = two_walls(4, false);
    set_light(light, f);
    EXPECT_LT(rms_error(smoothed_on_leaves(light, 2), f), 1e-5);
}

TEST(Smoothing, KeepsMeansAndTheRangeOfTheNeighbours) {
    RandomStream random(3, Stream::mesh);
    GlobalLight light = two_walls(2, false);
    for (ElementId e : light.tree.leaves())
        if (random.uniform() < 0.4) light.tree.split(e, random.uniform() < 0.5 ? Cut::u : Cut::both);
    light.numbering = LeafNumbering(light.tree);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i)
        light.indirect.push_back(Spectrum(random.uniform()));
    const ElementFunction smooth = smoothed_on_leaves(light, 2);
    for (std::size_t i = 0; i < light.numbering.leaves.size(); ++i) {
        const ElementId e = light.numbering.leaves[i];
        EXPECT_NEAR(smooth.at({e, {0.5, 0.5}})[0], light.indirect[i][0], 1e-6);
        for (int k = 0; k < 4; ++k) {
            const double v = smooth.at({e, smooth.tree.patch(e).corner_uv(k)})[0];
            EXPECT_GE(v, -1e-6);
            EXPECT_LE(v, 2.0) << "no more than once again of what there is";
        }
    }
}

}  // namespace exitance
