#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/input_files.hpp"
#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

/// A solution of nothing but a perez sky with a sun at 30 degrees in the south.
std::string write_sky(const TemporaryFolder& folder) {
    write_text(folder / "empty.obj", "# no faces\n");
    EXPECT_EQ(run_program({"solve", folder / "empty.obj", "-o", folder / "sky.h5", "-q", "--sky",
                           "perez,altitude=30,azimuth=180,dni=600,dhi=120"})
                  .status,
              0);
    return folder / "sky.h5";
}

}  // namespace

TEST(ProgramGlare, OfTheOpenSkyAgreesWithItsLight) {
    const TemporaryFolder folder;
    const std::string sky = write_sky(folder);
    const Finished run = run_program({"glare", sky, "--observers", "0,0,1.2 0,-1,0", "--efficacy", "100", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json glare = nlohmann::json::parse(run.out)["observers"][0];
    const nlohmann::json& sun = glare["sources"][0];
    EXPECT_EQ(sun["name"], "sun");
    const double omega = 2 * 3.14159265 * (1 - std::cos(0.533 / 2 * 3.14159265 / 180));
    EXPECT_NEAR(sun["solid_angle"].get<double>() / omega, 1, 2e-3);
    // The sky's own luminance around the sun is not part of the disc.
    EXPECT_NEAR(sun["luminance"].get<double>() / (100 * 600 / omega), 1, 2e-3);
    EXPECT_NEAR(sun["direction"][2].get<double>(), 0.5, 1e-3);
    EXPECT_EQ(glare["class"], "intolerable");
    // Sun: 60,000 lx cos 30; the sky and the ground before the eye add less than 12,000 lx pi / 2 each.
    EXPECT_GT(glare["vertical_illuminance"].get<double>(), 60'000 * std::cos(3.14159265 / 6));
    EXPECT_LT(glare["vertical_illuminance"].get<double>(), 60'000 * std::cos(3.14159265 / 6) + 38'000);
}

TEST(ProgramGlare, ChangesOnlyWhatCountsByTheThreshold) {
    const TemporaryFolder folder;
    const std::string sky = write_sky(folder);
    const auto glare = [&](const std::string& threshold) {
        const Finished run = run_program(
            {"glare", sky, "--observers", "0,0,1.2 0,1,0", "--threshold", threshold, "--efficacy", "20", "--json"});
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(run.out)["observers"][0];
    };
    const nlohmann::json all = glare("0.001"), none = glare("1e9"), multiple = glare("5x");
    EXPECT_EQ(all["vertical_illuminance"], none["vertical_illuminance"]);
    EXPECT_EQ(none["sources"].size(), 0u);
    EXPECT_GT(all["DGP"].get<double>(), none["DGP"].get<double>());
    EXPECT_NEAR(multiple["threshold"].get<double>(), 5 * multiple["mean_luminance"].get<double>(), 1e-6);
    // Sky and ground fill the view.
    EXPECT_NEAR(all["sources"][0]["solid_angle"].get<double>(), 2 * 3.14159265, 1e-4);
}

TEST(ProgramGlare, RefusesWrongInput) {
    const TemporaryFolder folder;
    const std::string sky = write_sky(folder);
    EXPECT_EQ(run_program({"glare", sky}).status, 2);
    EXPECT_EQ(run_program({"glare", sky, "--observers", "0,0,1.2 0,0,0"}).status, 2);
    EXPECT_EQ(run_program({"glare", sky, "--observers", "0,0 1"}).status, 2);
    for (const std::string threshold : {"-1", "0", "x", "nan", "2000 lx"})
        EXPECT_EQ(run_program({"glare", sky, "--observers", "0,0,1.2 0,1,0", "--threshold", threshold}).status, 2)
            << threshold;
    EXPECT_EQ(run_program({"glare", folder / "none.h5", "--observers", "0,0,1.2 0,1,0"}).status, 3);
}

TEST(ProgramGlare, TablesMayNameNormalsAndHoneybeeModelsHaveViews) {
    const TemporaryFolder folder;
    const std::string sky = write_sky(folder);
    const auto observers = [&](const std::string& words) {
        const Finished run = run_program({"glare", sky, "--observers", words, "--json"});
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(run.out)["observers"];
    };
    const std::string rows = "0,0,1.2,0,-1,0\n0,0,1.2,1,0,0\n";
    write_text(folder / "d.csv", "x,y,z,dx,dy,dz\n" + rows);
    write_text(folder / "n.csv", "x,y,z,nx,ny,nz\n" + rows);
    write_text(folder / "m.hbjson",
               R"({"type": "Model", "properties": {"radiance": {"views": [
                 {"identifier": "desk", "position": [0, 0, 1.2], "direction": [0, -1, 0], "up_vector": [0, 0, 1]},
                 {"identifier": "eye", "view_type": "h", "position": [0, 0, 1.2], "direction": [2, 0, 0],
                  "up_vector": [0, 0, 1]},
                 {"identifier": "plan", "view_type": "l", "position": [0, 0, 9], "direction": [0, 0, -1],
                  "up_vector": [0, 1, 0]}]}}})");
    const nlohmann::json expected = observers(folder / "d.csv"), by_normals = observers(folder / "n.csv"),
                         of_model = observers(folder / "m.hbjson");
    EXPECT_EQ(expected, by_normals);
    ASSERT_EQ(of_model.size(), 2u) << "a parallel view has no eye";
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(of_model[i].at("DGP"), expected[i].at("DGP"));
        EXPECT_EQ(of_model[i].at("direction"), expected[i].at("direction"));
    }
    write_text(folder / "part.csv", "x,y,z,nx,ny\n0,0,1.2,0,-1\n");
    write_text(folder / "none.csv", "x,y,z\n0,0,1.2\n");
    for (const std::string file : {"part.csv", "none.csv"})
        EXPECT_EQ(run_program({"glare", sky, "--observers", folder / file}).status, 3);
}

TEST(ProgramGlare, OfAYearIsWrittenPerViewAndHour) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    write_text(folder / "day.epw", weather_of_a_day());
    write_text(folder / "p.csv", "x,y,z,nx,ny,nz\n10,1,0.75,0,0,1\n");
    write_text(folder / "v.csv", "x,y,z,dx,dy,dz\n10,1,1.2,0,1,0\n12,1,1.2,,,\n");
    const auto daylight = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"daylight", scene, "--epw", folder / "day.epw", "--points", folder / "p.csv", "-o",
                                   folder / "year", "-q", "--error", "0.3"});
        return run_program(more);
    };
    const Finished run = daylight({"--views", folder / "v.csv", "--hours", "csv", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json facts = nlohmann::json::parse(run.out);
    EXPECT_EQ(facts["EN17037_glare_views"], 9);
    EXPECT_EQ(facts["EN17037_glare_level"], 0) << "in the open, glare is intolerable";
    const std::string views = read_text(folder / "year/glare.csv"), hours = read_text(folder / "year/glare_hours.csv");
    EXPECT_EQ(std::count(views.begin(), views.end(), '\n'), 10);
    EXPECT_EQ(std::count(hours.begin(), hours.end(), '\n'), 25);
    EXPECT_NE(hours.find("6,21,1,0,0,0,0,0,0,0,0,0\n"), std::string::npos) << "no light at night";
    EXPECT_EQ(daylight({"--views", folder / "v.csv"}).status, 0);
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(folder / "year/glare_hours.npy")));
    write_text(folder / "n.csv", "x,y,z,nx,ny,nz\n10,1,1.2,0,1,0\n");
    EXPECT_EQ(daylight({"--views", folder / "n.csv"}).status, 0);
    const std::string one = read_text(folder / "year/glare.csv");
    EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 2);
    EXPECT_EQ(one.substr(0, one.find('\n', one.find('\n') + 1)),
              views.substr(0, views.find('\n', views.find('\n') + 1)));
    EXPECT_EQ(daylight({"--views", folder / "v.csv", "--part", "1/2"}).status, 2);
    EXPECT_EQ(daylight({"--views", folder / "none.csv"}).status, 3);
    write_text(folder / "bad.csv", "x,y,z,dx,dy,dz\n10,1,1.2,0,0,0\n");
    EXPECT_EQ(daylight({"--views", folder / "bad.csv"}).status, 3);
}

}  // namespace exitance::test
