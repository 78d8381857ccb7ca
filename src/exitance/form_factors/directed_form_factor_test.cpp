#include "exitance/form_factors/directed_form_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

/// An opening that faces down, with intensity cos^n per area.
EmissionProfile power_of_cosine(double n, double step) {
    EmissionProfile p;
    p.body = EmissionProfile::Body::flat;
    p.axes[0].at.clear();
    for (double theta = 0; theta <= 90 + 1e-9; theta += step) {
        p.axes[0].at.push_back(theta);
        p.values.push_back(std::pow(std::max(0.0, std::cos(theta * degree)), n));
    }
    return p;
}

/// Typical of luminaires: no rotational symmetry, beams to the sides, steps of 10 and 15 degrees.
EmissionProfile batwing() {
    EmissionProfile p;
    p.body = EmissionProfile::Body::flat;
    p.axes[0] = {EmissionProfile::Angle::phi4, 0, {0, 15, 30, 45, 60, 75, 90}};
    p.axes[1] = {EmissionProfile::Angle::theta, 0, {0, 10, 20, 30, 40, 50, 60, 70, 80, 90}};
    for (const double phi : p.axes[0].at)
        for (const double theta : p.axes[1].at)
            p.values.push_back(std::cos(theta * degree) *
                               (1 + 3 * std::pow(std::sin(2 * theta * degree), 4) * std::cos(phi * degree)));
    return p;
}

struct Lamp {
    explicit Lamp(EmissionProfile p) : profile(std::move(p)) {
        profile.find_smooth_width();
        emission.profile = ProfileId(0);
        emission.scale = pi / exitance_of(profile, down);
    }
    RelativeRadiance radiance() const { return {profile, emission, down}; }
    EmissionProfile profile;
    DirectedEmission emission;
    Normal down{0, 0, -1};
};

/// A rectangle with the given centre, facing down, relative to the point x.
std::vector<Vec3> opening(double width, double depth, const Point& middle, const Point& x) {
    const double a = width / 2, b = depth / 2;
    std::vector<Vec3> out;
    for (const auto& [u, v] : {std::pair(-a, -b), std::pair(-a, b), std::pair(a, b), std::pair(a, -b)})
        out.push_back(middle + Vec3{u, v, 0} - x);
    return out;
}

/// Reference for directed_form_factor: sums the kernel at the centres of many small cells.
double by_cells(const Normal& n, const std::vector<Vec3>& corners, const RelativeRadiance& p, int along, int across) {
    const Vec3 u = (corners[3] - corners[0]) / along, v = (corners[1] - corners[0]) / across;
    const double area = norm(cross(u, v));
    double sum = 0;
    for (int i = 0; i < along; ++i)
        for (int k = 0; k < across; ++k) {
            const Vec3 r = corners[0] + (i + 0.5) * u + (k + 0.5) * v;
            const double above = dot(n, r), before = -dot(p.normal(), r), r2 = squared_norm(r);
            if (above > 0 && before > 0) sum += p(-normalized(r)) * above * before / (pi * r2 * r2) * area;
        }
    return sum;
}

}  // namespace

TEST(EmissionProfile, FluxOfAPowerOfTheCosineIsKnown) {
    for (const double n : {1.0, 2.0, 20.0}) {
        // Intensity cos^n over a hemisphere: 2 pi / (n + 1); linear interpolation of the table is too low by n / 8
        // step^2.
        const double exact = 2 * pi / (n + 1);
        const double chords = n / 8 * 0.5 * degree * 0.5 * degree;
        EXPECT_NEAR(exitance_of(power_of_cosine(n, 0.5), {0, 0, -1}), exact, (1.2 * chords + 1e-5) * exact) << n;
    }
}

TEST(EmissionProfile, FluxOfABoxsFacesIsTheFluxOfItsIntensity) {
    EmissionProfile p;
    p.axes[0].at = {0, 15, 30, 45, 60, 75, 90};
    p.values = {1000, 950, 800, 550, 250, 60, 0};
    double flux = 0;  // total flux of the intensity over all directions, W
    constexpr int rings = 20000;
    for (int i = 0; i < rings; ++i) {
        const double theta = 0.5 * pi * (i + 0.5) / rings;
        flux += p.value({std::sin(theta), 0, -std::cos(theta)}) * 2 * pi * std::sin(theta) * 0.5 * pi / rings;
    }
    p.body = EmissionProfile::Body::box, p.size = {0.2, 0.4, 0.1};
    const double faces = 0.08 * (exitance_of(p, {0, 0, -1}) + exitance_of(p, {0, 0, 1})) +
                         0.04 * (exitance_of(p, {1, 0, 0}) + exitance_of(p, {-1, 0, 0})) +
                         0.02 * (exitance_of(p, {0, 1, 0}) + exitance_of(p, {0, -1, 0}));
    EXPECT_NEAR(faces, flux, 1e-3 * flux);
}

TEST(EmissionProfile, TurningFaceAndLampTogetherChangesNothing) {
    const EmissionProfile p = batwing();
    const double upright = exitance_of(p, {0, 0, -1});
    const Normal n = normalized(Vec3{0.3, 0.2, -1});
    // The flux of a planar opening is its intensity integrated over the hemisphere in front; for a tilted face a small
    // part of this is behind it.
    EXPECT_NEAR(exitance_of(p, n), upright, 0.1 * upright);
    DirectedEmission turned;
    turned.x = {0, 0, 1}, turned.y = {0, 1, 0}, turned.z = {-1, 0, 0};  // the lamp's downward direction becomes +x
    EXPECT_EQ(turned.in_lamp({1, 0, 0}), (Vec3{0, 0, -1}));
}

TEST(EmissionProfile, AnglesAreThoseOfSourceCal) {
    EmissionProfile p;
    p.axes[0] = {EmissionProfile::Angle::phi, 0, {0, 360}};
    p.values = {0, 360};
    const auto at = [&](double x, double y) { return p.value(normalized(Vec3{x, y, -1})); };
    EXPECT_NEAR(at(1, 1e-12), 0, 1e-9);
    EXPECT_NEAR(at(0, 1), 90, 1e-9);
    EXPECT_NEAR(at(0, -1), 270, 1e-9);
    p.axes[0].angle = EmissionProfile::Angle::phi2, p.axes[0].at = {0, 180}, p.values = {0, 180};
    EXPECT_NEAR(at(0, -1), 90, 1e-9);
    p.axes[0].offset = 90, p.axes[0].at = {90, 270}, p.values = {90, 270};
    EXPECT_NEAR(at(0, -1), 180, 1e-9);
    p.axes[0] = {EmissionProfile::Angle::theta, 0, {0, 90}};
    EXPECT_NEAR(p.value({0, 0, -1}), 90, 1e-9);
    EXPECT_EQ(p.value({0, 0, 1}), 0) << "beyond the table there is no light";
    p.axes[0] = {EmissionProfile::Angle::b_vertical, 0, {-90, 90}}, p.values = {-90, 90};
    EXPECT_NEAR(at(1, 0), 45, 1e-9);
    p.axes[0].angle = EmissionProfile::Angle::b_horizontal;
    EXPECT_NEAR(at(0, 1), -45, 1e-9);
}

TEST(DirectedFormFactor, OfADiffuseTableIsTheFormFactor) {
    const Lamp lamp(power_of_cosine(1, 1));
    for (const Point x : {Point{0, 0, 0}, Point{1, 0.5, 2}, Point{0.4, 0, 2.45}}) {
        const auto corners = opening(1.2, 1.2, {0, 0, 2.5}, x);
        const double F = contour_sum({0, 0, 1}, corners);
        EXPECT_NEAR(directed_form_factor({0, 0, 1}, corners, lamp.radiance()), F, 2e-4 * F);
    }
}

TEST(DirectedFormFactor, OfASmallLampIsItsIntensityOverTheSquareOfTheDistance) {
    for (const double n : {1.0, 4.0, 20.0}) {
        const Lamp lamp(power_of_cosine(n, 0.25));
        const double side = 0.02, M = exitance_of(lamp.profile, lamp.down);
        for (const double away : {0.0, 0.5, 1.0, 2.0}) {
            const auto corners = opening(side, side, {away, 0, 2}, {});
            const double r2 = 4 + away * away, cosine = 2 / std::sqrt(r2);
            const double exact = side * side * std::pow(cosine, n) * cosine / r2;
            EXPECT_NEAR(M * directed_form_factor({0, 0, 1}, corners, lamp.radiance()), exact,
                        1e-3 * exact + 1e-6 * side * side)
                << n << ' ' << away;
        }
    }
}

TEST(DirectedFormFactor, OfANearOpeningIsRightToATenthOfAPercent) {
    RandomStream random(1, Stream::direct, 7);
    for (const EmissionProfile& profile : {batwing(), power_of_cosine(30, 5), power_of_cosine(200, 2.5)}) {
        const Lamp lamp(profile);
        for (int i = 0; i < 24; ++i) {
            const Point x{2 * random.uniform() - 1, 2 * random.uniform() - 1, 2.4 * random.uniform()};
            const Normal n = normalized(Vec3{random.uniform() - 0.5, random.uniform() - 0.5, 1});
            const auto corners = opening(1.2, 0.6, {0, 0, 2.5}, x);
            if (std::ranges::any_of(corners, [&](const Vec3& r) { return dot(n, r) <= 0; })) continue;
            const double fine = by_cells(n, corners, lamp.radiance(), 400, 400);
            const double F = contour_sum(n, corners);
            EXPECT_NEAR(directed_form_factor(n, corners, lamp.radiance()), fine, 1e-3 * std::max(fine, 0.02 * F))
                << i << ' ' << x.x << ' ' << x.y << ' ' << x.z;
        }
    }
}

TEST(DirectedFormFactor, OfALongOpeningIsRightToATenthOfAPercent) {
    const Normal up{0, 0, 1}, to_the_side{1, 0, 0};
    for (const EmissionProfile& profile : {batwing(), power_of_cosine(1, 5), power_of_cosine(30, 5)}) {
        const Lamp lamp(profile);
        // From far below, from a wall that the opening reaches, and from places near its end, close to its plane.
        for (const auto& [x, n, length] :
             {std::tuple(Point{3, 0.3, 0}, up, 6.0), std::tuple(Point{0, 0.2, 2}, to_the_side, 6.0),
              std::tuple(Point{0, 0.02, 2.49}, to_the_side, 0.2),
              std::tuple(Point{0, 0.002, 2.498}, to_the_side, 0.2)}) {
            const auto corners = opening(length, 0.01, {length / 2, 0, 2.5}, x);
            const bool is_near = length < 1;
            const double fine = by_cells(n, corners, lamp.radiance(), is_near ? 4000 : 20000, is_near ? 200 : 10);
            const double F = contour_sum(n, corners);
            EXPECT_NEAR(directed_form_factor(n, corners, lamp.radiance()), fine, 1e-3 * std::max(fine, 0.02 * F))
                << x.x << ' ' << x.y << ' ' << x.z;
        }
    }
}

TEST(DirectedFormFactor, OfATableThatJumpsAtItsPoleIsRightToATenthOfAPercent) {
    EmissionProfile p;
    p.body = EmissionProfile::Body::flat;
    p.axes[0] = {EmissionProfile::Angle::phi4, 0, {0, 90}};
    p.axes[1] = {EmissionProfile::Angle::theta, 0, {0, 90}};
    p.values = {1000, 0, 600, 0};
    const Lamp lamp(p);
    for (const Point x : {Point{0.1, 0.2, 0}, Point{0.1, 0.2, 2.4}}) {
        const auto corners = opening(1.2, 0.6, {0, 0, 2.5}, x);
        const double fine = by_cells({0, 0, 1}, corners, lamp.radiance(), 1000, 1000);
        EXPECT_NEAR(directed_form_factor({0, 0, 1}, corners, lamp.radiance()), fine, 1e-3 * fine) << x.z;
    }
}

}  // namespace exitance
