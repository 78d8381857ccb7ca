#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "cli/small_scene.hpp"

namespace exitance::test {

using Json = nlohmann::json;

namespace {

Finished solve_by_tasks(const TemporaryFolder& folder, const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> words{"solve",       write_small_room(folder),
                                   "-o",          folder / (name + ".h5"),
                                   "--method",    "hierarchical",
                                   "--json",      "--task-engine",
                                   "--threshold", "0.01"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
}

std::string light_by_engine(const TemporaryFolder& folder, const std::string& name) {
    const std::string table = folder / (name + ".csv");
    EXPECT_EQ(run_program({"export", folder / (name + ".h5"), "-o", table}).status, 0);
    return read_text(table);
}

}  // namespace

TEST(ProgramTaskEngine, GivesTheSameLightUnderEveryScheduleAndReportsCounts) {
    const TemporaryFolder folder;
    std::string first;
    for (const std::string schedule : {"static", "dynamic", "stealing"}) {
        const Finished run =
            solve_by_tasks(folder, schedule, {"--schedule", schedule, "--threads", schedule == "static" ? "1" : "3"});
        ASSERT_EQ(run.status, 0) << run.err;
        const Json stats = Json::parse(run.out);
        EXPECT_EQ(stats["schedule"], schedule);
        EXPECT_GT(stats["links"], stats["initial_links"]);
        EXPECT_GT(stats["predicted_links"], 0);
        EXPECT_GE(stats["iterations"], 4);
        EXPECT_TRUE(stats["relative_error_estimate"].is_null());
        EXPECT_LT(stats["energy"]["defect"], 0.1);
        const std::string light = light_by_engine(folder, schedule);
        if (first.empty()) first = light;
        EXPECT_EQ(light, first);
    }
    const Finished stored = run_program({"stats", folder / "static.h5", "--json"});
    EXPECT_GT(Json::parse(stored.out)["T_vis_seconds"], 0) << "figures are kept in the file";
}

TEST(ProgramTaskEngine, TheTraceHasTheGraphOfTasks) {
    const TemporaryFolder folder;
    const std::string file = folder / "trace.json";
    ASSERT_EQ(solve_by_tasks(folder, "traced", {"--threads", "2", "--trace", file}).status, 0);
    const Json trace = Json::parse(read_text(file));
    std::map<std::uint64_t, Json> by_id;
    for (const Json& event : trace["traceEvents"])
        if (event["ph"] == "X") by_id.emplace(event["args"]["id"], event);
    std::size_t made = 0;
    for (const auto& [id, event] : by_id) {
        if (event["name"] != "patch") continue;
        const Json& arguments = event["args"];
        const Json& parent = by_id.at(arguments["parent"]);
        if (parent["name"] != "patch") {
            EXPECT_EQ(parent["name"], "iteration");
            continue;
        }
        ++made;
        EXPECT_EQ(parent["args"]["iteration"], arguments["iteration"]);
        EXPECT_LE(parent["ts"].get<double>() + parent["dur"].get<double>(), event["ts"].get<double>() + 0.0005);
        for (const char* cost : {"T_init", "T_vis", "T_ff", "T_rad", "T_back"}) EXPECT_GE(arguments[cost], 0) << cost;
    }
    EXPECT_GT(made, 20u);
}

TEST(ProgramTaskEngine, RejectsUnsupportedOptions) {
    const TemporaryFolder folder;
    for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--error", "0.02"},
                                                                                      {"--clusters", "on"},
                                                                                      {"--epsilon", "0.1"},
                                                                                      {"--mesh-size", "0.1"},
                                                                                      {"--keep-links"}}) {
        const Finished run = solve_by_tasks(folder, "refused", more);
        EXPECT_EQ(run.status, 2);
        EXPECT_NE(run.err.find(more[0]), std::string::npos) << run.err;
    }
    // Without a method, the one that has tasks is taken.
    EXPECT_EQ(run_program({"solve", write_small_room(folder), "-o", folder / "x.h5", "--task-engine"}).status, 0);
}

}  // namespace exitance::test
