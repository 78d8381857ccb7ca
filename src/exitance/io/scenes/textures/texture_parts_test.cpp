#include "exitance/io/scenes/textures/texture_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exitance/io/scenes/textures/textured_faces.hpp"

namespace exitance {
namespace {

constexpr double max_reflectance = 0.95;

/// A picture of grey pixels with linear values from `value(x, y)`, 0 to 1.
template <class Value>
TextureArea grey_picture(std::size_t width, std::size_t height, Value&& value) {
    TexturePixels pixels{width, height, std::vector<std::uint8_t>(3 * width * height)};
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                pixels.rgb[3 * (y * width + x) + c] = static_cast<std::uint8_t>(std::lround(255 * value(x, y)));
    return TextureArea::of(pixels, linear_curve());
}

using Placing = Point (*)(const Point&);

/// A textured face of 4 m x 3 m in a room of black walls: a rectangle, or the two triangles of it.
struct Wall {
    SceneDescription d;

    explicit Wall(const TextureArea& picture, double reflectance = 0.8, Placing place = nullptr) {
        d.materials = {{"wall", Spectrum(reflectance * picture.mean()[0]), Spectrum()},
                       {"black", Spectrum(), Spectrum()}};
        d.groups = {"room"};
        for (const Point& p : {Point{0, 0, 0}, Point{4, 0, 0}, Point{4, 0, 3}, Point{0, 0, 3}})
            d.points.push_back(place ? place(p) : p);
    }
    void add(std::vector<std::uint32_t> corners, std::uint32_t material = 0) {
        d.faces.push_back({std::move(corners), material, 0, 1});
    }
    /// Texture coordinates of a corner, such that the picture covers the rectangle `repeats` times.
    static Vec2 place(std::uint32_t corner, double repeats) {
        return repeats * Vec2{corner == 1 || corner == 2 ? 1.0 : 0.0, corner >= 2 ? 0.0 : 1.0};
    }
    FaceColours colours(std::size_t face, const TextureArea& picture, double repeats = 1) const {
        FaceColours out;
        out.reflectance.picture = &picture;
        for (const std::uint32_t c : d.faces[face].corners) out.reflectance.places.push_back(place(c, repeats));
        return out;
    }
    void cut(const TextureArea& picture, std::optional<std::size_t> parts = {}, double repeats = 1) {
        TexturedFaces textured(d, max_reflectance, parts);
        const std::size_t count = d.faces.size();
        for (std::size_t f = 0; f < count; ++f) textured.show(f, colours(f, picture, repeats));
        textured.finish();
        deviation = textured.reflectance_deviation();
        finding = textured.finding();
    }
    double area(const SceneDescription::Face& face) const {
        Vec3 sum;
        for (std::size_t i = 2; i < face.corners.size(); ++i)
            sum = sum + 0.5 * cross(d.points[face.corners[i - 1]] - d.points[face.corners[0]],
                                    d.points[face.corners[i]] - d.points[face.corners[0]]);
        return norm(sum);
    }
    double total_area() const {
        double sum = 0;
        for (const SceneDescription::Face& f : d.faces) sum += area(f);
        return sum;
    }
    double reflected() const {
        double sum = 0;
        for (const SceneDescription::Face& f : d.faces) sum += area(f) * d.materials[f.material].reflectance[0];
        return sum;
    }

    std::vector<Spectrum> deviation;
    std::optional<Finding> finding;
};

TEST(TexturedFaces, AFaceOfTwoTonesBecomesTwoRectangles) {
    const TextureArea tones = grey_picture(64, 64, [](std::size_t x, std::size_t) { return x < 16 ? 1.0 : 0.2; });
    for (const bool triangles : {false, true}) {
        Wall wall(tones);
        if (triangles)
            wall.add({0, 1, 2}), wall.add({0, 2, 3});
        else
            wall.add({0, 1, 2, 3});
        wall.cut(tones);
        const CheckedScene made = make_scene(wall.d);
        ASSERT_TRUE(made.scene);
        ASSERT_EQ(made.scene->regions().size(), 2u) << "triangles are cut alike and joined again";
        for (const Region& r : made.scene->regions()) {
            const bool is_bright = std::abs(r.area - 3) < 1e-9;
            EXPECT_NEAR(made.scene->materials()[r.material].reflectance[0], is_bright ? 0.8 : 0.16, 0.002);
            EXPECT_NEAR(r.area, is_bright ? 3 : 9, 1e-9);
            EXPECT_EQ(r.loops[0].size(), 4u);
        }
        for (const Surface& s : made.scene->surfaces()) EXPECT_GT(s.whole, 0u);
        EXPECT_FALSE(wall.finding) << "nothing is averaged";
    }
}

TEST(TexturedFaces, PartsReflectTogetherWhatTheFaceReflects) {
    const TextureArea waves = grey_picture(96, 80, [](std::size_t x, std::size_t y) {
        return 0.5 + 0.4 * std::sin(0.07 * static_cast<double>(x)) * std::cos(0.05 * static_cast<double>(y));
    });
    Wall wall(waves);
    wall.add({0, 1, 2, 3});
    wall.cut(waves);
    EXPECT_GT(wall.d.faces.size(), 20u);
    EXPECT_NEAR(wall.total_area(), 12, 1e-9);
    // Corners near a cut are moved to it by up to 10^-4 of the face, and codes are joined within two of 256.
    EXPECT_NEAR(wall.reflected(), 12 * 0.8 * waves.mean()[0], 1e-3 * 12 * 0.8 * waves.mean()[0]);
    EXPECT_LE(wall.d.materials.size(), 130u) << "parts share materials";
}

Point turned_and_moved(const Point& p) {
    const double c = 0.6, s = 0.8;
    return {1000 + 0.01 * (c * p.x - s * p.y), -500 + 0.01 * (s * p.x + c * p.y), 30 + 0.01 * p.z};
}

TEST(TexturedFaces, PartsDoNotDependOnPositionAndUnit) {
    const TextureArea tones =
        grey_picture(40, 40, [](std::size_t x, std::size_t y) { return (x < 13 ? 0.9 : 0.3) * (y < 29 ? 1.0 : 0.5); });
    std::vector<std::size_t> counts;
    for (const Placing place : {Placing(nullptr), Placing(turned_and_moved)}) {
        Wall wall(tones, 0.8, place);
        wall.add({0, 1, 2, 3});
        wall.cut(tones);
        counts.push_back(wall.d.faces.size());
    }
    EXPECT_EQ(counts[0], 4u);
    EXPECT_EQ(counts[1], 4u);
}

TEST(TexturedFaces, ABudgetLimitsThePartsAndTheDeviationIsThatWithinThem) {
    const TextureArea gradient =
        grey_picture(256, 4, [](std::size_t x, std::size_t) { return static_cast<double>(x) / 255; });
    double before = HUGE_VAL;
    for (const std::size_t parts : {0, 2, 4, 8}) {
        Wall wall(gradient);
        wall.add({0, 1, 2, 3});
        wall.cut(gradient, parts);
        EXPECT_EQ(wall.d.faces.size(), std::max<std::size_t>(parts, 1));
        double squares = 0;
        for (const SceneDescription::Face& f : wall.d.faces)
            squares += wall.area(f) / 12 * std::pow(wall.deviation[f.material][0], 2);
        const double expected = 0.8 / std::sqrt(12) / static_cast<double>(std::max<std::size_t>(parts, 1));
        EXPECT_NEAR(std::sqrt(squares), expected, 0.05 * expected) << parts;
        EXPECT_LT(std::sqrt(squares), before);
        before = std::sqrt(squares);
        ASSERT_TRUE(wall.finding) << "the variation that is left is reported";
        EXPECT_NE(wall.finding->message.find("of its mean (RMS)"), std::string::npos);
    }
}

TEST(TexturedFaces, FineRepeatedPatternsAreNotCut) {
    const TextureArea tiles =
        grey_picture(32, 32, [](std::size_t x, std::size_t y) { return x < 16 && y < 16 ? 0.9 : 0.3; });
    Wall wall(tiles);
    wall.add({0, 1, 2, 3});
    wall.cut(tiles, {}, 50);
    EXPECT_EQ(wall.d.faces.size(), 1u);
}

TEST(TexturedFaces, AConcaveFaceIsCutWithoutGaps) {
    const TextureArea tones = grey_picture(64, 64, [](std::size_t x, std::size_t) { return x < 32 ? 1.0 : 0.2; });
    Wall wall(tones);
    wall.d.points.push_back({3, 0, 1});  // a corner that makes the upper border concave
    wall.d.faces.push_back({{0, 1, 2, 4, 3}, 0, 0, 1});
    const double area = wall.total_area();
    TexturedFaces textured(wall.d, max_reflectance, {});
    FaceColours colours;
    colours.reflectance.picture = &tones;
    for (const std::uint32_t c : wall.d.faces[0].corners)
        colours.reflectance.places.push_back({wall.d.points[c].x / 4, 1 - wall.d.points[c].z / 3});
    textured.show(0, colours);
    textured.finish();
    EXPECT_NEAR(wall.total_area(), area, 1e-9);
    const CheckedScene made = make_scene(wall.d);
    ASSERT_TRUE(made.scene);
    EXPECT_EQ(made.scene->regions().size(), 2u);
}

TEST(TexturedFaces, EmittersGetFewParts) {
    const TextureArea sky = grey_picture(
        256, 256, [](std::size_t x, std::size_t y) { return 0.1 + 0.8 * static_cast<double>((x ^ y) & 0xff) / 255; });
    Wall wall(sky);
    wall.add({0, 1, 2, 3});
    wall.d.materials[0].exitance = Spectrum(100 * sky.mean()[0]);
    wall.d.materials[0].reflectance = Spectrum(0.1);
    TexturedFaces textured(wall.d, max_reflectance, 100'000);
    FaceColours colours;
    colours.exitance = wall.colours(0, sky).reflectance;
    textured.show(0, colours);
    textured.finish();
    EXPECT_GT(wall.d.faces.size(), 8u);
    EXPECT_LE(wall.d.faces.size(), 128u);
    double flux = 0;
    for (const SceneDescription::Face& f : wall.d.faces)
        flux += wall.area(f) * wall.d.materials[f.material].exitance[0];
    EXPECT_NEAR(flux, 12 * 100 * sky.mean()[0], 0.01 * flux);
}

TEST(TexturedFaces, ColoursThatVaryBetweenCornersAreCut) {
    const TextureArea white = grey_picture(1, 1, [](std::size_t, std::size_t) { return 1.0; });
    Wall wall(white);
    wall.add({0, 1, 2});
    TexturedFaces textured(wall.d, max_reflectance, {});
    FaceColours colours;
    colours.corner_factors = {Spectrum(0.0), Spectrum(1.0), Spectrum(1.0)};
    textured.show(0, colours);
    textured.finish();
    EXPECT_GT(wall.d.faces.size(), 4u);
    EXPECT_NEAR(wall.total_area(), 6, 1e-9);
    EXPECT_NEAR(wall.reflected(), 6 * 0.8 * 2 / 3, 0.01);
}

TEST(TexturedFaces, ManySmallFacesAreNotCut) {
    const TextureArea tones = grey_picture(64, 64, [](std::size_t x, std::size_t) { return x < 32 ? 0.8 : 0.2; });
    Wall wall(tones);
    constexpr std::uint32_t side = 128;
    for (std::uint32_t k = 0; k < side * side; ++k) {
        const double x = 4.0 * (k % side) / side, y = 3.0 * (k / side) / side;
        const auto first = static_cast<std::uint32_t>(wall.d.points.size());
        for (const Vec2& c : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}})
            wall.d.points.push_back({x + 4 * c.x / side, 0.01 * (k % 2), y + 3 * c.y / side});
        wall.d.faces.push_back({{first, first + 1, first + 2, first + 3}, 0, 0, 1});
    }
    TexturedFaces textured(wall.d, max_reflectance, {});
    for (std::size_t f = 0; f < side * side; ++f) {
        FaceColours colours;
        colours.reflectance = {&tones, {{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
        textured.show(f, colours);
    }
    textured.finish();
    EXPECT_EQ(wall.d.faces.size(), side * side);
}

TEST(TexturedFaces, PartsOfAnEvenEmitterWithABasePictureKeepItsFlux) {
    const TextureArea tones = grey_picture(100, 10, [](std::size_t x, std::size_t) { return x < 50 ? 0.2 : 0.9; });
    Wall wall(tones);
    wall.add({0, 1, 2, 3});
    wall.d.materials[0].exitance = Spectrum(10);
    wall.cut(tones);
    ASSERT_EQ(wall.d.faces.size(), 2u);
    for (const SceneDescription::Face& f : wall.d.faces)
        EXPECT_NEAR(mean(wall.d.materials[f.material].exitance), 10, 1e-9);
}

TEST(TexturedFaces, CoordinatesFarFromThePictureAreCutAsNearOnes) {
    const TextureArea tones = grey_picture(100, 10, [](std::size_t x, std::size_t) { return x < 50 ? 0.2 : 0.9; });
    for (const double far : {0.0, 20'000.0, -300'000.0}) {
        Wall wall(tones);
        wall.add({0, 1, 2, 3});
        TexturedFaces textured(wall.d, max_reflectance, {});
        FaceColours colours = wall.colours(0, tones);
        for (Vec2& place : colours.reflectance.places) place.x += far;
        textured.show(0, colours);
        textured.finish();
        EXPECT_EQ(wall.d.faces.size(), 2u) << far;
    }
}

TEST(TexturedFaces, BothSidesOfASheetAreCutAlikeWithinAnyBudget) {
    const TextureArea dots = grey_picture(
        64, 64, [](std::size_t x, std::size_t y) { return (x / 16 + y / 16) % 2 == 0 && x < 48 ? 0.0 : 1.0; });
    for (const std::size_t budget : {2, 3, 5, 9, 20}) {
        Wall wall(dots);
        wall.d.materials[0].reflectance = Spectrum(0.5);
        wall.add({0, 1, 2, 3}), wall.add({3, 2, 1, 0});
        TexturedFaces textured(wall.d, max_reflectance, budget);
        for (std::size_t f = 0; f < 2; ++f) {
            FaceColours colours;
            colours.coverage = wall.colours(f, dots).reflectance;
            textured.show(f, colours);
        }
        textured.finish();
        const CheckedScene made = make_scene(wall.d);
        ASSERT_TRUE(made.scene) << budget;
        double front = 0;
        for (const Surface& s : made.scene->surfaces()) front += s.normal.y < 0 ? s.area : -s.area;
        EXPECT_NEAR(front, 0, 1e-9) << budget;
    }
}

TEST(TexturedFaces, HolesAreCutOutAndTheAreaIsBalanced) {
    constexpr int size = 64;
    const TextureArea ring = grey_picture(size, size, [](std::size_t x, std::size_t y) {
        return std::hypot(static_cast<double>(x) - 31.5, static_cast<double>(y) - 31.5) < 20 ? 0.0 : 1.0;
    });
    Wall wall(ring);
    wall.d.materials[0].reflectance = Spectrum(0.5);
    wall.add({0, 1, 2, 3}), wall.add({3, 2, 1, 0});  // a face and its back
    TexturedFaces textured(wall.d, max_reflectance, {});
    for (std::size_t f = 0; f < 2; ++f) {
        FaceColours colours;
        colours.coverage = wall.colours(f, ring).reflectance;
        textured.show(f, colours);
    }
    textured.finish();
    EXPECT_NEAR(wall.total_area(), 2 * 12 * ring.mean()[0], 0.02 * 24);
    const CheckedScene made = make_scene(wall.d);
    ASSERT_TRUE(made.scene);
    double front = 0;
    for (const Surface& s : made.scene->surfaces()) front += s.normal.y < 0 ? s.area : -s.area;
    EXPECT_NEAR(front, 0, 1e-9) << "both sides are cut alike";
    ASSERT_TRUE(textured.finding_of_holes());
    EXPECT_NE(textured.finding_of_holes()->message.find("2 faces with holes"), std::string::npos);
}

TEST(TexturedFaces, OfManyFacesWithHolesAsManyStayAsThePicturesCover) {
    const TextureArea leaf = grey_picture(10, 10, [](std::size_t x, std::size_t) { return x < 4 ? 1.0 : 0.0; });
    Wall wall(leaf);
    constexpr std::size_t count = 1000;
    for (std::size_t f = 0; f < count; ++f) wall.add({0, 1, 2, 3});
    TexturedFaces textured(wall.d, max_reflectance, 0);
    for (std::size_t f = 0; f < count; ++f) {
        FaceColours colours;
        colours.coverage = wall.colours(f, leaf).reflectance;
        textured.show(f, colours);
    }
    textured.finish();
    EXPECT_NEAR(static_cast<double>(wall.d.faces.size()), 400, 20);  // the coverage of a face is known to 0.02
}

}  // namespace
}  // namespace exitance
