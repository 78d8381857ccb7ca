#include <gtest/gtest.h>

#include <algorithm>

#include "cli/small_scene.hpp"
#include "exitance/io/solution/solution_file.hpp"
#include "support/sample_solution.hpp"

namespace exitance::test {

TEST(ProgramRender, MakesAPictureOfTheRequestedSizeAndRejectsOtherEndings) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", picture = folder / "room.png";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    Finished run = run_program(
        {"render", solution, "-o", picture, "--size", "40x25", "--samples", "1", "--exposure", "-1", "--mesh"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(read_text(picture).starts_with("\x89PNG"));
    EXPECT_NE(read_text(picture).find("-1 stops"), std::string::npos);
    const std::size_t told = run.err.find("--exposure ");
    ASSERT_NE(told, std::string::npos) << "what would make the same picture is said";
    const std::string factor = run.err.substr(told + 11, run.err.find('\n', told) - told - 11);
    run = run_program({"render", solution, "-o", folder / "same.png", "--size", "40x25", "--samples", "1", "--exposure",
                       factor, "--tone-map", "linear"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_NE(read_text(folder / "same.png").find("radiosity in W/m^2 times " + factor.substr(0, 4)),
              std::string::npos);
    EXPECT_EQ(run_program({"render", solution, "-o", picture, "--exposure", "0x"}).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", picture, "--exposure", "brightx"}).status, 2);
    run = run_program({"render", solution, "-o", picture, "--size", "40x25", "--camera", "-1,1,1 2,2,1 60",
                       "--false-colour", "illuminance"});
    EXPECT_EQ(run.status, 0) << run.err;

    run = run_program({"render", solution, "-o", folder / "room.jpg"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find(".jpg"), std::string::npos) << run.err;
    EXPECT_EQ(run_program({"render", solution, "-o", folder / "room.exr", "--isolux"}).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", folder / "room.exr", "--exposure", "1"}).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", picture, "--mesh=all"}).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", picture, "--gather", "5"}).status, 2);
    for (const std::string camera : {"1,1,1 2,2,2 175", "1,1,1 2,2,2 0", "1,1,1 1,1,1"}) {
        run = run_program({"render", solution, "-o", picture, "--camera", camera});
        EXPECT_EQ(run.status, 2);
        EXPECT_NE(run.err.find("--camera: the camera's"), std::string::npos) << run.err;
    }
    EXPECT_EQ(run_program({"render", solution, "-o", picture, "--camera", "1,1 2,2"}).status, 2);
    run = run_program({"render", solution, "-o", picture, "--camera", "kitchen"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find("no camera 'kitchen'"), std::string::npos) << run.err;
    EXPECT_EQ(run_program({"render", solution, "-o", picture, "--size", "0x25"}).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", picture, "--samples", "100000"}).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", folder / "absent/room.png", "--size", "4x4"}).status, 5);
}

TEST(ProgramRender, DrawsTheElementsOfTheMethodOrOfExport) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const auto render = [&](const std::string& name, std::vector<std::string> mesh) {
        std::vector<std::string> words = {"render", "-o", folder / name, "--size", "80x50", "--samples", "1", "-q"};
        words.insert(words.end(), mesh.begin(), mesh.end());
        const Finished run = run_program(words);
        EXPECT_EQ(run.status, 0) << run.err;
        return read_text(folder / name);
    };
    const std::string none = render("a.png", {solution}), own = render("a.png", {"--mesh", solution}),
                      exported = render("a.png", {solution, "--mesh", "export"});
    EXPECT_NE(none, own);
    EXPECT_NE(own, exported) << "exported elements follow direct light, too";
}

TEST(ProgramRender, ShowsOrdersOfEdgesAndShadowClassesOfADiscontinuityMesh) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), plain = folder / "plain.h5", meshed = folder / "meshed.h5";
    ASSERT_EQ(run_program({"solve", scene, "-o", plain, "--error", "0.1", "-q"}).status, 0);
    ASSERT_EQ(run_program(
                  {"solve", scene, "-o", meshed, "--method", "discontinuity", "--bounces", "0", "--error", "0.1", "-q"})
                  .status,
              0);
    const auto render = [&](const std::string& solution, const std::string& picture,
                            const std::vector<std::string>& more) {
        std::vector<std::string> words = {"render", solution, "-o",        folder / picture,
                                          "--size", "40x25",  "--samples", "1"};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words);
    };
    for (const char* name : {"--mesh", "--shadow-classes"}) {
        const Finished run = render(meshed, "events.png", {name});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_TRUE(read_text(folder / "events.png").starts_with("\x89PNG"));
    }
    EXPECT_EQ(render(meshed, "both.png", {"--mesh", "--shadow-classes", "--isolux"}).status, 0);
    const Finished refused = render(plain, "none.png", {"--shadow-classes"});
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("--method discontinuity"), std::string::npos) << refused.err;
    EXPECT_EQ(render(meshed, "events.exr", {"--shadow-classes"}).status, 2);
    EXPECT_EQ(render(meshed, "events.png", {"--shadow-classes", "--false-colour", "illuminance"}).status, 2);
}

TEST(ProgramRender, ShowsTheMeshOrOneLayer) {
    const TemporaryFolder folder;
    const std::string scene = folder / "boxes.obj", solution = folder / "boxes.h5";
    ASSERT_EQ(run_program({"generate", "boxes", "lights=2", "-o", scene, "-q"}).status, 0);
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--method", "discontinuity", "--bounces", "0",
                           "--error-interpolant", "0.02", "--layers", "on", "-q"})
                  .status,
              0);
    const auto render = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"render",    solution, "-o",         folder / name, "--size",     "80x50",
                                          "--samples", "1",      "--exposure", "0.01x",       "--tone-map", "linear"};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words);
    };
    std::vector<std::string> pictures;
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
             {}, {"--interpolant"}, {"--layer", "1"}, {"--layer", "2"}, {"--interpolant", "--isolux", "--mesh"}}) {
        const Finished run = render("a.png", more);
        ASSERT_EQ(run.status, 0) << run.err;
        const std::string picture = read_text(folder / "a.png");
        EXPECT_EQ(std::count(pictures.begin(), pictures.end(), picture), 0) << "every picture shows other light";
        pictures.push_back(picture);
    }
    const Finished absent = render("a.png", {"--layer", "moon"});
    EXPECT_EQ(absent.status, 2);
    EXPECT_NE(absent.err.find("no source is called 'moon'"), std::string::npos) << absent.err;
    for (const std::vector<std::string>& wrong :
         std::vector<std::vector<std::string>>{{"--layer", "1", "--interpolant"},
                                               {"--interpolant", "--gather", "16"},
                                               {"--layer", "1", "--gather", "16"}})
        EXPECT_EQ(render("a.png", wrong).status, 2);
    const std::string plain = folder / "plain.h5";
    ASSERT_EQ(run_program({"solve", scene, "-o", plain, "--error", "0.2", "-q"}).status, 0);
    EXPECT_EQ(run_program({"render", plain, "-o", folder / "b.png", "--size", "40x25", "--interpolant"}).status, 0);
    const Finished none = run_program({"render", plain, "-o", folder / "b.png", "--layer", "1"});
    EXPECT_EQ(none.status, 2);
    EXPECT_NE(none.err.find("--layers on"), std::string::npos) << none.err;
}

TEST(ProgramRender, SupportsProjectionsAndWritesLinearPictures) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    for (const char* projection : {"orthographic", "fisheye", "panorama"}) {
        const std::string picture = folder / std::string(projection) + ".png";
        const Finished run = run_program({"render", solution, "-o", picture, "--size", "32x16", "--projection",
                                          projection, "--tone-map", "linear", "--exposure", "auto", "--isolux"});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_TRUE(read_text(picture).starts_with("\x89PNG"));
    }
    const std::string exr = folder / "room.exr", hdr = folder / "room.hdr";
    EXPECT_EQ(run_program({"render", solution, "-o", exr, "--size", "32x16", "--gather", "4"}).status, 0);
    EXPECT_NE(read_text(exr).find("W/(m^2 sr)"), std::string::npos);
    EXPECT_EQ(run_program({"render", solution, "-o", hdr, "--size", "32x16"}).status, 0);
    EXPECT_TRUE(read_text(hdr).starts_with("#?RADIANCE\n"));
    EXPECT_NE(read_text(hdr).find("-Y 16 +X 32\n"), std::string::npos);
}

TEST(ProgramRender, LeavesNoFileAfterASignal) {
    const TemporaryFolder folder;
    ASSERT_TRUE(write_solution(folder / "s.h5", sample_solution()));
    RunningProgram run(
        {"render", folder / "s.h5", "-o", folder / "s.png", "--gather", "4096", "--camera", "1", "--progress", "json"});
    ASSERT_TRUE(run.wait_for("render"));
    run.send(SIGINT);
    EXPECT_EQ(run.finish().status, 130);
    EXPECT_FALSE(std::filesystem::exists(folder / "s.png"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / ""), {}),
              1);  // no picture was written: only the solution is there
}

TEST(ProgramRender, SupportsTheCamerasOfAScene) {
    const TemporaryFolder folder;
    const Solution solution = sample_solution();
    ASSERT_FALSE(solution.scene.cameras().empty());
    ASSERT_TRUE(write_solution(folder / "s.h5", solution));
    const std::string picture = folder / "s.png";
    for (const std::string& camera : {solution.scene.cameras()[0].name, std::string("1")}) {
        const Finished run =
            run_program({"render", folder / "s.h5", "-o", picture, "--size", "16x16", "--camera", camera});
        EXPECT_EQ(run.status, 0) << run.err;
    }
    const Finished run = run_program({"render", folder / "s.h5", "-o", picture, "--camera", "attic"});
    EXPECT_EQ(run.status, 2);
    EXPECT_NE(run.err.find(solution.scene.cameras()[0].name), std::string::npos) << run.err;
}

}  // namespace exitance::test
