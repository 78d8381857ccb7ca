#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <tuple>

#include "exitance/base/polygon.hpp"
#include "exitance/io/photometry/luminaire_body.hpp"
#include "exitance/io/photometry/photometric_file.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

/// Text of an IES file, of type C by default, with the given opening and angles and I = f(theta, phi).
template <class F>
std::string ies(const std::string& opening, const std::vector<double>& vertical, const std::vector<double>& horizontal,
                F f, const std::string& edition = "IESNA:LM-63-2002", int type = 1) {
    std::string text = edition + "\n[TEST] own\nTILT=NONE\n1 -1 1 " + std::to_string(vertical.size()) + " " +
                       std::to_string(horizontal.size()) + " " + std::to_string(type) + " 2 " + opening + "\n1 1 10\n";
    for (const double v : vertical) text += std::to_string(v) + " ";
    for (const double h : horizontal) text += "\n" + std::to_string(h);
    for (const double h : horizontal)
        for (const double v : vertical) text += "\n" + std::to_string(f(v * degree, h * degree));
    return text;
}

std::vector<double> steps(double from, double to, double by) {
    std::vector<double> out;
    for (double v = from; v <= to + 1e-9; v += by) out.push_back(v);
    return out;
}

double cosine(double t, double) {
    return 1000 * std::max(0.0, std::cos(t));
}

Photometry read(const std::string& text) {
    Result<Photometry> out = read_ies(text, "own.ies");
    EXPECT_TRUE(out) << out.error().message;
    return std::move(*out);
}

Vec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta)};
}

TEST(Photometry, SamplesHaveTheExpectedFluxAndBadOnesAreErrors) {
    const std::filesystem::path folder = std::filesystem::path(test::data_folder()) / "formats/samples";
    std::ifstream in(folder / "expected.json");
    const nlohmann::json all = nlohmann::json::parse(in);
    for (const auto& [name, expected] : all.items()) {
        const Result<Photometry> p = load_photometry((folder / name).string());
        if (expected.contains("error")) {
            EXPECT_TRUE(!p && p.error().code == ErrorCode::bad_input) << name;
            continue;
        }
        ASSERT_TRUE(p) << name << ": " << p.error().message;
        EXPECT_NEAR(p->flux() / expected["flux_bilinear_lm"].get<double>(), 1, 1e-6) << name;
    }
}

TEST(Photometry, EverySymmetryIsExpanded) {
    const auto f = [](double t, double p) { return 100 * std::max(0.0, std::cos(t)) * (2 + std::cos(2 * p)); };
    const std::vector<double> v = steps(0, 90, 5);
    const Photometry full = read(ies("0.6 0.6 0", v, steps(0, 360, 10), f));
    for (const auto& h : {steps(0, 90, 10), steps(0, 180, 10), steps(90, 270, 10), steps(0, 350, 10)}) {
        const Photometry p = read(ies("0.6 0.6 0", v, h, f));
        EXPECT_NEAR(p.flux() / full.flux(), 1, 1e-9);
        for (double phi = 0; phi < 2 * pi; phi += 0.3)
            EXPECT_NEAR(p.intensity(direction(0.7, phi)), full.intensity(direction(0.7, phi)), 1e-3) << phi;
    }
}

TEST(Photometry, IntensityIsZeroBeyondTheTablesAngles) {
    const Photometry p = read(ies("0.6 0.6 0", steps(0, 60, 10), {0}, [](double, double) { return 100; }));
    EXPECT_DOUBLE_EQ(p.intensity(direction(59.9 * degree, 1)), 100);
    EXPECT_DOUBLE_EQ(p.intensity(direction(60.1 * degree, 1)), 0);
    EXPECT_NEAR(p.flux(), 2 * pi * 100 * 0.5, 1e-3);
}

TEST(Photometry, TypesAAndBHaveTheirBeamAlongTheAxis) {
    // Brightest at V = 30 degrees, H = -20: towards +x and -y of the luminaire.
    const auto f = [](double v, double h) {
        return 1000 * std::max(0.0, 1 - 2 * (std::abs(v - pi / 6) + std::abs(h + pi / 9)));
    };
    for (const int type : {2, 3}) {
        const Photometry p = read(ies("0.3 0.3 0", steps(-90, 90, 10), steps(-90, 90, 10), f, "IESNA91", type));
        const double v = pi / 6, h = -pi / 9;
        const Vec3 peak = type == 2 ? Vec3{std::cos(h) * std::sin(v), std::sin(h), -std::cos(h) * std::cos(v)}
                                    : Vec3{std::sin(v), std::cos(v) * std::sin(h), -std::cos(v) * std::cos(h)};
        EXPECT_NEAR(p.intensity(peak), 1000, 1e-3) << type;
        EXPECT_DOUBLE_EQ(p.intensity({-peak.x, -peak.y, -peak.z}), 0);
    }
}

TEST(Photometry, BeamAndFieldAnglesOfACosine) {
    const Photometry down = read(ies("0.6 0.6 0", steps(0, 90, 1), {0}, cosine));
    EXPECT_NEAR(beam_spread(down, {1, 0, 0}, 0.5).whole(), 120, 0.01);
    EXPECT_NEAR(beam_spread(down, {0, 1, 0}, 0.1).whole(), 2 * 84.26, 0.01);
    const Photometry up =
        read(ies("0.6 0.6 0", steps(90, 180, 1), {0}, [](double t, double) { return -1000 * std::cos(t) + 1e-9; }));
    EXPECT_NEAR(beam_spread(up, {1, 0, 0}, 0.5).whole(), 120, 0.01);
}

Box extent(const LuminaireBody& body) {
    Box box;
    for (const LuminaireBody::Face& face : body.faces)
        for (const Point& p : face.corners) box.add(p);
    return box;
}

/// Total intensity of all faces, far away: sum of L A cos.
double far_intensity(const LuminaireBody& body, const Vec3& d) {
    double sum = 0;
    for (const LuminaireBody::Face& face : body.faces) {
        const Vec3 area = area_vector(face.corners);
        const double above = dot(area, d);
        if (face.exitance > 0 && above > 0) sum += above * body.profile.radiance(body.in_frame(d), above / norm(area));
    }
    return sum;
}

TEST(LuminaireBody, EveryShapeHasTheFilesFluxAndIntensity) {
    const auto f = [](double t, double p) {
        return 300 + 200 * std::cos(t) * (1 + 0.3 * std::sin(t) * std::cos(p)) + 50 * std::sin(t) * std::sin(p);
    };
    for (const char* opening : {"0 0 0", "0.3 0.6 0", "-0.4 -0.4 0", "0.3 0.6 0.2", "-0.3 -0.3 0.5", "1.2 -0.1 -0.1",
                                "-0.016 1.2 -0.016", "-0.02 -0.02 1.2"}) {
        const Photometry p = read(ies(opening, steps(0, 180, 10), steps(0, 360, 15), f));
        const LuminaireBody body = make_luminaire_body(p);
        ASSERT_TRUE(body.profile.is_sane()) << opening;
        EXPECT_NEAR(body.flux() / p.flux(), 1, 1e-3) << opening;
        double worst = 0;
        for (int i = 0; i < 1000; ++i) {  // Fibonacci points
            const double z = 1 - (2 * i + 1) / 1000.0, phi = i * 2.399963229728653, r = std::sqrt(1 - z * z);
            const Vec3 d{r * std::cos(phi), r * std::sin(phi), z};
            if (p.opening.size.z == 0 && std::abs(z) < 0.02) continue;  // an opening seen edge-on
            worst = std::max(worst, std::abs(far_intensity(body, d) / p.intensity(d) - 1));
        }
        EXPECT_LT(worst, 1e-3) << opening;
    }
}

TEST(LuminaireBody, OfABoxWithDarkSidesEmitsFromItsLuminousParts) {
    const auto f = [](double t, double p) { return 300 + 200 * std::cos(t) * (1 + 0.3 * std::sin(t) * std::cos(p)); };
    for (const Vec2& dark : {Vec2{0.2, 0}, Vec2{0, 0.2}, Vec2{0.15, 0}, Vec2{0, 0.05}}) {
        Photometry p = read(ies("0.3 0.6 0.2", steps(0, 180, 10), steps(0, 360, 15), f));
        p.opening.dark_x = dark.x, p.opening.dark_y = dark.y;
        const LuminaireBody body = make_luminaire_body(p);
        EXPECT_EQ(extent(body).size(), (Vec3{0.6, 0.3, 0.2})) << "dark parts keep the body closed";
        double lit_x = 0, lit_y = 0;
        for (const LuminaireBody::Face& face : body.faces) {
            const Vec3 area = area_vector(face.corners);
            if (face.exitance > 0) lit_x += std::abs(area.x), lit_y += std::abs(area.y);
        }
        EXPECT_NEAR(lit_x, 2 * 0.3 * (0.2 - dark.x), 1e-12);
        EXPECT_NEAR(lit_y, 2 * 0.6 * (0.2 - dark.y), 1e-12);
        for (const double theta : {0.2, 1.0, 1.5, 2.4})
            for (const double phi : {0.1, 0.9, 1.4, 2.9, 4.4}) {
                const Vec3 d = direction(theta, phi);
                EXPECT_NEAR(far_intensity(body, d) / p.intensity(d), 1, 1e-3) << theta << ' ' << phi;
            }
    }
}

TEST(LuminaireBody, TypeBKeepsItsFluxForEveryShape) {
    const auto f = [](double v, double h) { return 1000 * std::pow(std::cos(v) * std::cos(h), 3); };
    for (const char* opening : {"0.3 0.6 0", "0.3 0.3 0.2"}) {
        const Photometry p = read(ies(opening, steps(-90, 90, 5), steps(0, 90, 5), f, "IESNA:LM-63-2002", 2));
        EXPECT_NEAR(make_luminaire_body(p).flux() / p.flux(), 1, 1e-3) << opening;
    }
}

TEST(LuminaireBody, KeepsEveryExtentOfTheFile) {
    const auto even = [](double, double) { return 100.0; };
    struct Case {
        const char* opening;  // width, length and height in the file's order, metres
        Vec3 size;            // size along C0, C90 and upwards, metres
    };
    for (const Case& c : {Case{"0.024 0.599 0.001", {0.599, 0.024, 0.001}}, Case{"0.6 0.002 0.05", {0.002, 0.6, 0.05}},
                          Case{"0.0004 0.3 0", {0.3, 0.0004, 0}}, Case{"0.004 0.004 0", {0.004, 0.004, 0}},
                          Case{"0.003 1.2 0.003", {1.2, 0.003, 0.003}}}) {
        const Box box = extent(make_luminaire_body(read(ies(c.opening, steps(0, 180, 10), {0}, even))));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(box.size()[k], c.size[k], 1e-12) << c.opening;
    }
    // Round openings are polygons of the same area, about 1.2% wider than the circle at their corners.
    for (const auto& [opening, diameter, height] : {std::tuple{"-0.066 -0.066 0.001", 0.066, 0.001},
                                                    {"-0.003 -0.003 0.4", 0.003, 0.4},
                                                    {"-0.002 -0.002 0", 0.002, 0.0}}) {
        const Box box = extent(make_luminaire_body(read(ies(opening, steps(0, 180, 10), {0}, even))));
        EXPECT_NEAR(box.size().x / diameter, 1, 0.02) << opening;
        EXPECT_NEAR(box.size().z, height, 1e-12) << opening;
    }
}

TEST(LuminaireBody, AddsAnExtentOnlyIfTheFileHasNone) {
    const auto even = [](double, double) { return 100.0; };
    const Box line = extent(make_luminaire_body(read(ies("0 1.2 0", steps(0, 180, 10), {0}, even))));
    EXPECT_EQ(line.size(), (Vec3{1.2, strip_width, 0}));
    const Box wall = extent(make_luminaire_body(read(ies("0 1.2 0.3", steps(0, 180, 10), {0}, even))));
    EXPECT_NEAR(wall.size().y, strip_width, 1e-12);
    EXPECT_NEAR(wall.size().z, 0.3, 1e-12);
    const Box point = extent(make_luminaire_body(read(ies("0 0 0", steps(0, 180, 10), {0}, even))));
    EXPECT_EQ(point.size(), (Vec3{0.001, 0.001, 0.001}));
}

/// Text of an EULUMDAT file with constant intensity below the horizontal. The opening is 600 x 300 mm or round, with
/// the given luminous heights, mm.
std::string eulumdat(const std::string& length_and_width, const std::string& heights) {
    return "maker\n3\n1\n1\n0\n3\n45\nreport\nlamp\nnumber\nfile\ndate\n700\n400\n100\n" + length_and_width + heights +
           "100\n100\n1\n0\n1\n1\nLED\n1000\n3000\n80\n10\n0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n0\n45\n90\n100\n100\n100\n";
}

TEST(PhotometricFile, ReadsTheLuminousHeightOfEachSide) {
    const auto read_opening = [](const std::string& text, std::size_t warnings) {
        const Result<Photometry> p = read_eulumdat(text, "own.ldt");
        EXPECT_TRUE(p) << p.error().message;
        std::size_t differ = 0;
        for (const Finding& f : p->findings)
            differ += f.message.find("the luminous heights in C0") != std::string::npos;
        EXPECT_EQ(differ, warnings) << text;
        return p->opening;
    };
    const Opening even = read_opening(eulumdat("600\n300\n", "50\n50\n50\n50\n"), 0);
    EXPECT_EQ(even.size, (Vec3{0.3, 0.6, 0.05}));
    EXPECT_EQ(even.dark_x, 0);
    EXPECT_EQ(even.dark_y, 0);
    const Opening ends = read_opening(eulumdat("600\n300\n", "50\n0\n50\n0\n"), 0);
    EXPECT_EQ(ends.size.z, 0.05);
    EXPECT_EQ(ends.dark_x, 0);
    EXPECT_EQ(ends.dark_y, 0.05);
    EXPECT_EQ(read_opening(eulumdat("600\n300\n", "50\n0\n10\n0\n"), 1).size.z, 0.05);
    EXPECT_EQ(read_opening(eulumdat("600\n0\n", "50\n50\n50\n50\n"), 0).shape, Opening::Shape::cylinder_z);
    EXPECT_EQ(read_opening(eulumdat("600\n0\n", "50\n0\n50\n50\n"), 1).size.z, 0.05);
}

TEST(PhotometricFile, WarnsOfMissingExtents) {
    const TemporaryFolder folder;
    const auto warnings = [&](const char* opening) {
        std::ofstream(folder / "l.ies") << ies(opening, steps(0, 90, 10), {0}, cosine);
        const Result<Photometry> p = load_photometry(folder / "l.ies");
        EXPECT_TRUE(p) << opening;
        std::string text;
        for (const Finding& f : p->findings)
            if (f.kind == Finding::Kind::warning) text += f.message;
        return text;
    };
    EXPECT_EQ(warnings("0.024 0.599 0.001"), "");
    EXPECT_EQ(warnings("-0.002 -0.002 0"), "");
    EXPECT_NE(warnings("0 1.2 0").find("no extent in some direction: 1 cm"), std::string::npos);
    EXPECT_NE(warnings("0 0 0").find("a cube of 1 mm"), std::string::npos);
}

TEST(LuminaireBody, APlaneOpeningEmitsOnlyWhereTheTableDoes) {
    EXPECT_EQ(make_luminaire_body(read(ies("0.6 1.2 0", steps(0, 90, 5), {0}, cosine))).faces.size(), 1u);
    const Photometry both =
        read(ies("0.6 1.2 0", steps(0, 180, 5), {0}, [](double t, double) { return std::abs(std::cos(t)); }));
    EXPECT_EQ(make_luminaire_body(both).faces.size(), 2u);
}

}  // namespace
}  // namespace exitance
