#include "exitance/visibility/visible_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "exitance/base/random.hpp"
#include "exitance/direct/direct_light.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "support/places.hpp"
#include "support/test_scenes.hpp"

namespace exitance {
namespace {

using test::Face;

std::vector<Point> rectangle(double x0, double y0, double x1, double y1, double z) {  // front faces down
    return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

/// Form factor from x to the visible part of the emitting faces.
double visible(const std::vector<Face>& faces, const Point& x, const Normal& n, RegionId own = {}) {
    const Scene scene = test::make(faces);
    const Occluders occluders(scene);
    VisibilityWorkspace scratch;
    return DirectLight(scene, occluders).irradiance(x, n, own, scratch)[0];
}

TEST(VisiblePart, OfASourceBehindAHalfPlaneIsThePartBesideItsEdge) {
    for (double edge : {-0.9, -0.3, 0.0, 0.2, 0.499}) {
        const double f =
            visible({{rectangle(-1, -1, 1, 1, 2), 1}, {rectangle(-50, -50, edge, 50, 1)}}, {0, 0, 0}, {0, 0, 1});
        const double lit = point_to_polygon({0, 0, 0}, {0, 0, 1}, rectangle(std::max(-1.0, 2 * edge), -1, 1, 1, 2));
        EXPECT_NEAR(f, lit, 1e-15) << edge;
    }
    EXPECT_EQ(visible({{rectangle(-1, -1, 1, 1, 2), 1}, {rectangle(-50, -50, 0.5, 50, 1)}}, {0, 0, 0}, {0, 0, 1}), 0);
}

TEST(VisiblePart, UnderABlockerIsTheSourceLessTheBlockersShadow) {
    const std::vector<Point> light = rectangle(-0.75, -0.75, 0.75, 0.75, 2);
    for (int k = 1; k < 20; ++k) {
        const double h = 0.1 * k, stretch = 2 / h;
        const Scene scene = test::make({{light, 1}, {rectangle(-0.5, -0.5, 0.5, 0.5, h)}});
        const Occluders occluders(scene);
        const DirectLight direct(scene, occluders);
        VisibilityWorkspace scratch;
        for (double px = -2; px <= 2; px += 0.16) {
            const Point x{px, 0.3 * px, 0};
            const auto thrown = [&](double c, double p) { return std::clamp(p + stretch * (c - p), -0.75, 0.75); };
            const double x0 = thrown(-0.5, x.x), x1 = thrown(0.5, x.x), y0 = thrown(-0.5, x.y), y1 = thrown(0.5, x.y);
            const double lit =
                point_to_polygon(x, {0, 0, 1}, light) - point_to_polygon(x, {0, 0, 1}, rectangle(x0, y0, x1, y1, 2));
            EXPECT_NEAR(direct.irradiance(x, {0, 0, 1}, {}, scratch)[0], lit, 2e-15);
        }
    }
}

/// Largest difference from the irradiance (first band) in a reference file, relative to the largest value.
double largest_difference(const std::string& scene_name, const std::string& reference_name) {
    const std::string data = test::data_folder();
    std::ifstream reference(data + "/reference/" + reference_name);
    EXPECT_TRUE(reference) << reference_name;
    const CheckedScene checked = load_scene(data + "/scenes/" + scene_name);
    EXPECT_TRUE(checked.scene) << scene_name;
    const Scene& scene = *checked.scene;
    const Occluders occluders(scene);
    const DirectLight direct(scene, occluders);
    VisibilityWorkspace scratch;
    double worst = 0, largest = 0;
    std::string line;
    std::getline(reference, line);
    while (std::getline(reference, line)) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream row(line);
        Point x;
        Normal n;
        double expected = 0;
        row >> x.x >> x.y >> x.z >> n.x >> n.y >> n.z >> expected;
        worst = std::max(worst, std::abs(direct.irradiance(x, n, {}, scratch)[0] - expected));
        largest = std::max(largest, expected);
    }
    return worst / largest;
}

TEST(VisiblePart, MeetsTheAnalyticBlockerReferences) {
    for (const std::string height : {"0p7", "1p4"})
        for (const std::string points : {"", "_grid"})  // reference values have nine digits
            EXPECT_LT(largest_difference("blocker_h" + height + ".obj", "blocker_h" + height + points + ".csv"), 5e-9);
}

TEST(VisiblePart, AgreesWithThirtyDigitValues) {
    const std::vector<Point> unit = rectangle(0, 0, 1, 1, 1), wide = rectangle(-1, -1, 1, 1, 2);
    const Normal up{0, 0, 1}, tilted{0.10783277320343841, 0.21566554640687682, 0.9704949588309457};
    EXPECT_NEAR(
        visible({{unit, 1}, {{{0.4, 0.4, 0.5}, {0.9, 0.4, 0.5}, {0.9, 0.9, 0.5}, {0.4, 0.9, 0.5}}}}, {0.5, 0.5, 0}, up),
        0.113848089727361, 1e-14);
    EXPECT_NEAR(visible({{wide, 1}, {{{0, -2, 1}, {0.1, -2, 1}, {0.1, 2, 1.2}, {0, 2, 1.2}}}}, {0, 0, 0}, up),
                0.214592826109066, 1e-14);
    EXPECT_NEAR(visible({{wide, 1}, {{{-0.3, -0.3, 0.7}, {0.1, -0.2, 0.9}, {0, 0.3, 0.8}}}}, {0.2, 0.1, 0}, tilted),
                0.187799137268658, 1e-14);
    EXPECT_NEAR(visible({{unit, 1},
                         {{{0.1, 0.1, 0.5}, {0.3, 0.1, 0.5}, {0.3, 0.4, 0.5}, {0.1, 0.4, 0.5}}},
                         {{{0.4, 0.1, 0.5}, {0.5, 0.1, 0.5}, {0.5, 0.6, 0.5}, {0.4, 0.6, 0.5}}}},
                        {0.1, 0.2, 0}, up),
                0.0924092773008824, 1e-14);
    EXPECT_EQ(
        visible({{wide, 1}, {{{-0.9, -0.9, 0.5}, {0.9, -0.9, 0.5}, {0.9, 0.9, 0.5}, {-0.9, 0.9, 0.5}}}}, {0, 0, 0}, up),
        0);
}

TEST(VisiblePart, IgnoresOccludersInThePlaneOfTheSourceOrTheReceiver) {
    const std::vector<Point> light = rectangle(-1, -1, 1, 1, 2);
    const double open = point_to_polygon({0, 0, 0}, {0, 0, 1}, light);
    const std::vector<Point> floor = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    const std::vector<Point> foot_up = {{0.5, -5, 0}, {0.5, 5, 0}, {0.5, 5, 1e-3}, {0.5, -5, 1e-3}};
    // A light in the ceiling is on top of it, and so a tiny distance nearer.
    EXPECT_NEAR(visible({{light, 1}, {rectangle(-5, -5, 5, 5, 2)}}, {0, 0, 0}, {0, 0, 1}), open, 1e-5 * open);
    EXPECT_EQ(visible({{light, 1}, {floor}}, {0, 0, 0}, {0, 0, 1}), open);
    EXPECT_EQ(visible({{light, 1}, {foot_up}}, {0, 0, 0}, {0, 0, 1}), open);  // a rise of 1 mm does not hide the light
    // walls that end at the light's edges, and one that contains the point
    EXPECT_EQ(visible({{light, 1}, {{{1, -5, 0}, {1, 5, 0}, {1, 5, 2}, {1, -5, 2}}}}, {0, 0, 0}, {0, 0, 1}), open);
    EXPECT_EQ(visible({{light, 1}, {{{0, -5, 0}, {0, 5, 0}, {0, 5, 2}, {0, -5, 2}}}}, {0, 0, 0}, {0, 0, 1}), open);
}

TEST(VisiblePart, StaysTheSameWhenOccludersAndSourcesAreCut) {
    RandomStream random(9, Stream::mesh);
    const std::vector<Point> light = rectangle(-1, -1, 1, 1, 1.5);
    for (int trial = 0; trial < 20; ++trial) {
        std::vector<Face> whole = test::triangle_soup(12, 1.0, 50 + trial, {0, 0, 0.7}), cut;
        for (const Face& face : whole) {  // different materials, so that the pieces are not joined again
            const auto& c = face.corners;
            const Point m = c[0] + random.uniform() * (c[1] - c[0]);
            cut.push_back({{c[0], m, c[2]}});
            cut.push_back({{m, c[1], c[2]}});
        }
        whole.push_back({light, 1});
        cut.push_back({rectangle(-1, -1, 0.3, 1, 1.5), 1});
        cut.push_back({rectangle(0.3, -1, 1, 1, 1.5), 1});
        const Point x{random.uniform() - 0.5, random.uniform() - 0.5, -0.2};
        EXPECT_NEAR(visible(whole, x, {0, 0, 1}), visible(cut, x, {0, 0, 1}), 1e-13);
    }
}

TEST(VisiblePart, AgreesWithCountingRaysInTriangleSoups) {
    const std::vector<Point> light = rectangle(-0.5, -0.5, 0.5, 0.5, 1);
    for (int trial = 0; trial < 12; ++trial) {
        std::vector<Face> faces = test::triangle_soup(4 + 3 * trial, 0.8, 70 + trial, {0, 0, 0.5});
        faces.push_back({light, 1});
        const Scene scene = test::make(faces);
        const Point x{0.1, -0.2, -0.1};
        const Normal n = normalized({0.2, 0.1, 1});
        RandomStream random(11, Stream::reference, trial);
        const int side = 60;  // stratified
        double sum = 0;
        for (int i = 0; i < side * side; ++i) {
            const Point y{(i % side + random.uniform()) / side - 0.5, (i / side + random.uniform()) / side - 0.5, 1};
            double distance;
            test::first_on_ray(scene, x, y - x, distance);
            const double r2 = squared_norm(y - x);
            if (distance > 1 - 1e-9) sum += dot(n, y - x) * (y.z - x.z) / (pi * r2 * r2);
        }
        sum /= side * side;
        const Occluders occluders(scene);
        VisibilityWorkspace scratch;
        const double f = DirectLight(scene, occluders).irradiance(x, n, {}, scratch)[0];
        EXPECT_NEAR(f, sum, 4e-3 * 0.2);  // strata cut by shadow edges: 4 standard deviations of a 60 x 60 grid
    }
}

TEST(VisiblePart, ScalesAndMovesWithItsScene) {
    const auto light_at = [](double scale, const Vec3& shift) {
        std::vector<Face> faces = test::triangle_soup(15, 0.8, 99, {0, 0, 0.5});
        faces.push_back({rectangle(-0.5, -0.5, 0.5, 0.5, 1), 1});
        for (Face& f : faces)
            for (Point& p : f.corners) p = scale * p + shift;
        return visible(faces, scale * Point{0.1, -0.2, -0.1} + shift, {0, 0, 1});
    };
    const double f = light_at(1, {});
    EXPECT_GT(f, 0.01);
    EXPECT_NEAR(light_at(1e-4, {}), f, 1e-13);
    EXPECT_NEAR(light_at(1e4, {}), f, 1e-13);
    EXPECT_NEAR(light_at(1, {1e6, -1e6, 5e5}), f, 1e-8);  // the corners themselves are rounded to 1e-10
}

TEST(VisiblePart, OfAConcaveLightWithATableInFront) {
    const std::vector<Point> ell = {{0, 0, 2}, {0, 3, 2}, {0.5, 3, 2}, {0.5, 0.5, 2}, {3, 0.5, 2}, {3, 0, 2}};
    const Face table{{{0.2, 0.1, 1}, {0.8, 0.1, 1}, {0.8, 1.3, 1}, {0.2, 1.3, 1}}};
    const double f = visible({{ell, 1}, table}, {0.4, 0.3, 0}, {0, 0, 1});
    const double parts = visible({{rectangle(0, 0, 0.5, 3, 2), 1}, table}, {0.4, 0.3, 0}, {0, 0, 1}) +
                         visible({{rectangle(0.5, 0, 3, 0.5, 2), 1}, table}, {0.4, 0.3, 0}, {0, 0, 1});
    EXPECT_NEAR(f, parts, 1e-15);
    EXPECT_GT(f, 0.001);
}

TEST(Occluders, DetectCoveredPoints) {
    const std::vector<Point> floor = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    const std::vector<Point> bottom = rectangle(0, 0, 1, 1, 0),
                             rug = {{-2, -2, 2e-6}, {-1, -2, 2e-6}, {-1, -1, 2e-6}, {-2, -1, 2e-6}};
    const Scene scene = test::make({{floor}, {bottom}, {rug}});
    const Occluders occluders(scene);
    const RegionId own = scene.surfaces()[SurfaceId(0)].region;
    EXPECT_TRUE(occluders.is_covered({0.5, 0.5, 0}, {0, 0, 1}, own));
    EXPECT_TRUE(occluders.is_covered({-1.5, -1.5, 0}, {0, 0, 1}, own));
    EXPECT_FALSE(occluders.is_covered({1.5, 0.5, 0}, {0, 0, 1}, own));
    // a sheet with two sides does not cover itself
    std::vector<Point> back(floor.rbegin(), floor.rend());
    const Scene sheet = test::make({{floor}, {back}});
    EXPECT_FALSE(Occluders(sheet).is_covered({0.5, 0.5, 0}, {0, 0, 1}, sheet.surfaces()[SurfaceId(0)].region));
}

TEST(Occluders, TheWallsOfAConvexRoomOccludeNothing) {
    std::vector<Face> faces = test::closed_box({}, {2, 3, 1});
    const Scene box = test::make(faces);
    EXPECT_TRUE(Occluders(box).has_nothing_inside());
    faces.push_back({rectangle(0.5, 0.5, 1, 1, 0.4)});
    const Scene scene = test::make(faces);
    const Occluders occluders(scene);
    EXPECT_FALSE(occluders.has_nothing_inside());
    std::size_t inner = 0, all = 0;
    for (const Occluders::Size size : {Occluders::Size::large, Occluders::Size::small}) {
        occluders.visit_inner(size, {}, [&](PieceId) { return ++inner, false; }, {});
        occluders.visit_region(size, {}, [&](PieceId) { return ++all, false; }, {});
    }
    EXPECT_EQ(inner, 1u);
    EXPECT_EQ(all, 7u);
}

TEST(DirectLight, OfManyUnoccludedEmittersIsTheSumOfEach) {
    std::vector<Face> faces = test::closed_box({}, {2, 3, 1});
    for (std::size_t i = 0; i < faces.size(); ++i) faces[i].exitance = 1 + static_cast<double>(i);
    const Scene scene = test::make(faces);
    const Occluders occluders(scene);
    const DirectLight direct(scene, occluders);
    VisibilityWorkspace scratch;
    ReceiverLight light, part;
    const RegionId own = scene.surfaces()[SurfaceId(0)].region;
    const Normal& n = scene.regions()[own].plane.n;
    direct.prepare(scene.outline(SurfaceId(0)), n, own, light, scratch);
    direct.prepare(scene.outline(SurfaceId(0)), light, part, scratch);
    EXPECT_EQ(light.open.size(), 5u);
    EXPECT_EQ(part.open.size(), 5u);
    double by_itself = 0;
    for (const DirectLight::Emitter& e : direct.emitters())
        by_itself += e.exitance[0] * direct.form_factor({{0.3, 0.2, 0}, n, own}, e, scratch);
    for (const ReceiverLight& l : {light, part})
        EXPECT_NEAR(direct.irradiance(l, {0.3, 0.2, 0}, scratch)[0], by_itself, 1e-11);  // accuracy of the batch: 1e-12
}

/// A corner of a source or of a blocker that is in the receiver's or the source's plane is above or below it by
/// rounding. The exact coordinates are multiples of 1/64, with both planes parallel to the axes.
TEST(VisiblePart, CornersInThePlanesOfReceiverAndSourceGiveTheSameLightInAnyPlace) {
    RandomStream random(5, Stream::mesh);
    const auto between = [&](double a, double b) { return std::round((a + (b - a) * random.uniform()) * 64) / 64; };
    VisibilityWorkspace scratch;
    for (int k = 0; k < 600; ++k) {
        std::vector<std::vector<Point>> faces = {{{-4, -4, 0}, {3, -4, 0}, {3, 4, 0}, {-4, 4, 0}}};
        faces.push_back(
            {{4, between(-1, 1), 0}, {4, between(-3, -1), between(1, 3)}, {4, between(1, 3), between(1, 3)}});
        if (area_vector(faces.back()).x > 0) std::swap(faces.back()[0], faces.back()[1]);
        const bool hangs = k % 2 == 1;
        for (int b = 0; b < 1 + k % 3; ++b) {
            const double x = between(0, 2.5);
            faces.push_back({{x, between(-1, 1), 0},
                             {hangs ? 4 : x + between(-0.5, 0.5), between(-2, 0), between(0.5, 2)},
                             {x + between(-0.5, 0.5), between(0.25, 2), between(0.5, 2)}});
        }
        const double angle = 6 * random.uniform(), scale = std::pow(10, -3 + 4 * random.uniform());
        const Vec3 offset = k % 5 == 0 ? Vec3{1000, -700, 300} : Vec3{3, -2, 5};
        const auto place = [&](const Point& p) {
            const double c = std::cos(angle), s = std::sin(angle);
            const Vec3 q = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
            return Point(scale * (Vec3{q.x, c * q.y - s * q.z, s * q.y + c * q.z} + offset));
        };
        std::vector<Face> exact, placed;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            exact.push_back({faces[i], i == 1 ? 1.0 : 0.0});
            for (Point& p : faces[i]) p = place(p);
            placed.push_back({faces[i], i == 1 ? 1.0 : 0.0});
        }
        const Scene at_origin = test::make(exact), elsewhere = test::make(placed);
        const Occluders near(at_origin), far(elsewhere);
        const DirectLight expected(at_origin, near), found(elsewhere, far);
        const Normal n = normalized(area_vector(faces[0]));
        for (int i = 0; i < 10; ++i) {
            const Point x = {between(-4, 3), between(-3, 3), 0};
            const double E = expected.irradiance(x, {0, 0, 1}, {}, scratch)[0];
            EXPECT_NEAR(found.irradiance(place(x), n, {}, scratch)[0], E, 1e-10) << k << ' ' << i;
        }
    }
}

}  // namespace
}  // namespace exitance
