#include "exitance/io/scenes/radiance/radiance.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/scenes/radiance/round_shapes.hpp"
#include "exitance/io/scenes/radiance/xform.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

class RadianceFiles : public testing::Test {
  protected:
    CheckedScene load(const std::string& text, const std::string& name = "s.rad") {
        EXPECT_TRUE(write_file(folder_ / name, materials + text));
        return load_scene(folder_ / name);
    }
    Scene scene(const std::string& text) {
        CheckedScene out = load(text);
        EXPECT_TRUE(out.scene) << out.scene.error().where << ' ' << out.scene.error().message;
        if (!out.scene) std::abort();
        return std::move(*out.scene);
    }
    std::string first_error(const std::string& text) {
        const CheckedScene out = load(text);
        if (out.scene) return "no error";
        const std::string where = out.scene.error().where;
        return where.substr(where.find_last_of('/') + 1) + ": " + out.scene.error().message;
    }
    static double area(const Scene& scene) {
        double sum = 0;
        for (const Surface& s : scene.surfaces()) sum += s.area;
        return sum;
    }
    static constexpr const char* materials =
        "# line 1\nvoid plastic grey 0 0 5 .5 .4 .3 0 0\nvoid light lamp 0 0 3 10 20 30\n";
    static constexpr const char* square = "polygon square 0 0 12  0 0 0  1 0 0  1 1 0  0 1 0\n";
    TemporaryFolder folder_;
};

}  // namespace

TEST_F(RadianceFiles, ReflectorsHaveTwoSidesAndEmittersOne) {
    const Scene s = scene(std::string("grey ") + square + "lamp polygon l 0 0 9 0 0 1 1 0 1 0 1 1\n");
    ASSERT_EQ(s.surfaces().size(), 3u);
    EXPECT_EQ(s.surfaces()[SurfaceId(0)].normal, (Normal{0, 0, 1}));
    EXPECT_EQ(s.surfaces()[SurfaceId(1)].normal, (Normal{0, 0, -1}));
    EXPECT_EQ(s.surfaces()[SurfaceId(0)].line, 4);
    EXPECT_EQ(s.emitters(), std::vector<SurfaceId>{SurfaceId(2)});
    EXPECT_EQ(s.material(SurfaceId(0)).reflectance[0], 0.5);
    EXPECT_NEAR(s.material(SurfaceId(2)).exitance[0], 10 * pi, 1e-12);
    EXPECT_EQ(s.groups()[s.surfaces()[SurfaceId(2)].group], "l");
}

TEST_F(RadianceFiles, OnlyTheDiffusePartIsReadAndTheRestIsNotedOnce) {
    const CheckedScene s = load(
        "void metal gold 0 0 5 .8 .8 .8 .25 .05\nvoid metal silver 0 0 5 .8 .8 .8 .5 .05\n"
        "void trans paper 0 0 7 .8 .8 .8 0 0 .5 0\nvoid glass pane 0 0 3 .9 .9 .9\n"
        "gold polygon a 0 0 9 0 0 0 1 0 0 0 1 0\nsilver polygon b 0 0 9 0 0 1 1 0 1 0 1 1\n"
        "paper polygon c 0 0 9 0 0 2 1 0 2 0 1 2\npane polygon d 0 0 9 0 0 3 1 0 3 0 1 3\n");
    ASSERT_TRUE(s.scene);
    EXPECT_EQ(s.scene->surfaces().size(), 6u) << "glass is no surface";
    ASSERT_EQ(s.scene->panes().size(), 1u);
    EXPECT_EQ(s.scene->panes()[0].transmissivity[0], 0.9);
    EXPECT_EQ(s.scene->panes()[0].index, 1.52);
    EXPECT_NEAR(s.scene->material(SurfaceId(0)).reflectance[0], 0.6, 1e-12);
    EXPECT_NEAR(s.scene->material(SurfaceId(2)).reflectance[0], 0.4, 1e-12);
    EXPECT_NEAR(s.scene->material(SurfaceId(4)).reflectance[0], 0.8, 1e-12);
    EXPECT_NEAR(s.scene->material(SurfaceId(4)).through, 0.5, 1e-12);
    EXPECT_EQ(s.scene->behind(s.scene->surfaces()[SurfaceId(4)].region), s.scene->surfaces()[SurfaceId(5)].region);
    const auto about = [&](const std::string& what) {
        return std::count_if(s.findings.begin(), s.findings.end(),
                             [&](const Finding& f) { return f.message.find(what) != f.message.npos; });
    };
    EXPECT_EQ(about("specular"), 1);
    EXPECT_EQ(about("goes through"), 0);
}

TEST_F(RadianceFiles, RoundShapesHaveTheRightArea) {
    EXPECT_NEAR(area(scene("lamp sphere s 0 0 4 1 2 3 0.5\n")), pi, 1e-9);
    for (const char* const kind : {"sphere", "bubble"})  // both sides reflect
        EXPECT_NEAR(area(scene(std::string("grey ") + kind + " s 0 0 4 1 2 3 0.5\n")), 2 * pi, 1e-9) << kind;
    EXPECT_NEAR(area(scene("lamp cylinder s 0 0 7 0 0 0 1 1 1 0.5\n")), pi * std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(area(scene("lamp ring s 0 0 8 0 0 0 1 1 1 0.5 1\n")), 0.75 * pi, 1e-9);
    for (const double height : {0.01, 1.0, 10.0}) {
        const double exact = pi * std::hypot(1, height);
        EXPECT_NEAR(area(scene("lamp cone s 0 0 8 0 0 0 0 0 " + std::to_string(height) + " 1 0\n")), exact,
                    0.005 * exact);
    }
}

TEST_F(RadianceFiles, CylindersAndConesFaceOutTubesAndCupsIn) {
    const auto outwards = [&](const std::string& text) {
        const Scene s = scene(text);
        std::size_t count = 0;
        for (SurfaceId id : s.surfaces().ids()) {
            const Vec3 middle = centroid(s.outline(id));
            count += dot(s.surfaces()[id].normal, Vec3{middle.x, middle.y, 0}) > -1e-9;
        }
        return std::pair(count, s.surfaces().size());
    };
    for (const char* type : {"cylinder s 0 0 7 0 0 0 0 0 1 1", "cone s 0 0 8 0 0 0 0 0 1 1 0.5"}) {
        const auto [out, all] = outwards(std::string("lamp ") + type + '\n');
        EXPECT_EQ(out, all) << type;
    }
    for (const char* type : {"tube s 0 0 7 0 0 0 0 0 1 1", "cup s 0 0 8 0 0 0 0 0 1 1 0.5"})
        EXPECT_EQ(outwards(std::string("lamp ") + type + '\n').first, 0u) << type;
    for (const auto& facet : sphere_facets({1, 2, 3}, 2))
        EXPECT_GT(dot(area_vector(facet), centroid(facet) - Point{1, 2, 3}), 0);
}

TEST_F(RadianceFiles, XformIsEvaluatedWithoutTheProgram) {
    ASSERT_TRUE(write_file(folder_ / "part.rad", std::string("lamp ") + square));
    const Scene s = scene("!xform -n row -rz 90 -s 2 -t 0 0 1 -a 3 -t 5 0 0 \\\n part.rad\n");
    ASSERT_EQ(s.surfaces().size(), 3u);
    EXPECT_EQ(s.groups()[GroupId(0)], "row.square");
    for (std::size_t i = 0; i < 3; ++i) {
        const Surface& surface = s.surfaces()[SurfaceId(i)];
        EXPECT_NEAR(surface.area, 4, 1e-12);
        EXPECT_EQ(surface.normal, (Normal{0, 0, 1}));
        EXPECT_EQ(s.outline(SurfaceId(i))[0], (Point{5.0 * static_cast<double>(i), 0, 1}));
        EXPECT_EQ(s.outline(SurfaceId(i))[1], (Point{5.0 * static_cast<double>(i), 2, 1}));
        EXPECT_EQ(surface.line, 6 + 1) << "lines of further files are counted on";
    }
    const Scene mirrored = scene("!xform -mz part.rad\n");
    EXPECT_EQ(mirrored.surfaces()[SurfaceId(0)].normal, (Normal{0, 0, -1}));
}

TEST_F(RadianceFiles, XformSupportsSeveralFilesAndAMaterialForAll) {
    ASSERT_TRUE(write_file(folder_ / "part.rad", std::string("lamp ") + square));
    ASSERT_TRUE(
        write_file(folder_ / "other.rad", "void plastic own 0 0 5 .1 .1 .1 0 0\n!xform -m own -t 5 0 0 part.rad\n"));
    const Scene s = scene("!xform -m lamp -t 0 0 3 part.rad other.rad\n!xform -m grey part.rad\n");
    ASSERT_EQ(s.surfaces().size(), 4u);  // reflecting faces have two sides
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_GT(mean(s.material(SurfaceId(i)).exitance), 0) << "the material of the outer command";
        EXPECT_EQ(s.outline(SurfaceId(i))[0].z, 3);
    }
    EXPECT_EQ(mean(s.material(SurfaceId(2)).exitance), 0);
}

TEST_F(RadianceFiles, MaterialsWithGlossFunctionsKeepTheirDiffusePart) {
    const Scene s = scene(
        "void plasfunc a 2 f f.cal 0 4 .5 .4 .3 .2\na polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n"
        "void BRTDfunc b 10 0 0 0 0 0 0 0 0 0 . 0 9 .1 .2 .3 .1 .2 .3 0 0 0\nb polygon q 0 0 9 0 0 1 1 0 1 0 1 1\n"
        "void transfunc c 2 f f.cal 0 6 .5 .5 .5 .1 .5 0\nc polygon r 0 0 9 0 0 2 1 0 2 0 1 2\n"
        "void ashik2 d 4 0 0 1 . 0 8 .6 .6 .6 .1 .1 .1 9 9\nd polygon t 0 0 9 0 0 3 1 0 3 0 1 3\n");
    ASSERT_EQ(s.surfaces().size(), 8u);
    EXPECT_NEAR(s.material(SurfaceId(0)).reflectance[0], 0.8 * 0.5, 1e-15);
    EXPECT_NEAR(s.material(SurfaceId(2)).reflectance[2], 0.3, 1e-15);
    EXPECT_EQ(s.material(SurfaceId(6)).reflectance[1], 0.6);
}

TEST_F(RadianceFiles, LightPassesSurfacesOfVoid) {
    const CheckedScene s = load(std::string("void ") + square + "lamp " + square);
    ASSERT_TRUE(s.scene) << s.scene.error().message;
    EXPECT_EQ(s.scene->surfaces().size(), 1u);
    EXPECT_EQ(s.findings.size(), 1u);
}

TEST_F(RadianceFiles, PlainBoxesNeedNoProgram) {
    const Scene out = scene("!genbox lamp box 1 2 3\n"), in = scene("!genbox lamp box 1 2 3 -i | xform -t 5 0 0\n");
    ASSERT_EQ(out.surfaces().size(), 6u);
    ASSERT_EQ(in.surfaces().size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        const SurfaceId id(i);
        EXPECT_GT(dot(out.surfaces()[id].normal, centroid(out.outline(id)) - Point{0.5, 1, 1.5}), 0);
        EXPECT_LT(dot(in.surfaces()[id].normal, centroid(in.outline(id)) - Point{5.5, 1, 1.5}), 0);
    }
    EXPECT_EQ(out.groups()[GroupId(0)], "box.1540");
}

TEST(Xform, ArraysMakeGridsAndIterationsRepeat) {
    const auto parsed = parse_xform({"-a", "2", "-t", "1", "0", "0", "-a", "3", "-t", "0", "1", "0", "f"}, 100);
    ASSERT_TRUE(parsed);
    ASSERT_EQ(parsed->copies.size(), 6u);
    EXPECT_EQ(parsed->copies[5].origin, (Point{1, 2, 0}));
    const auto repeated = parse_xform({"-i", "3", "-rz", "30", "-i", "1", "-t", "0", "0", "1", "f"}, 100);
    ASSERT_TRUE(repeated);
    EXPECT_NEAR(norm(repeated->copies[0].x - Vec3{0, 1, 0}), 0, 1e-12);
    EXPECT_EQ(repeated->copies[0].origin, (Point{0, 0, 1}));
    EXPECT_FALSE(parse_xform({"-a", "1000000000", "-t", "1", "0", "0", "f"}, 100));
    EXPECT_FALSE(parse_xform({"-a", "50", "-a", "50", "f"}, 100));
}

TEST_F(RadianceFiles, OtherCommandsAreErrorsWithAHint) {
    const CheckedScene s = load("!genbox grey box 1 2 3 -r 0.1\n");
    ASSERT_FALSE(s.scene);
    EXPECT_EQ(s.scene.error().where, folder_ / "s.rad:4");
    EXPECT_NE(s.scene.error().message.find("genbox"), std::string::npos);
    EXPECT_NE(first_error("!genbox grey box 1 -2 3\n").find("'-2'"), std::string::npos);
    EXPECT_NE(s.scene.error().hint.find("!xform"), std::string::npos);
    EXPECT_NE(first_error("!xform a.rad | sort\n").find("not run"), std::string::npos);
    EXPECT_NE(first_error("!genbox grey box 1 2 3; rm -r /\n").find("it needs a shell"), std::string::npos);
    EXPECT_NE(first_error("!xform absent.rad\n").find("absent.rad"), std::string::npos);
    EXPECT_NE(first_error("!xform s.rad\n").find("calls itself"), std::string::npos);
}

TEST_F(RadianceFiles, AliasesAndPatternsResolveToTheirMaterial) {
    const Scene s = scene(
        "void alias stone grey\ngrey brightfunc dirt 2 dirt dirt.cal 0 1 .5\n"
        "stone polygon a 0 0 9 0 0 0 1 0 0 0 1 0\ndirt polygon b 0 0 9 0 0 1 1 0 1 0 1 1\n"
        "lamp polygon c 0 0 9 0 0 2 1 0 2 0 1 2\n");
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(s.material(SurfaceId(i)).name, "grey");
}

TEST_F(RadianceFiles, WordsMayBeQuoted) {
    const Scene s = scene(
        "'void' plastic \"a #name with blanks\" 0 0 5 .5 .4 .3 0 0\n'a #name with blanks' polygon '!p' 0 0 9 0 0 0 1 0 "
        "0 0 1 0\n"
        "lamp polygon c 0 0 9 0 0 2 1 0 2 0 1 2\n");
    ASSERT_EQ(s.surfaces().size(), 3u);
    EXPECT_EQ(s.material(SurfaceId(0)).name, "a #name with blanks");
    EXPECT_EQ(s.groups()[GroupId(0)], "!p");
    EXPECT_EQ(first_error("'void plastic a 0 0 5 .5 .4 .3 0 0\n"), "s.rad:4: a quoted word does not end on its line");
    EXPECT_EQ(first_error("void plastic 'a 0 0 5 .5 .4 .3 0 0\n"), "s.rad:4: a quoted word does not end on its line");
}

TEST_F(RadianceFiles, PatternsMayBeNestedAndMixturesUseTheirFirstMaterial) {
    const CheckedScene s = load(
        "void brightfunc dusty 4 dirt dirt.cal -s 2 0 1 .15\ndusty texfunc rough 2 a b.cal 0 0\n"
        "rough plastic tile 0 0 5 .5 .5 .5 0 0\ntile colorfunc spots 4 r g b c.cal 0 0\nspots brightfunc more 2 a "
        "b.cal 0 0\n"
        "void mixfunc half 4 void tile half half.cal 0 0\n"
        "more polygon p 0 0 9 0 0 0 1 0 0 0 1 0\nhalf polygon q 0 0 9 0 0 1 1 0 1 0 1 1\n"
        "lamp polygon c 0 0 9 0 0 2 1 0 2 0 1 2\n");
    ASSERT_TRUE(s.scene) << s.scene.error().message;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(s.scene->material(SurfaceId(i)).name, "tile");
    const auto notes = std::count_if(s.findings.begin(), s.findings.end(), [](const Finding& f) {
        return f.message.find("patterns and textures") != f.message.npos;
    });
    EXPECT_EQ(notes, 1);
    EXPECT_EQ(first_error("void brightfunc a 2 a b.cal 0 0\na polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n"),
              "s.rad:5: 'p' has no supported material");
}

TEST_F(RadianceFiles, UnreadablePatternsOfEmittersAreErrors) {
    const std::string pattern = "lamp brightfunc d 2 ripple ripple.cal 0 0\n";
    EXPECT_EQ(first_error(pattern + "d polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n"),
              "s.rad:5: 'p' emits by the brightfunc 'd', which cannot be read: the function 'ripple' is not known");
    const CheckedScene unused = load(pattern + std::string("lamp ") + square);
    EXPECT_TRUE(unused.scene) << "a distribution that no face has changes nothing";
    const CheckedScene sky = load(pattern + std::string("d source s 0 0 4 0 0 1 180\nlamp ") + square);
    EXPECT_TRUE(sky.scene) << "skies are left out, and said";
}

TEST_F(RadianceFiles, TheSunIsADisc) {
    const Scene s = scene(std::string("lamp source sun 0 0 4 0 1 1 0.5\ngrey ") + square);
    ASSERT_EQ(s.distant().discs.size(), 1u);
    const DistantLight::Disc& sun = s.distant().discs[0];
    EXPECT_NEAR(norm(sun.towards - Vec3{0, std::sqrt(0.5), std::sqrt(0.5)}), 0, 1e-12);
    EXPECT_NEAR(sun.half_angle, 0.25 * pi / 180, 1e-15);
    EXPECT_NEAR(sun.irradiance[0], 10 * pi * std::pow(std::sin(0.25 * pi / 180), 2), 1e-15);
}

TEST_F(RadianceFiles, LinesOfGenskyAndGendaylitNeedNoProgram) {
    const std::string glow = "skyfunc glow sky_glow 0 0 4 1 1 1 0\nsky_glow source sky 0 0 4 0 0 1 180\ngrey ";
    for (const char* line :
         {"!gensky 3 20 10 -a 40 -o 98 -m 105", "!gendaylit 3 20 10 -a 40 -o 98 -m 105 -W 600 100"}) {
        const Scene s = scene(std::string(line) + "\n" + glow + square);
        ASSERT_EQ(s.distant().discs.size(), 1u) << line;
        EXPECT_NEAR(s.distant().discs[0].towards.z, 0.685564, 1e-6) << line;  // computed by hand, period 365
        EXPECT_EQ(s.distant().domes.size(), 1u) << line;
        const Scene turned = scene(std::string(line) + " | xform -rz 90\n" + glow + square);
        EXPECT_NEAR(turned.distant().discs[0].towards.x, -s.distant().discs[0].towards.y, 1e-9) << line;
    }
}

TEST_F(RadianceFiles, SkiesOfGenskyAndGendaylitAreReadInClosedForm) {
    const std::string glow =
        "skyfunc glow sky_glow 0 0 4 0.9 0.8 1.1 0\nsky_glow source sky 0 0 4 0 0 1 180\n"
        "skyfunc glow ground_glow 0 0 4 1.4 .9 .6 0\nground_glow source ground 0 0 4 0 0 -1 180\ngrey ";
    const Vec3 sun{0.3, -0.4, std::sqrt(0.75)}, w = normalized(Vec3{0.5, 0.6, 0.7});
    const double cosine = dot(sun, w), gamma = std::acos(cosine), weight = std::pow(w.z + 1.01, 10);
    const auto blended = [&](double sky, double ground) {
        return (weight * sky + ground / weight) / (weight + 1 / weight);
    };
    const auto radiance = [&](const std::string& pattern) {
        const Scene s = scene(pattern + glow + square);
        EXPECT_EQ(s.distant().domes.size(), 2u);
        const DistantLight::Dome& dome = s.distant().domes[0];
        EXPECT_FALSE(dome.model.below);
        EXPECT_TRUE(s.distant().domes[1].model.below);
        return dome.model.relative(w) * dome.irradiance[0] / pi;
    };
    const double clear =
        50 * (0.91 + 10 * std::exp(-3 * gamma) + 0.45 * cosine * cosine) * (1 - std::exp(-0.32 / w.z)) / 2;
    EXPECT_NEAR(radiance("void brightfunc skyfunc 2 skybr skybright.cal 0 7 1 50 8 2 0.3 -0.4 0.866025403784\n"),
                0.9 * blended(clear, 8), 1e-6 * clear);
    EXPECT_NEAR(radiance("void brightfunc skyfunc 2 skybr skybright.cal 0 3 2 50 8\n"),
                0.9 * blended(50 * (1 + 2 * w.z) / 3, 8), 1e-4);
    const double perez =
        3 * (1 - 0.9 * std::exp(-0.4 / w.z)) * (1 + 8 * std::exp(-2.5 * gamma) + 0.3 * cosine * cosine);
    EXPECT_NEAR(
        radiance(
            "void brightfunc skyfunc 2 skybright perezlum.cal 0 10 3 8 -.9 -.4 8 -2.5 .3 0.3 -0.4 0.866025403784\n"),
        0.9 * blended(perez, 8), 1e-6 * perez);
}

TEST_F(RadianceFiles, AnEmittingSphereAroundTheSceneIsAUniformSky) {
    const Scene around = scene(std::string("lamp bubble b 0 0 4 0 0 0 50\ngrey ") + square);
    EXPECT_EQ(around.surfaces().size(), 2u);
    ASSERT_EQ(around.distant().domes.size(), 2u);
    EXPECT_NEAR(around.distant().domes[0].irradiance[0], 10 * pi, 1e-9);
    const Scene beside = scene(std::string("lamp bubble b 0 0 4 5 0 0 0.5\ngrey ") + square);
    EXPECT_TRUE(beside.distant().empty());
    EXPECT_GT(beside.surfaces().size(), 100u);
}

TEST_F(RadianceFiles, ErrorsNameFileAndLine) {
    EXPECT_EQ(first_error("grey polygon a 0 0 9 0 0 0 1 0 0 0 x 0\n"), "s.rad:4: 'x' is not a finite number");
    EXPECT_EQ(first_error("grey polygon a 0 0 8 0 0 0 1 0 0 0 1\n"), "s.rad:4: polygon 'a' has 8 numbers");
    EXPECT_EQ(first_error("grey polygon a 0 0 99 0 0 0\n"), "s.rad:4: the file ends within 'a'");
    EXPECT_EQ(first_error("blue polygon a 0 0 9 0 0 0 1 0 0 0 1 0\n"),
              "s.rad:4: material 'blue' is not defined before 'a'");
    EXPECT_EQ(first_error("grey instance a 1 b.oct 0 0\n"),
              "s.rad:4: instance 'a' is in a compiled file, which is not supported");
}

}  // namespace exitance
