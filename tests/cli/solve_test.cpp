#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "cli/small_scene.hpp"
#include "support/places.hpp"

namespace exitance::test {

using OrderedJson = nlohmann::ordered_json;

namespace {

std::vector<std::string> keys(const OrderedJson& json) {
    std::vector<std::string> names;
    for (const auto& [name, value] : json.items()) names.push_back(name);
    return names;
}

const std::vector<std::string> statistics_keys{"method",
                                               "basis",
                                               "threads",
                                               "processes",
                                               "schedule",
                                               "surfaces",
                                               "elements",
                                               "leaf_elements",
                                               "links",
                                               "rays",
                                               "form_factors",
                                               "iterations",
                                               "converged",
                                               "stopped_by",
                                               "residual",
                                               "relative_error_estimate",
                                               "relative_error_bound",
                                               "relative_error_estimate_interpolant",
                                               "relative_error_estimate_worst_room",
                                               "relative_error_estimate_worst_body",
                                               "error_p99",
                                               "rooms",
                                               "bodies",
                                               "standard_error",
                                               "energy",
                                               "seconds",
                                               "peak_memory_bytes",
                                               "link_memory_bytes",
                                               "bytes_per_link",
                                               "element_memory_bytes",
                                               "bytes_per_element",
                                               "elements_by_level",
                                               "warnings",
                                               "energy_defect_before",
                                               "direct",
                                               "mesh_kind",
                                               "links_found_by",
                                               "initial_links",
                                               "coefficient_memory_bytes"};

/// A black floor below a lamp of 1 m^2 with the given radiance per band, rotated by an angle that is no multiple of 90
/// degrees.
std::string write_lamp(const TemporaryFolder& folder, const std::string& radiance) {
    write_text(folder / "lamp.obj",
               "mtllib lamp.mtl\nv 0 0 0\nv 4 3 0\nv 1 7 0\nv -3 4 0\nusemtl floor\nf 1 2 3 4\n"
               "v 0.5 3 2\nv 1.1 3.8 2\nv 1.9 3.2 2\nv 1.3 2.4 2\ng lamp\nusemtl lamp\nf 5 6 7 8\n");
    write_text(folder / "lamp.mtl", "newmtl floor\nKd 0 0 0\nnewmtl lamp\nKd 0 0 0\nKe " + radiance + "\n");
    return folder / "lamp.obj";
}

}  // namespace

TEST(ProgramSolve, EnergyIsOneNumberInTheUnitOfTheScene) {
    // M = pi L over 1 m^2: lm with the luminous weights of the bands, W with their mean.
    constexpr double pi = 3.14159265358979;
    struct Case {
        std::string radiance, quantity;
        double emitted;
        std::string unit;
    };
    for (const Case& c : {Case{"1000 1000 1000", "photometric", 1000 * pi, "lm"},
                          {"1000 1000 1000", "radiometric", 1000 * pi, "W"},
                          {"1000 500 200", "photometric", (265 + 335 + 13) * pi, "lm"},
                          {"1000 500 200", "radiometric", 1700.0 / 3 * pi, "W"}}) {
        const TemporaryFolder folder;
        const std::string solution = folder / "s.h5";
        const Finished run = run_program({"solve", write_lamp(folder, c.radiance), "-o", solution, "--quantity",
                                          c.quantity, "--json", "--progress", "none"});
        ASSERT_EQ(run.status, 0) << run.err;
        const OrderedJson energy = OrderedJson::parse(run.out)["energy"];
        EXPECT_NEAR(energy["emitted"].get<double>() / c.emitted, 1, 1e-6) << c.radiance << c.unit;
        EXPECT_EQ(energy["unit"], c.unit);
        EXPECT_NEAR((energy["absorbed"].get<double>() + energy["escaped"].get<double>()) / c.emitted, 1, 0.02)
            << "escaped light is known by few rays";
        EXPECT_EQ(OrderedJson::parse(run_program({"stats", solution, "--json"}).out)["energy"], energy);
        const std::string text = run_program({"stats", solution}).out;
        EXPECT_TRUE(std::regex_search(text, std::regex("energy +[0-9.]+ " + c.unit + " emitted, "))) << text;
        ASSERT_EQ(run_program({"report", solution, "-o", folder / "r.html", "--size", "16x10", "-q"}).status, 0);
        const std::string page = read_text(folder / "r.html");
        EXPECT_TRUE(std::regex_search(page, std::regex("<td>Emitted</td><td>[0-9.]+ " + c.unit))) << c.unit;
    }
}

TEST(ProgramSolve, JsonHasTheKeysOfTheContractInTheirOrderAndStatsAgrees) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    const Finished run = run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const OrderedJson json = OrderedJson::parse(run.out);
    EXPECT_EQ(keys(json), statistics_keys);
    EXPECT_EQ(keys(json["energy"]), (std::vector<std::string>{"emitted", "absorbed", "escaped", "defect", "unit"}));
    EXPECT_EQ(keys(json["seconds"]),
              (std::vector<std::string>{"total", "read", "mesh", "direct", "link", "visibility", "form_factors",
                                        "solve", "gather", "certify", "reconstruct", "write"}));
    EXPECT_EQ(json["surfaces"], 7);
    EXPECT_LE(json["relative_error_estimate"], 0.1);
    EXPECT_GT(json["seconds"]["total"], 0);
    EXPECT_GT(json["peak_memory_bytes"], 1 << 20);

    const Finished stats = run_program({"stats", solution, "--json"});
    ASSERT_EQ(stats.status, 0) << stats.err;
    OrderedJson kept = OrderedJson::parse(stats.out), made = json;
    for (OrderedJson* either : {&kept, &made}) either->erase("seconds"), either->erase("peak_memory_bytes");
    EXPECT_EQ(kept, made);
}

/// A closed room with a lamp, and next to it a closed room without one.
std::string write_lit_and_dark_room(const TemporaryFolder& folder) {
    const std::string scene = write_small_room(folder);
    std::ofstream(scene, std::ios::app)
        << "v 6 0 0\nv 9 0 0\nv 9 3 0\nv 6 3 0\nv 6 0 2.5\nv 9 0 2.5\nv 9 3 2.5\nv 6 3 2.5\nusemtl grey\ng dark\n"
           "f 13 14 15 16\nf 20 19 18 17\nf 13 17 18 14\nf 14 18 19 15\nf 15 19 20 16\nf 16 20 17 13\n";
    return scene;
}

TEST(ProgramSolve, ARoomWithoutLightHasAMeanOfZeroAndAReferenceForItsError) {
    const TemporaryFolder folder;
    const std::string solution = folder / "rooms.h5";
    const Finished run =
        run_program({"solve", write_lit_and_dark_room(folder), "-o", solution, "--error", "0.1", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const OrderedJson rooms = OrderedJson::parse(run.out)["rooms"];
    ASSERT_EQ(rooms.size(), 2u);
    const OrderedJson &lit = rooms[0], &dark = rooms[1];
    EXPECT_EQ(keys(lit), (std::vector<std::string>{"area", "mean", "reference", "error"}));
    EXPECT_GT(lit["mean"], 0.1);
    // The sums have different orders.
    EXPECT_NEAR(lit["reference"].get<double>() / lit["mean"].get<double>(), 1, 1e-12);
    EXPECT_EQ(dark["mean"], 0.0);
    EXPECT_GT(dark["reference"], 0.0);
    EXPECT_EQ(OrderedJson::parse(run_program({"stats", solution, "--json"}).out)["rooms"], rooms);
    EXPECT_NE(run_program({"stats", solution}).out.find("48 m^2: 0 W/m^2"), std::string::npos);
}

TEST(ProgramSolve, PeakMemoryExcludesTheParentProcess) {
    const TemporaryFolder folder;
    const std::vector<char> held(std::size_t(400) << 20, 1);
    const Finished run =
        run_program({"solve", write_small_room(folder), "-o", folder / "s.h5", "--error", "0.5", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_LT(OrderedJson::parse(run.out)["peak_memory_bytes"], held.size());
}

TEST(ProgramSolve, TheLineOfTimesListsEveryPhaseThatTookTime) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.05"}).status, 0);
    const OrderedJson seconds = OrderedJson::parse(run_program({"stats", solution, "--json"}).out)["seconds"];
    const std::string text = run_program({"stats", solution}).out;
    const std::string line = text.substr(text.find("\ntime "));
    for (const char* phase : {"read", "mesh", "direct", "link", "solve", "gather", "certify", "reconstruct"})
        EXPECT_TRUE(seconds[phase] < 0.001 || line.find(phase) != std::string::npos) << phase << line;
    EXPECT_GT(seconds["gather"], 0.001);
}

TEST(ProgramSolve, ContactsCloserThanRoundingDoNotSplitElementsForever) {
    const TemporaryFolder folder;
    const std::string scene = test::source_folder() + "/tests/data/nearly_parallel_boxes.obj";
    const Finished run = run_program({"solve", scene, "-o", folder / "s.h5", "--error", "0.2", "-q"});
    EXPECT_EQ(run.status, 0) << run.err;
}

TEST(ProgramSolve, AnUnwritableFolderEndsBeforeTheWorkWithoutAResult) {
    const TemporaryFolder folder;
    const Finished run = run_program({"solve", write_small_room(folder), "-o", folder / "absent/room.h5"});
    EXPECT_EQ(run.status, 5);
    EXPECT_EQ(run.err.find("error: "), 0u) << run.err;
    EXPECT_NE(run.err.find("absent/room.h5"), std::string::npos) << run.err;
    EXPECT_EQ(folder.count(), 2u) << "the scene's two files and nothing else";
}

TEST(ProgramSolve, DevicesAreWrittenAndNotReadBack) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    EXPECT_EQ(run_program({"solve", scene, "-o", "/dev/null", "--error", "0.2", "-q"}).status, 0);
    EXPECT_EQ(run_program({"solve", scene, "-o", "/dev/full", "--error", "0.2", "-q"}).status, 5);
}

TEST(ProgramSolve, NothingIsWrittenForABrokenScene) {
    const TemporaryFolder folder;
    const Finished run = run_program({"solve", write_broken_scene(folder), "-o", folder / "room.h5"});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("broken.obj:9: "), std::string::npos) << run.err;
    EXPECT_EQ(folder.count(), 2u);
}

TEST(ProgramSolve, AMissingOutputIsAUsageError) {
    const TemporaryFolder folder;
    EXPECT_EQ(run_program({"solve", write_small_room(folder)}).status, 2);
}

TEST(ProgramSolve, AnErrorBeyondTheTimeLimitLeavesAResultAndStatusFour) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    const Finished run = run_program(
        {"solve", write_small_room(folder), "-o", solution, "--error", "0.0005", "--time-limit", "1", "--json"});
    EXPECT_EQ(run.status, 4) << run.err;
    const OrderedJson told = OrderedJson::parse(run.out);
    EXPECT_FALSE(told["converged"]);
    EXPECT_GT(told["relative_error_estimate"], 0.0005);
    EXPECT_EQ(run_program({"stats", solution}).status, 0);
}

TEST(ProgramSolve, ARunWithoutAnEstimateOfItsLightWritesNothingAndHasStatusFive) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5";
    const Finished run =
        run_program({"solve", write_small_room(folder), "-o", solution, "--time-limit", "1e-9", "--progress", "none"});
    EXPECT_EQ(run.status, 5) << run.err;
    EXPECT_NE(run.err.find("time limit"), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(solution));
}

TEST(ProgramSolve, ASignalEndsTheWorkAndAvailableLightIsWritten) {
    for (const auto& [signal, status] : {std::pair{SIGINT, 130}, {SIGTERM, 143}}) {
        const TemporaryFolder folder;
        const std::string solution = folder / "room.h5";
        RunningProgram run(
            {"solve", write_small_room(folder), "-o", solution, "--error", "0.003", "--progress", "json"});
        ASSERT_TRUE(run.wait_for("\"certify\""));
        run.send(signal);
        EXPECT_EQ(run.finish().status, status);
        EXPECT_EQ(run_program({"stats", solution}).status, 0);
        EXPECT_EQ(folder.count(), 3u) << "two files of the scene, one solution";
    }
}

TEST(ProgramSolve, LightWithAnErrorAsLargeAsItselfIsReportedAsUseless) {
    const TemporaryFolder folder;
    const Finished run = run_program({"solve", write_small_room(folder), "-o", folder / "room.h5", "--method",
                                      "growing-cells", "--gcs", "classic", "--max-units", "16"});
    EXPECT_EQ(run.status, 4) << run.err;
    EXPECT_NE(run.out.find("reached    no error was requested"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("the result is not usable"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("requested for the whole"), std::string::npos) << run.out;  // no error was
}

TEST(ProgramSolve, TheSolutionDoesNotDependOnTheNumberOfThreads) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder);
    write_text(folder / "points.csv", "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n0,2,1,1,0,0\n2.3,0.3,2.5,0,0,-1\n");
    std::vector<std::string> light;
    for (const std::string threads : {"1", "2", "3"}) {
        const std::string solution = folder / (threads + ".h5");
        ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "--threads", threads, "-q"}).status,
                  0);
        const Finished probe =
            run_program({"probe", solution, "--points", folder / "points.csv", "--threads", threads});
        EXPECT_EQ(probe.status, 0) << probe.err;
        light.push_back(probe.out);
    }
    EXPECT_EQ(light[0], light[1]);
    EXPECT_EQ(light[0], light[2]);
}

TEST(ProgramSolve, ADryRunForecastsAndWritesNothing) {
    const TemporaryFolder folder;
    const Finished run = run_program({"solve", write_small_room(folder), "--dry-run", "--json"});
    EXPECT_EQ(run.status, 0) << run.err;
    const OrderedJson json = OrderedJson::parse(run.out);
    EXPECT_EQ(json["surfaces"], 7);
    for (const char* key : {"solve_elements", "gather_elements", "rays", "seconds", "memory_bytes"})
        EXPECT_GT(json[key], 0) << key;
    EXPECT_EQ(folder.count(), 2u);
}

TEST(ProgramSolve, ProgressAsJsonHasALinePerEventAndPhasesInOrder) {
    const TemporaryFolder folder;
    const Finished run = run_program(
        {"solve", write_small_room(folder), "-o", folder / "room.h5", "--error", "0.1", "--progress", "json"});
    ASSERT_EQ(run.status, 0) << run.err;
    std::istringstream lines(run.err);
    std::vector<std::string> phases;
    for (std::string line; std::getline(lines, line);) {
        const OrderedJson event = OrderedJson::parse(line);
        EXPECT_EQ(keys(event), (std::vector<std::string>{"phase", "fraction", "detail", "elapsed", "remaining"}));
        if (phases.empty() || phases.back() != event["phase"]) phases.push_back(event["phase"]);
    }
    ASSERT_GE(phases.size(), 3u);
    EXPECT_EQ(phases.back(), "write");
}

TEST(ProgramSolve, QuietPrintsNothingAndGivesTheSameResult) {
    const TemporaryFolder folder;
    const Finished run =
        run_program({"solve", write_small_room(folder), "-o", folder / "room.h5", "--error", "0.1", "-q"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.out + run.err, "");
}

}  // namespace exitance::test
