#include "exitance/visibility/visible_source.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/visibility/visible_from_four.hpp"
#include "support/blockers.hpp"
#include "support/places.hpp"

namespace exitance {
namespace {

using test::box;
using test::sheet;

using Outline = std::vector<Point>;

/// Faces down from z = 2 to the plane z = 0.
const Outline ceiling_above = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}};
constexpr Normal up = {0, 0, 1};

Outline level_square(double x, double y, double z, double half) {
    return {{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}};
}
double seen(const Point& x, const Normal& n, const Outline& source, const std::vector<const ConvexBlocker*>& blockers,
            Seen& how) {
    VisibleSource visible;
    visible.set(source, blockers);
    return visible(x, n, how);
}

TEST(VisibleSource, ASheetHidesItsShadow) {
    const ConvexBlocker plate = sheet(level_square(0.1, 0, 1, 0.2));
    Seen how;
    const double F = seen({0, 0, 0}, up, ceiling_above, {&plate}, how);
    EXPECT_EQ(how, Seen::part);
    Outline shadow = level_square(0.2, 0, 2, 0.4);  // twice as far, twice as large
    std::reverse(shadow.begin(), shadow.end());
    EXPECT_NEAR(F, point_to_polygon({0, 0, 0}, up, ceiling_above) - point_to_polygon({0, 0, 0}, up, shadow), 1e-15);
}

Outline regular(std::size_t corners, double radius, double z) {
    Outline out;
    for (std::size_t i = 0; i < corners; ++i) {
        const double a = 2 * pi * static_cast<double>(i) / static_cast<double>(corners);
        out.push_back({radius * std::cos(a), radius * std::sin(a), z});
    }
    return out;
}

TEST(VisibleSource, RoundSheetsHideAllOfTheirShadowWhateverTheirNumberOfCorners) {
    for (const std::size_t corners : {20u, 30u, 50u, 100u, 300u}) {
        const ConvexBlocker disc = sheet(regular(corners, 0.4, 1)), small = sheet(level_square(0.2, 0.3, 1.5, 0.1));
        Outline shadow = regular(corners, 0.8, 2);
        std::reverse(shadow.begin(), shadow.end());
        const double lit = point_to_polygon({0, 0, 0}, up, ceiling_above) - point_to_polygon({0, 0, 0}, up, shadow);
        Seen how;
        EXPECT_NEAR(seen({0, 0, 0}, up, ceiling_above, {&disc}, how), lit, 1e-13) << corners;
        EXPECT_EQ(how, Seen::part);
        // A second blocker within the shadow hides nothing more; its cuts leave fragments with many corners.
        EXPECT_NEAR(seen({0, 0, 0}, up, ceiling_above, {&small, &disc}, how), lit, 1e-13) << corners;
    }
}

TEST(VisibleSource, DistinguishesHidingByOneBlockerAndBySeveral) {
    const ConvexBlocker whole = sheet(level_square(0, 0, 1, 0.6));
    const ConvexBlocker left = sheet(level_square(-0.5, 0, 1, 0.55)), right = sheet(level_square(0.5, 0, 1, 0.55));
    const ConvexBlocker aside = sheet(level_square(3, 0, 1, 0.5));
    Seen how;
    EXPECT_EQ(seen({0, 0, 0}, up, ceiling_above, {&whole}, how), 0);
    EXPECT_EQ(how, Seen::nothing);
    EXPECT_EQ(seen({0, 0, 0}, up, ceiling_above, {&left, &right}, how), 0);
    EXPECT_EQ(how, Seen::nothing_past_several);
    EXPECT_NEAR(seen({0, 0, 0}, up, ceiling_above, {&aside}, how), point_to_polygon({0, 0, 0}, up, ceiling_above),
                1e-15);
    EXPECT_EQ(how, Seen::all);
}

TEST(VisibleSource, ABodyHidesWhatItsFacesHideTogether) {
    const ConvexBlocker body = box({-0.3, -0.2, 0.5}, {0.2, 0.4, 1.1});
    std::vector<ConvexBlocker> faces;
    std::vector<const ConvexBlocker*> all;
    for (std::size_t f = 0; f < 6; ++f) {
        Outline outline;
        for (std::uint32_t c : body.loops[f]) outline.push_back(body.points[c]);
        faces.push_back(sheet(outline));
    }
    for (const ConvexBlocker& f : faces) all.push_back(&f);
    RandomStream random(1, Stream::mesh);
    for (int k = 0; k < 200; ++k) {
        const Point x = {3 * random.uniform() - 1.5, 3 * random.uniform() - 1.5, 0};
        Seen one, six;
        EXPECT_NEAR(seen(x, up, ceiling_above, {&body}, one), seen(x, up, ceiling_above, all, six), 1e-14);
    }
}

TEST(VisibleSource, ManyShadowsHideTheirUnion) {
    // Twelve pairs of plates whose shadows overlap by half: each pair hides a rectangle of 0.3 x 0.2.
    std::vector<ConvexBlocker> plates;
    std::vector<const ConvexBlocker*> blockers;
    double F = point_to_polygon({0, 0, 0}, up, ceiling_above);
    for (int k = 0; k < 12; ++k) {
        const double x = -0.8 + 0.5 * (k % 4), y = -0.6 + 0.5 * (k / 4);  // centre of the shadow on the ceiling
        plates.push_back(sheet(level_square(0.5 * x, 0.5 * y, 1, 0.05)));
        plates.push_back(sheet(level_square(0.25 * (x + 0.1), 0.25 * y, 0.5, 0.025)));
        F -= point_to_polygon(
            {0, 0, 0}, up,
            Outline{{x - 0.1, y + 0.1, 2}, {x + 0.2, y + 0.1, 2}, {x + 0.2, y - 0.1, 2}, {x - 0.1, y - 0.1, 2}});
    }
    for (const ConvexBlocker& plate : plates) blockers.push_back(&plate);
    Seen how;
    EXPECT_NEAR(seen({0, 0, 0}, up, ceiling_above, blockers, how), F, 1e-14);
    EXPECT_EQ(how, Seen::part);
}

TEST(VisibleSource, ManyShadowsThatCoverEverythingLeaveNothing) {
    std::vector<ConvexBlocker> plates;
    std::vector<const ConvexBlocker*> blockers;
    for (int k = 0; k < 16; ++k)
        plates.push_back(sheet(level_square(-0.375 + 0.25 * (k % 4), -0.375 + 0.25 * (k / 4), 1, 0.13)));
    for (const ConvexBlocker& plate : plates) blockers.push_back(&plate);
    Seen how;
    EXPECT_EQ(seen({0, 0, 0}, up, ceiling_above, blockers, how), 0);
    EXPECT_EQ(how, Seen::nothing_past_several);
}

TEST(VisibleFromFour, AgreesWithSinglePointsWheneverItAnswers) {
    const ConvexBlocker a = box({-0.3, -0.2, 0.5}, {0.2, 0.4, 1.1}), b = box({0.3, -0.6, 0.7}, {0.8, 0.1, 0.9});
    const ConvexBlocker c = sheet({{-0.9, -0.5, 1.2}, {-0.4, -0.6, 1.3}, {-0.5, 0.3, 1.1}});
    const std::vector<const ConvexBlocker*> blockers = {&a, &b, &c};
    RandomStream random(2, Stream::mesh);
    VisibleFromFour four;
    int answered = 0;
    for (int k = 0; k < 2000; ++k) {
        const Point middle = {3 * random.uniform() - 1.5, 3 * random.uniform() - 1.5, 0};
        std::array<Point, 4> x;
        for (Point& p : x) p = middle + 0.02 * Vec3{random.uniform(), random.uniform(), 0};
        std::array<double, 4> F;
        Seen together;
        if (!four(ceiling_above, blockers, x, up, F, together)) continue;
        ++answered;
        for (std::size_t i = 0; i < 4; ++i) {
            Seen alone;
            EXPECT_NEAR(F[i], seen(x[i], up, ceiling_above, blockers, alone), 1e-14);
            EXPECT_EQ(together, alone);
        }
    }
    EXPECT_GT(answered, 1000);
}

Outline outline_of(const nlohmann::json& json) {
    Outline outline;
    for (const auto& v : json) outline.push_back({v[0], v[1], v[2]});
    return outline;
}

TEST(VisibleSource, ReproducesThePublishedPoints) {
    std::ifstream file(test::data_folder() + "/reference/view_factors.json");
    const nlohmann::json table = nlohmann::json::parse(file);
    for (const auto& c : table["cases"]) {
        if (c["group"] != "point-occluded") continue;
        std::vector<ConvexBlocker> sheets;
        std::vector<const ConvexBlocker*> blockers;
        for (const auto& o : c["occluders"]) sheets.push_back(sheet(outline_of(o)));
        for (const ConvexBlocker& s : sheets) blockers.push_back(&s);
        const auto &p = c["point"], &n = c["normal"];
        Seen how;
        const double F = seen({p[0], p[1], p[2]}, {n[0], n[1], n[2]}, outline_of(c["polygon"]), blockers, how);
        EXPECT_NEAR(F, c["F"].get<double>(), 1e-14) << c["id"];
    }
}

}  // namespace
}  // namespace exitance
